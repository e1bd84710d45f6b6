"""Whatever breaks off a push, a judgement or a theory on the chain's page says so, and why."""

import pytest
from browser import errors
from driven_page import ALL, USE, challenges, control, press, rows, slide, text, turn, visit
from selenium.webdriver.common.actions.action_builder import ActionBuilder

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
const [left, elsewhere] = arguments, found = [], beginning = location.hash;
for (const control of Array.from(ALL).filter((control) => control.checkVisibility())) {
  const name = control.dataset.chain ?? control.ariaLabel;
  if (left.includes(name)) continue;
  turn(elsewhere);
  turn(beginning);
  begin();
  const began = goesOn();
  use(control);
  const label = control.closest('.slider')?.querySelector('label').textContent ?? '';
  found.push([name, label.split(' [')[0], began, goesOn(), said('note')]);
}
return found;
"""
HOLDS = "return ChainPhysics.position(ChainRunning.world.state, 0) / ChainDrawing.reach("
HOLDS += "ChainRunning.world.state.chain) * arguments[0].clientWidth / 2"


@pytest.mark.parametrize("process", GOES_ON)
def test_every_control_that_breaks_something_off_says_so_and_why(browser, address, process):
    """On a short chain, where a push, a judgement or a theory soon begins."""
    beginning = "ends&size=4" if "judging" in process else "push&size=4&speed=30"
    visit(browser, f"{address}#challenge={beginning}", quiet=True)
    script = f"{FIND} {USE} const ALL = {ALL}, goesOn = () => {GOES_ON[process]};"
    script += f"const begin = () => {{ {BEGIN[process]} }}; {EVERYTHING}"
    left = ["save", "solve", "step"]
    uses = browser.execute_script(script, left, "#size=3&restitution=0.5&speed=30")
    assert all(began for _, _, began, _, _ in uses)
    assert sum(not goes_on for *_, goes_on, _ in uses) >= 18
    for name, label, _, goes_on, note in uses:
        if goes_on:
            assert "broke off" not in note, name
        else:
            why = f"The {label} changed" if label else "A chain was begun anew"
            why = "Rod 1 was pushed" if name == "push" else why
            assert note == f"{why}, which broke off {process}.", name
    assert errors(browser) == []


def test_a_hand_an_address_and_a_chain_that_runs_away_break_off_a_push(browser, address):
    process = "the push under way"
    visit(browser, f"{address}#challenge=push", quiet=True)
    browser.execute_script(f"{FIND} {BEGIN[process]}")
    stage = control(browser, "stage")
    hand = ActionBuilder(browser, duration=0)
    hand.pointer_action.move_to(stage, int(browser.execute_script(HOLDS, stage)), -54)
    hand.pointer_action.pointer_down()
    hand.perform()
    assert text(browser, "note") == f"A rod was held, which broke off {process}."
    assert "clearly" not in rows(browser, 2000)  # no verdict on a rod in a hand
    hand.clear_actions()
    press(browser, control(browser, "push"))
    turn(browser, "#size=20")
    assert text(browser, "note") == f"A chain was begun anew, which broke off {process}."
    slide(browser, restitution=1.1, size=200, damping=0.1)
    press(browser, control(browser, "push"))
    rows(browser, 4000)
    assert "has run away" in text(browser, "status")
    assert text(browser, "note") == f"The chain ran away, which broke off {process}."


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
