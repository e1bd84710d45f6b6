"""The page to play with, as a test drives it in a browser."""

from browser import show_as
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput

SCREENS = {"wide": (1280, 900), "narrow": (375, 667)}
CHAIN = "return ChainRunning.world.state.chain"
TIME = "return ChainRunning.world.state.time"

# What is seen of an element when it is scrolled to, and what of the rods and pictures then.
SEEN = """
const element = arguments[0];
element.scrollIntoView({block: arguments[1]});
const box = element.getBoundingClientRect(), x = box.x + box.width / 2, y = box.y + box.height / 2;
const shown = (each) => { const b = each.getBoundingClientRect(), x0 = b.x + b.width / 2;
  return b.bottom <= innerHeight + 1 && document.elementFromPoint(x0, b.top + 3) === each; };
return [element.contains(document.elementFromPoint(x, y)),
  ['stage', 'second'].every((name) => shown(document.querySelector(`[data-chain=${name}]`)))];
"""

# All controls, and how a script of the page uses one: with the events that a hand causes. It turns
# to another address as a link does, but in a third of the time.
ALL = "document.querySelectorAll('.chain :is(button, select, input)')"
USE = """
function turn(hash) {
  history.replaceState(null, '', hash);
  dispatchEvent(new Event('hashchange'));
}
function use(control, entry = null) {
  if (control.tagName === 'BUTTON') return control.click();
  if (entry) control.value = entry.value;
  else if (control.tagName === 'SELECT') control.selectedIndex++;
  else if (control.step === 'any') control.value = 1;
  else if (Number(control.value) > Number(control.min)) control.stepDown();
  else control.stepUp();
  for (const type of ['input', 'change'])
    control.dispatchEvent(new Event(type, {bubbles: true}));
}
"""


def visit(browser, address, screen="wide", *, dark=False, quiet=False):
    """Open the page; ``quiet``: for a reader who wants nothing to move."""
    show_as(browser, *SCREENS[screen], dark=dark)
    if quiet:
        still = {"name": "prefers-reduced-motion", "value": "reduce"}
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [still]})
    browser.get("about:blank")
    browser.get(address)


def turn(browser, setting):
    """Let the open page obey another address, without a reload."""
    obeyed = "addEventListener('hashchange', () => arguments[1](), {once: true});"
    browser.execute_async_script(f"{obeyed} location.hash = arguments[0]", setting)


def control(browser, name):
    return browser.find_element("css selector", f"[data-chain='{name}']")


def text(browser, name):
    return browser.execute_script("return arguments[0].textContent", control(browser, name))


def press(browser, element, way="mouse"):
    if way == "keys":
        element.send_keys("\ue007")
        return
    browser.execute_script(SEEN, element, "center")
    # By default the pointer would take a quarter of a second to come.
    actions = ActionBuilder(browser, mouse=PointerInput(way, way), duration=0)
    actions.pointer_action.move_to(element).pointer_down().pointer_up()
    actions.perform()


def slide(browser, **values):
    setting = "arguments[0].value = arguments[1]; "
    setting += "arguments[0].dispatchEvent(new Event('input', {bubbles: true}))"
    for name, value in values.items():
        browser.execute_script(setting, control(browser, name), value)


def rows(browser, number):
    """Let the chain go on by so many rows of its strip, and the challenge look at it."""
    going = "for (let k = 0; k < arguments[0] && !ChainRunning.world.ranAway; k++)"
    going += "ChainRunning.goOn();"
    going += "arguments[1].dispatchEvent(new Event('change', {bubbles: true}));"
    browser.execute_script(going, number, control(browser, "first-picture"))
    return text(browser, "said")


def show(browser):
    """Skip the prediction that a challenge or question asks for."""
    press(browser, control(browser, "reveal"))


def challenges(browser):
    return browser.find_elements("css selector", "[aria-pressed]")
