"""What everybody needs of a page: an audit by axe-core, and all that Tab reaches."""

from axe_core_python.base import AXE_SCRIPT
from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

AUDIT = """
const done = arguments[arguments.length - 1];
axe.run(document, {resultTypes: ['violations', 'passes']}).then(
  found => done([found.violations, found.passes.filter(each => each.id === 'color-contrast')]),
  error => done([String(error), []]));
"""
FOCUSED = """
const focused = document.activeElement;
if (!focused || focused === document.body) return null;
const style = getComputedStyle(focused);
return [focused, style.outlineStyle === 'solid' ? parseFloat(style.outlineWidth) : 0];
"""


def audit(browser):
    """Return the serious findings of axe-core, which has judged the contrast of all text."""
    browser.set_script_timeout(300)
    browser.execute_script(AXE_SCRIPT)
    violations, contrasts = browser.execute_async_script(AUDIT)
    assert isinstance(violations, list), violations
    assert len(contrasts[0]["nodes"]) > 20
    return [
        (rule["id"], node["target"], node["failureSummary"])
        for rule in violations
        if rule["impact"] in ("serious", "critical")
        for node in rule["nodes"]
    ]


def tabbed(browser):
    """Press Tab from the top to the end; return all that it reaches, with its outline in px."""
    reached = []
    while len(reached) < 100:
        ActionChains(browser).send_keys(Keys.TAB).perform()
        focused = browser.execute_script(FOCUSED)
        if focused is None or (reached and focused[0] == reached[0][0]):
            return reached
        reached.append(focused)
    raise AssertionError("Tab goes on for ever")
