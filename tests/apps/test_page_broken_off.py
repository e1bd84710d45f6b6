"""Whatever breaks off a push, a judgement or a theory on the chain's page says so, and why."""

import pytest
from browser import errors
from driven_page import (
    ALL,
    SCREENS,
    USE,
    challenges,
    control,
    press,
    rows,
    slide,
    text,
    turn,
    visit,
)
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput

pytestmark = pytest.mark.validate

# What goes on, and how it begins. It is marked: once the mark is gone, or the theory is not asked
# for, it was broken off.
GOES_ON = {
    "the push under way": "ChainRunning.world.pushed?.marked",
    "the judging": "ChainRunning.world.measurement.blocks.marked && !ChainRunning.world.hand",
    "the computation of the theory": "Boolean(ChainTheory.asked())",
}
BEGIN = {
    "the push under way": "click('push'); ChainRunning.world.pushed.marked = true;",
    "the judging": """
      for (let k = 0; k < 60; k++) ChainRunning.goOn();
      ChainFrames.draw();
      if (said('said').includes('next verdict falls'))
        ChainRunning.world.measurement.blocks.marked = true;""",
    "the computation of the theory": """
      window.fetch = () => new Promise(() => {});  // it takes for ever
      click('solve');""",
}
FIND = """
const find = (name) => document.querySelector(`[data-chain="${name}"]`);
const click = (name) => find(name).click(), said = (name) => find(name).textContent;
"""
# Of each control that is seen: its name, that of its slider, whether all went on before it was
# used, and after it, and what the page then said. It comes back to its address before each.
EVERYTHING = """
const [left, elsewhere, done] = arguments, found = [], beginning = location.hash;
const turn = (hash) => new Promise((turned) => {
  addEventListener('hashchange', turned, {once: true});
  location.hash = hash;
});
(async () => {
  const shown = Array.from(ALL).filter((control) => control.checkVisibility());
  for (const control of shown) {
    const name = control.dataset.chain ?? control.ariaLabel;
    if (left.includes(name)) continue;
    await turn(elsewhere);
    await turn(beginning);
    begin();
    const began = goesOn();
    use(control);
    const label = control.closest('.slider')?.querySelector('label').textContent ?? '';
    found.push([name, label.split(' [')[0], began, goesOn(), said('note')]);
  }
})().then(() => done(found), (error) => done(String(error.stack)));
"""
HOLDS = "return ChainPhysics.position(ChainRunning.world.state, 0) / ChainDrawing.reach("
HOLDS += "ChainRunning.world.state.chain) * arguments[0].clientWidth / 2"


def beginning(what):
    """Return the address of a short chain, where a push, a judgement or a theory soon begins."""
    return "challenge=ends&size=4" if "judging" in what else "challenge=push&size=4&speed=30"


def begin(browser, address, screen, what):
    """Open the page, where a push, a judgement or a theory is under way."""
    challenge = "ends" if "judging" in what else "push"
    visit(browser, f"{address}#challenge={challenge}", screen, quiet=True)
    assert browser.execute_script(f"{FIND} {BEGIN[what]} return {GOES_ON[what]}")


def check(what, name, label, goes_on, note):
    """Look whether the page says that a control has broken off what goes on; return whether so."""
    if goes_on:
        assert "broke off" not in note, name
        return False
    why = f"The {label} changed" if label else "A chain was begun anew"
    why = "Rod 1 was pushed" if name == "push" else why
    assert note == f"{why}, which broke off {what}.", name
    return True


@pytest.mark.parametrize("what", GOES_ON)
def test_every_control_that_breaks_something_off_says_so_and_why(browser, address, what):
    visit(browser, f"{address}#{beginning(what)}", quiet=True)
    script = f"{FIND} {USE} const ALL = {ALL}, goesOn = () => {GOES_ON[what]};"
    script += f"const begin = () => {{ {BEGIN[what]} }}; {EVERYTHING}"
    left = ["save", "solve", "step"]
    found = browser.execute_async_script(script, left, "#size=3&restitution=0.5&speed=30")
    broken = 0
    for name, label, began, goes_on, note in found:
        assert began, name
        broken += check(what, name, label, goes_on, note)
    assert broken >= 18
    assert errors(browser) == []


@pytest.mark.parametrize(("screen", "way"), [("wide", "mouse"), ("narrow", "touch")])
def test_a_hand_on_a_control_breaks_off_too(browser, address, screen, way):
    """One control of each kind."""
    visit(browser, address, screen, quiet=True)
    for what in GOES_ON:
        for name in ("challenge-ends", "preset", "restitution", "speed"):
            turn(browser, f"#{beginning(what)}&restitution=0.5")
            turn(browser, f"#{beginning(what)}")
            assert browser.execute_script(f"{FIND} {BEGIN[what]} return {GOES_ON[what]}")
            element = control(browser, name)
            if element.tag_name == "button":
                press(browser, element, way)
            else:
                element.send_keys("\ue015" if element.tag_name == "select" else "\ue012")
            label = "restitution e" if name == "restitution" else ""
            goes_on = browser.execute_script(f"return {GOES_ON[what]}")
            broken = check(what, name, label, goes_on, text(browser, "note"))
            assert broken == (name != "speed")


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
    assert "clearly above 3" in rows(browser, 1000)
    slide(browser, restitution=0.6)
    assert text(browser, "note") == ""


@pytest.mark.parametrize("screen", SCREENS)
def test_messages_are_seen_above_the_rods(browser, address, screen):
    """Also where one has scrolled to a slider, and nothing moves when they appear."""
    visit(browser, address, screen, quiet=True)
    place = "[...document.querySelectorAll('.stage, .note')].map((each) => "
    place += "each.getBoundingClientRect().toJSON())"
    before = browser.execute_script(f"return {place}")[1]["y"]
    script = f"""{FIND} {USE}
    return ChainAddress.SPRUNG.map((name) => {{
      click('push');
      find(name).scrollIntoView({{block: 'nearest'}});
      find(name).focus();
      use(find(name));
      return [said('note'), ...{place}];
    }});"""
    found = browser.execute_script(script)
    assert len(found) == 6
    for said, note, stage in found:
        assert "which broke off the push" in said
        assert 0 <= note["top"] < note["bottom"] <= stage["top"] + 1 < SCREENS[screen][1]
    browser.execute_script("scrollTo(0, 0)")
    assert browser.execute_script(f"return {place}")[1]["y"] == before
