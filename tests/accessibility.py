"""What everybody needs of a page: an audit by axe-core, and all that Tab reaches."""

AUDIT = """
const done = arguments[arguments.length - 1];
axe.run(document, {resultTypes: ['violations', 'passes']}).then(
  found => done([found.violations, found.passes.filter(each => each.id === 'color-contrast')]),
  error => done([String(error), []]));
"""
FOCUSED = """
let focused = document.activeElement;
while (focused?.shadowRoot?.activeElement) focused = focused.shadowRoot.activeElement;
if (!focused || focused === document.body) return null;
const style = getComputedStyle(focused), box = focused.getBoundingClientRect();
const outlined = style.outlineStyle === 'solid' ? parseFloat(style.outlineWidth) : 0;
return [focused, outlined, box.left + scrollX, box.top + scrollY, box.bottom + scrollY];
"""


def audit(browser):
    """Return the serious findings of axe-core, and the colours of all text that it could judge."""
    from axe_core_python.base import AXE_SCRIPT

    browser.set_script_timeout(300)
    browser.execute_script(AXE_SCRIPT)
    violations, contrasts = browser.execute_async_script(AUDIT)
    assert isinstance(violations, list), violations
    serious = [
        (found["id"], node["target"], node["failureSummary"])
        for found in violations
        if found["impact"] in ("serious", "critical")
        for node in found["nodes"]
    ]
    judged = [node["any"][0]["data"] for found in contrasts for node in found["nodes"]]
    colours = [each for each in judged if "fgColor" in each]  # others are hidden
    assert len(colours) > 20
    return serious, colours


def tabbed(browser):
    """Press Tab from the top to the end; return name, outline and place of all that it reaches."""
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.keys import Keys

    reached = []
    while len(reached) < 100:
        ActionChains(browser).send_keys(Keys.TAB).perform()
        found = browser.execute_script(FOCUSED)
        if found is None or (reached and found[0] == reached[0][0]):
            return reached
        reached.append(found)
    raise AssertionError("Tab goes on for ever")
