"""The address of the chain's page holds whatever a click changes, and says why it is refused."""

import re

import pytest
from browser import errors, until
from driven_page import CHAIN, SCREENS, challenges, control, press, slide, text, visit

pytestmark = pytest.mark.validate

# All that is chosen on the page, as its controls show it.
SHOWN = """
const value = (name) => document.querySelector(`[data-chain="${name}"]`).value;
const names = ['preset', 'rod', 'speed', 'first-picture', 'second-picture', ...ChainAddress.NAMES];
const pressed = [...document.querySelectorAll('[aria-pressed]')].map((each) => each.ariaPressed);
const said = (name) => document.querySelector(`[data-chain="${name}"]`).textContent;
return [...names.map(value), ...pressed, said('ask'), said('answer'),
  JSON.stringify(ChainRunning.world.state.chain)];
"""


def again(browser):
    """Reload the page; return what it shows before and then."""
    before = browser.execute_script(SHOWN)
    browser.refresh()
    return before, browser.execute_script(SHOWN)


@pytest.mark.parametrize("screen", SCREENS)
def test_whatever_is_clicked_is_in_the_address(browser, address, screen):
    """Every button, list, slider and key in turn; each time a reload shows the same page."""
    visit(browser, address, screen, quiet=True)
    names = "return [...document.querySelectorAll('.chain :is(button, select, input)')].length"
    for k in range(browser.execute_script(names)):
        element = browser.find_elements("css selector", ".chain :is(button, select, input)")[k]
        name = element.get_attribute("data-chain") or ""
        if not element.is_displayed() or name in ("save", "solve"):
            continue
        if element.tag_name == "button":
            press(browser, element)
        else:
            element.send_keys("\ue015" if element.tag_name == "select" else "\ue013")
        before, after = again(browser)
        assert after == before, element
    assert errors(browser) == []


def test_challenges_and_answers_stay_through_a_reload_and_do_not_travel_with_the_link(
    browser, address
):
    visit(browser, address + "#size=40&restitution=0.8", quiet=True)
    for number, name in enumerate(("push", "runaway", "ends")):
        press(browser, challenges(browser)[number])
        assert browser.current_url.endswith(f"#challenge={name}")
    slide(browser, size=60, restitution=0.5)
    assert browser.current_url.endswith("#challenge=ends&size=60&restitution=0.5")
    control(browser, "preset").send_keys("\ue015")
    assert browser.current_url.endswith("#preset=middle")
    assert text(browser, "answer") == ""
    press(browser, control(browser, "reveal"))
    assert "0.22 W" in text(browser, "answer")
    before, after = again(browser)
    assert after == before
    visit(browser, browser.current_url, quiet=True)
    assert text(browser, "answer") == ""


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("?size=2&gap=5", {"size": 2, "gap": 5}),
        ("#size=30&restitution=0.5&spring=quadratic", {"size": 30, "spring": "quadratic"}),
        ("#challenge=ends&gap=0.1", {"size": 20, "restitution": 0.9, "gap": 0.1}),
        ("?siz=20", "siz is none of challenge, preset, size, restitution"),
        ("#toString=1", "toString is none of"),
        ("#foo", "foo is not of the form name=value"),
        ("#size=201", "size must be a whole number from 2 to 200, got 201"),
        ("#size=20.5", "size must be a whole number from 2 to 200, got 20.5"),
        ("#size=", "size must be a whole number from 2 to 200, got nothing"),
        ("#restitution=0.955", "a number from 0 to 1.1 in steps of 0.01, got 0.955"),
        ("#size=20&size=30", "size is given twice"),
        ("#size=20&gap=<b>", "gap must be a number from 0 to 5 in steps of 0.1, got <b>"),
        ("#speed=4", "speed must be 0.3 or 3 or 30 or 100 or 300, got 4"),
        ("#challenge=x", "challenge must be push or runaway or ends, got x"),
        ("#challenge=push&preset=gap", "it names a challenge and a preset"),
    ],
)
def test_an_address_restores_a_setting_or_says_why_not(browser, address, setting, expected):
    visit(browser, address + setting, quiet=True)
    if isinstance(expected, str):
        said = text(browser, "note")
        assert expected in said
        assert re.fullmatch(r"The address is not understood: .*\.", said)
    else:
        assert expected.items() <= browser.execute_script(CHAIN).items()
        slide(browser, damping=2)
        browser.refresh()
        assert (expected | {"damping": 2}).items() <= browser.execute_script(CHAIN).items()


@pytest.mark.parametrize("rod", ["999", "-3", "2.5", ""])
def test_a_rod_that_is_not_there_is_not_pushed(browser, address, rod):
    visit(browser, address, quiet=True)
    speeds = "return Array.from(ChainRunning.world.state.v)"
    before = browser.execute_script(speeds)
    browser.execute_script("arguments[0].value = arguments[1]", control(browser, "rod"), rod)
    press(browser, control(browser, "push"))
    said = text(browser, "note")
    which = rod or "without a number"
    assert said == f"There is no rod {which}: the rods have the numbers 1 to 20."
    assert browser.execute_script(speeds) == before


@pytest.mark.compiled
def test_what_was_asked_of_one_chain_is_not_said_of_another(browser, address, solvers):
    visit(browser, address + "#size=200&restitution=0", quiet=True)
    press(browser, control(browser, "solve"))
    until(solvers, 60)
    slide(browser, size=40, restitution=0.8)
    assert text(browser, "theory") == ""
    assert text(browser, "solve") == "Solve the theory"
    until(lambda: not solvers(), 20)  # the server has stopped too
    assert text(browser, "theory") == ""
