"""The address of the chain's page holds whatever a click changes, and says why it is refused."""

import re
from urllib.parse import parse_qsl, urlsplit

import pytest
from browser import errors, until
from driven_page import CHAIN, challenges, control, press, slide, text, visit

pytestmark = pytest.mark.validate

CONTROLS = ".chain :is(button, select, input)"

# All that is chosen on the page, as its controls show it.
SHOWN = """
const value = (name) => document.querySelector(`[data-chain="${name}"]`).value;
const names = ['preset', 'rod', 'speed', 'first-picture', 'second-picture', ...ChainAddress.NAMES];
const pressed = [...document.querySelectorAll('[aria-pressed]')].map((each) => each.ariaPressed);
const said = (name) => document.querySelector(`[data-chain="${name}"]`).textContent;
return [...names.map(value), ...pressed, said('ask'), said('answer'),
  JSON.stringify(ChainRunning.world.state.chain)];
"""
# What the page shows by the names of the address, and what these are where it leaves them out.
NAMED = """
const value = (name) => document.querySelector(`[data-chain="${name}"]`).value;
const shown = {...ChainRunning.world.state.chain, rod: value('rod'), speed: value('speed'),
  first: value('first-picture'), second: value('second-picture')};
const all = [...ChainChallenges.list, ...ChainPresets.list];
const chosen = all.find(({id}) => arguments[0].includes(id));
const begun = ChainAddress.beginning(chosen ?? {});
const texts = (each) => Object.fromEntries(Object.entries(each).map(([k, v]) => [k, String(v)]));
return [texts(shown), texts(begun)];
"""


def named(browser):
    """Return what the page shows and what its address says, both by name."""
    said = dict(parse_qsl(urlsplit(browser.current_url).fragment, strict_parsing=True))
    chosen = [said.pop(kind) for kind in ("challenge", "preset") if kind in said]
    shown, begun = browser.execute_script(NAMED, chosen)
    assert not any(said[name] == begun[name] for name in said if name != "size")
    return shown, begun | said


def use(browser, element, entry, way):
    """Press a button, move a slider, or choose an entry of a list."""
    if element.tag_name == "button":
        press(browser, element, way)
    elif element.tag_name == "input":
        element.send_keys("\ue013")
    else:
        element.send_keys("\ue011" + entry * "\ue015")


def again(browser):
    """Reload the page; return what it shows before and then."""
    before = browser.execute_script(SHOWN)
    browser.refresh()
    return before, browser.execute_script(SHOWN)


@pytest.mark.parametrize(("screen", "challenge"), [("wide", "push"), ("narrow", "maxwell")])
def test_whatever_is_clicked_is_in_the_address(browser, address, screen, challenge):
    """Every button, slider and entry of a list; each time a reload shows the same page."""
    visit(browser, f"{address}#challenge={challenge}", screen, quiet=True)
    way = "mouse" if screen == "wide" else "touch"
    for k in range(len(browser.find_elements("css selector", CONTROLS))):
        element = browser.find_elements("css selector", CONTROLS)[k]
        name = element.get_attribute("data-chain") or element.accessible_name
        if not element.is_displayed() or name in ("save", "solve"):
            continue
        options = element.find_elements("css selector", "option")
        for entry in range(sum(option.is_enabled() for option in options) or 1):
            use(browser, browser.find_elements("css selector", CONTROLS)[k], entry, way)
            shown, said = named(browser)
            assert said == shown, (name, entry)
            before, after = again(browser)
            assert after == before, (name, entry)
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
        ("#restitution=0.955", {"size": 100, "restitution": 0.955}),
        ("#restitution=0.9555", "a number from 0 to 1.1 with at most 3 decimals, got 0.9555"),
        ("#size=20&rod=21", "rod must be a whole number from 1 to 20, got 21"),
        ("#challenge=ends&rod=999", "rod must be a whole number from 1 to 200, got 999"),
        ("#rod=-3", "rod must be a whole number from 1 to 200, got -3"),
        ("#size=20&size=30", "size is given twice"),
        ("#size=20&gap=<b>", "gap must be a number from 0 to 5 with at most 3 decimals, got <b>"),
        ("#speed=4", "speed must be 0.3 or 3 or 30 or 100 or 300, got 4"),
        (
            "#challenge=x",
            "challenge must be push or runaway or ends or pressure or maxwell or count, got x",
        ),
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


@pytest.mark.parametrize("rod", ["999", "-3", "2.5", "0", ""])
@pytest.mark.parametrize("way", ["mouse", "touch", "Enter", "Tab", "p"])
def test_a_rod_that_is_not_there_leaves_the_box_and_is_not_pushed(browser, address, rod, way):
    visit(browser, address + "#challenge=push&rod=5", "narrow", quiet=True)
    speeds = "return Array.from(ChainRunning.world.state.v)"
    before = browser.execute_script(speeds)
    control(browser, "rod").send_keys("\ue009a\ue000\ue003" + rod)  # all is deleted, then typed
    if way in ("mouse", "touch"):
        press(browser, control(browser, "push"), way)
    else:
        control(browser, "rod").send_keys({"Enter": "\ue007", "Tab": "\ue004"}.get(way, way))
    said = text(browser, "note")
    which = rod or "without a number"
    assert said == f"There is no rod {which}: the rods have the numbers 1 to 20."
    assert control(browser, "rod").get_attribute("value") == "5"
    assert browser.current_url.endswith("#challenge=push&rod=5")
    assert browser.execute_script(speeds) == before


def test_the_rod_to_push_is_one_of_a_shorter_chain(browser, address):
    visit(browser, address + "#size=60&rod=50", quiet=True)
    slide(browser, size=20)
    assert control(browser, "rod").get_attribute("value") == "20"
    assert browser.current_url.endswith("#size=20&rod=20")


def test_a_value_between_the_steps_of_a_slider_is_shown_as_it_is(browser, address):
    visit(browser, address + "#size=20&restitution=0.955", quiet=True)
    words = "return document.querySelector('[data-value=restitution]').textContent"
    assert browser.execute_script(words) == "0.955"
    assert control(browser, "restitution").get_attribute("aria-valuetext") == "0.955"
    press(browser, control(browser, "restart"))
    assert browser.current_url.endswith("#size=20&restitution=0.955")


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
