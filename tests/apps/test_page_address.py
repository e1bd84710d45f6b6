"""What a click does: the address holds it, and whatever it breaks off is said, and why."""

import re
from urllib.parse import parse_qsl

import pytest
from browser import errors
from driven_page import (
    ALL,
    CHAIN,
    USE,
    challenges,
    control,
    press,
    rows,
    show,
    slide,
    text,
    turn,
    visit,
)
from selenium.webdriver.common.actions.action_builder import ActionBuilder

pytestmark = pytest.mark.validate

# All that is chosen on the page, as its controls show it; and by the names of the address, with
# what these are where it leaves them out.
LOOK = """
const value = (name) => document.querySelector(`[data-chain="${name}"]`).value;
const said = (name) => document.querySelector(`[data-chain="${name}"]`).textContent;
const shown = () => {
  const names = ['preset', 'speed', 'first-picture', 'second-picture'];
  const pressed = [...document.querySelectorAll('[aria-pressed]')].map((each) => each.ariaPressed);
  return [...[...names, ...ChainAddress.NAMES].map(value), ...pressed, said('ask'), said('answer'),
    JSON.stringify(ChainRunning.world.state.chain)];
};
const named = () => {
  const { chain } = ChainRunning.world.state;
  const whole = [...ChainChallenges.list, ...ChainPresets.list];
  const now = {...chain, speed: value('speed'),
    first: value('first-picture'), second: value('second-picture')};
  const id = location.hash.match(/(challenge|preset)=(\\w+)/)?.[2];
  const begun = ChainAddress.beginning(whole.find((each) => each.id === id) ?? {});
  const texts = (each) => Object.fromEntries(Object.entries(each).map(([k, v]) => [k, String(v)]));
  return [texts(now), texts(begun), location.hash];
};
"""
# Every control that is seen is used, and every entry of a list chosen. Each time the page goes to
# an address at which all is different, and comes back.
EVERYTHING = f"""{LOOK}
const wanted = arguments[0], found = [];
const elsewhere = '#size=3&restitution=0.5&amplitude=2&damping=2&gap=1.5&spring=quadratic&box=100'
  + '&mass_ratio=10&first=velocities&second=energy&speed=30';
for (const control of {ALL}) {{
  const name = control.dataset.chain ?? control.ariaLabel ?? control.textContent;
  if (!control.checkVisibility() || !name.match(wanted)) continue;
  const entries = [...control.options ?? [null]].filter((option) => !option?.disabled);
  for (const entry of entries) {{
    use(control, entry);
    const hash = location.hash, before = shown(), says = named();
    turn(elsewhere);
    const there = shown();
    turn(hash);
    found.push([`${{name}} ${{entry?.value ?? ''}}`, ...says, before, there, shown()]);
  }}
}}
return found;
"""


@pytest.mark.parametrize(
    ("beginning", "wanted", "number"),
    [
        ("challenge=push", "^(challenge|preset|reveal|restart)", 17),
        ("challenge=push&size=4&speed=30", "^(?!challenge|preset)", 47),
        ("challenge=maxwell&size=4", "^(spring|size|box|mass|speed)", 18),
    ],
)
def test_whatever_is_clicked_is_in_the_address(browser, address, beginning, wanted, number):
    """Every button, slider and entry of a list, which the address then restores."""
    visit(browser, f"{address}#{beginning}", quiet=True)
    uses = browser.execute_script(USE + EVERYTHING, wanted)
    assert len(uses) == number
    for name, now, begun, setting, before, there, after in uses:
        written = dict(parse_qsl(setting.removeprefix("#"), strict_parsing=True))
        for kind in ("challenge", "preset"):
            written.pop(kind, None)
        assert begun | written == now, name
        assert not any(written[key] == begun[key] for key in written if key != "size"), name
        assert after == before != there, name
    assert errors(browser) == []


def test_challenges_and_answers_stay_through_a_reload_and_do_not_travel_with_the_link(
    browser, address
):
    visit(browser, address + "#size=40&restitution=0.8", quiet=True)
    press(browser, challenges(browser)[2])
    slide(browser, size=60, restitution=0.5)
    assert browser.current_url.endswith("#challenge=ends&size=60&restitution=0.5")
    control(browser, "preset").send_keys("\ue015")
    assert browser.current_url.endswith("#preset=middle")
    show(browser)
    press(browser, control(browser, "reveal"))
    before = browser.execute_script(f"{LOOK} return shown()")
    assert len(text(browser, "answer")) > 50
    browser.refresh()
    assert browser.execute_script(f"{LOOK} return shown()") == before
    visit(browser, browser.current_url, quiet=True)
    assert text(browser, "answer") == ""


def test_an_address_restores_a_setting(browser, address):
    """Also values between the steps of a slider."""
    for setting, expected in (
        ("?size=2&gap=5", {"size": 2, "gap": 5}),
        ("#size=20&restitution=0.955", {"size": 20, "restitution": 0.955}),
    ):
        visit(browser, address + setting, quiet=True)
        assert expected.items() <= browser.execute_script(CHAIN).items()
        slide(browser, damping=2)
        browser.refresh()
        assert (expected | {"damping": 2}).items() <= browser.execute_script(CHAIN).items()
    assert control(browser, "restitution").get_attribute("aria-valuetext") == "0.955"
    press(browser, control(browser, "restart"))
    assert browser.current_url.endswith("#size=20&restitution=0.955&damping=2")


def test_an_address_that_is_not_understood_says_why(browser, address):
    visit(browser, address, quiet=True)
    for setting, reason in (
        ("toString=1", "toString is none of challenge, preset, size, restitution"),
        ("foo", "foo is not of the form name=value"),
        ("size=20.5", "size must be a whole number from 2 to 200, got 20.5"),
        ("size=", "size must be a whole number from 2 to 200, got nothing"),
        ("size=20&size=30", "size is given twice"),
        ("gap=<b>", "gap must be a number from 0 to 5 with at most 3 decimals, got <b>"),
        ("speed=4", "speed must be 0.3 or 3 or 30 or 100 or 300, got 4"),
        ("challenge=push&preset=gap", "it names a challenge and a preset"),
        ("spring=none&size=20&box=41", "20 rods need a box of at least 42 R, got 41"),
        ("preset=gap&prediction=1_a", "prediction must be numbers with _ between them, got 1_a"),
        ("preset=gap&prediction=1_2", "prediction must be 9 numbers here, got 2"),
        ("prediction=1_2", "a prediction belongs to a challenge or a question"),
    ):
        turn(browser, f"#{setting}")
        note = text(browser, "note")
        assert reason in note
        assert re.fullmatch(r"The address is not understood: .*\.", note)


# -- what is broken off ------------------------------------------------------------------------

# What goes on, and how it begins. It is marked: once the mark is gone, it was broken off.
GOES_ON = {
    "the push under way": "ChainRunning.world.pushed?.marked",
    "the judging": "ChainRunning.world.measurement.blocks.marked && !ChainRunning.world.hand",
}
BEGIN = {
    "the push under way": "click('push'); ChainRunning.world.pushed.marked = true;",
    "the judging": """
      click('reveal');
      for (let k = 0; k < 60; k++) ChainRunning.goOn();
      ChainFrames.draw();
      if (said('said').includes('next verdict falls'))
        ChainRunning.world.measurement.blocks.marked = true;""",
}
FIND = """
const find = (name) => document.querySelector(`[data-chain="${name}"]`);
const click = (name) => find(name).click(), said = (name) => find(name).textContent;
"""
# Of each control that is seen: its name, that of its slider, whether all went on before it was
# used, and after it, and what the page then said. It comes back to its address before each.
BREAKS_OFF = """
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
    """On a short chain, where a push or a judgement soon begins."""
    beginning = "ends&size=4" if "judging" in process else "push&size=4&speed=30"
    visit(browser, f"{address}#challenge={beginning}", quiet=True)
    script = f"{FIND} {USE} const ALL = {ALL}, goesOn = () => {GOES_ON[process]};"
    script += f"const begin = () => {{ {BEGIN[process]} }}; {BREAKS_OFF}"
    left = ["step"]
    uses = browser.execute_script(script, left, "#size=3&restitution=0.5&speed=30")
    assert all(began for _, _, began, _, _ in uses)
    assert sum(not goes_on for *_, goes_on, _ in uses) >= 18
    for name, label, _, goes_on, note in uses:
        if goes_on:
            assert "broke off" not in note, name
        else:
            why = f"The {label} changed" if label else "A chain was begun anew"
            why = "The left end was pushed" if name == "push" else why
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
    show(browser)
    press(browser, control(browser, "push"))
    assert "1 of 3 pushes" in rows(browser, 400)
    slide(browser, restitution=0.9)
    assert text(browser, "note") == ""
    assert "e = 1: 1 of 3 pushes" in text(browser, "said")
    press(browser, challenges(browser)[1])
    assert text(browser, "note") == "A chain was begun anew, which broke off the judging."
    press(browser, challenges(browser)[2])
    show(browser)
    slide(browser, size=60, restitution=0.5)
    assert "clearly above 2.5" in rows(browser, 1000)
    slide(browser, restitution=0.6)
    assert text(browser, "note") == ""
