"""Whatever breaks off a push, a judgement or a theory on the chain's page says so, and why."""

import pytest
from browser import errors
from driven_page import SCREENS, challenges, control, press, rows, slide, text, visit
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput

pytestmark = pytest.mark.validate

CONTROLS = ".chain :is(button, select, input)"
# What goes on is marked; once the mark is gone, or the theory is not asked for, it was broken off.
GOES_ON = {
    "the push under way": "ChainRunning.world.pushed?.marked",
    "the judging": "ChainRunning.world.measurement.blocks.marked && !ChainRunning.world.hand",
    "the computation of the theory": "Boolean(ChainTheory.asked())",
}
HOLDS = "return ChainPhysics.position(ChainRunning.world.state, 0) / ChainDrawing.reach("
HOLDS += "ChainRunning.world.state.chain) * arguments[0].clientWidth / 2"


def begin(browser, address, screen, what):
    """Open the page, where a push, a judgement or a theory is under way."""
    visit(browser, address + ("#challenge=ends" if "judging" in what else ""), screen, quiet=True)
    if "push" in what:
        press(browser, control(browser, "push"))
        browser.execute_script("ChainRunning.world.pushed.marked = true")
    elif "judging" in what:
        assert "next verdict falls" in rows(browser, 60)
        browser.execute_script("ChainRunning.world.measurement.blocks.marked = true")
    else:
        browser.execute_script("window.fetch = () => new Promise(() => {})")  # it takes for ever
        press(browser, control(browser, "solve"))
    assert browser.execute_script(f"return {GOES_ON[what]}")


def change(browser, element, way):
    """Use a control; return its words and why it breaks off what goes on, if it does."""
    tag, name = element.tag_name, element.get_attribute("data-chain") or ""
    label = browser.execute_script(
        "return arguments[0].closest('.slider')?.querySelector('label').textContent", element
    )
    if tag == "button":
        press(browser, element, way)
    else:
        element.send_keys("\ue015" if tag == "select" else "\ue012")
    if label:
        return f"The {label.split(' [')[0]} changed"
    return "Rod 1 was pushed" if name == "push" else "A chain was begun anew"


SCREENED = list(zip(("narrow", "wide", "wide"), GOES_ON, strict=True))


@pytest.mark.parametrize(("screen", "what"), SCREENED)
def test_every_control_that_breaks_something_off_says_so_and_why(browser, address, screen, what):
    way, broken, names = "mouse" if screen == "wide" else "touch", 0, {}
    visit(browser, address, screen, quiet=True)
    for k, shown in enumerate(browser.find_elements("css selector", CONTROLS)):
        name = shown.get_attribute("data-chain") or shown.get_attribute("aria-label")
        names[k] = name if shown.is_displayed() else "hidden"
    for k, name in names.items():
        if name in ("save", "solve", "step", "hidden"):
            continue
        begin(browser, address, screen, what)
        element = browser.find_elements("css selector", CONTROLS)[k]
        why, said = change(browser, element, way), text(browser, "note")
        if browser.execute_script(f"return {GOES_ON[what]}"):
            assert "broke off" not in said, name
        else:
            assert said == f"{why}, which broke off {what}.", name
            broken += 1
    assert broken >= 18
    assert errors(browser) == []


@pytest.mark.parametrize("what", list(GOES_ON)[:2])
@pytest.mark.parametrize("screen", SCREENS)
def test_a_hand_breaks_off_what_the_rods_do(browser, address, screen, what):
    begin(browser, address, screen, what)
    stage = control(browser, "stage")
    up = 54 if screen == "wide" else 40
    hand = ActionBuilder(browser, mouse=PointerInput("mouse", "mouse"), duration=0)
    hand.pointer_action.move_to(stage, int(browser.execute_script(HOLDS, stage)), -up)
    hand.pointer_action.pointer_down()
    hand.perform()
    assert text(browser, "note") == f"A rod was held, which broke off {what}."
    assert browser.execute_script("return ChainRunning.world.hand !== null")
    assert "clearly" not in rows(browser, 2000)  # no verdict on a rod in a hand
    hand.clear_actions()


def test_an_address_and_a_chain_that_runs_away_break_off_a_push(browser, address):
    begin(browser, address, "wide", "the push under way")
    browser.execute_async_script(
        "addEventListener('hashchange', () => arguments[0]()); location.hash = '#size=20'"
    )
    assert text(browser, "note") == "A chain was begun anew, which broke off the push under way."
    slide(browser, restitution=1.1, size=200, damping=0.1)
    press(browser, control(browser, "push"))
    rows(browser, 4000)
    assert "has run away" in text(browser, "status")
    assert text(browser, "note") == "The chain ran away, which broke off the push under way."


def test_what_is_counted_or_known_is_not_broken_off(browser, address):
    """Pushes are counted at both restitutions; a verdict stays one."""
    visit(browser, address, quiet=True)
    press(browser, control(browser, "push"))
    assert "1 of 3 pushes" in rows(browser, 400)
    slide(browser, restitution=0.9)
    assert text(browser, "note") == ""
    assert "e = 1: 1 of 3 pushes" in text(browser, "said")
    press(browser, challenges(browser)[1])
    assert text(browser, "note") == "A chain was begun anew, which broke off the judging."
    press(browser, challenges(browser)[2])
    slide(browser, size=60, restitution=0.5)
    assert "clearly above 3" in rows(browser, 3000)
    slide(browser, restitution=0.6)
    assert text(browser, "note") == ""


@pytest.mark.parametrize("screen", SCREENS)
def test_messages_are_seen_above_the_rods(browser, address, screen):
    """Also where one has scrolled to a slider, and nothing moves when they appear."""
    visit(browser, address, screen, quiet=True)
    place = "return [...document.querySelectorAll('.stage, .note')].map((each) => "
    place += "each.getBoundingClientRect().toJSON())"
    before = browser.execute_script(place)[1]["y"]
    for name in browser.execute_script("return ChainAddress.SPRUNG"):
        press(browser, control(browser, "push"))
        browser.execute_script(
            "arguments[0].scrollIntoView({block: 'nearest'})", control(browser, name)
        )
        control(browser, name).send_keys("\ue015" if name == "spring" else "\ue012")
        assert "which broke off the push" in text(browser, "note")
        note, stage = browser.execute_script(place)
        assert 0 <= note["top"] < note["bottom"] <= stage["top"] + 1 < SCREENS[screen][1]
    browser.execute_script("scrollTo(0, 0)")
    assert browser.execute_script(place)[1]["y"] == before
