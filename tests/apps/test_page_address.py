"""The address of the chain's page holds whatever a click changes, and says why it is refused."""

import re
from urllib.parse import parse_qsl

import pytest
from browser import errors
from driven_page import ALL, CHAIN, USE, challenges, control, press, slide, text, turn, visit

pytestmark = pytest.mark.validate

# All that is chosen on the page, as its controls show it; and by the names of the address, with
# what these are where it leaves them out.
LOOK = """
const value = (name) => document.querySelector(`[data-chain="${name}"]`).value;
const said = (name) => document.querySelector(`[data-chain="${name}"]`).textContent;
const shown = () => {
  const names = ['preset', 'rod', 'speed', 'first-picture', 'second-picture'];
  const pressed = [...document.querySelectorAll('[aria-pressed]')].map((each) => each.ariaPressed);
  return [...[...names, ...ChainAddress.NAMES].map(value), ...pressed, said('ask'), said('answer'),
    JSON.stringify(ChainRunning.world.state.chain)];
};
const named = () => {
  const { chain } = ChainRunning.world.state;
  const whole = [...ChainChallenges.list, ...ChainPresets.list];
  const now = {...chain, rod: value('rod'), speed: value('speed'),
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
  + '&mass_ratio=10&rod=3&first=velocities&second=energy&speed=30';
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
        ("challenge=push&size=4&speed=30", "^(?!challenge|preset|save|solve)", 45),
        ("challenge=maxwell&size=4", "^(spring|size|box|mass|rod|speed)", 18),
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
        ("size=20&rod=21", "rod must be a whole number from 1 to 20, got 21"),
        ("size=20&size=30", "size is given twice"),
        ("gap=<b>", "gap must be a number from 0 to 5 with at most 3 decimals, got <b>"),
        ("speed=4", "speed must be 0.3 or 3 or 30 or 100 or 300, got 4"),
        ("challenge=push&preset=gap", "it names a challenge and a preset"),
        ("spring=none&size=20&box=41", "20 rods need a box of at least 42 R, got 41"),
    ):
        turn(browser, f"#{setting}")
        note = text(browser, "note")
        assert reason in note
        assert re.fullmatch(r"The address is not understood: .*\.", note)


def test_a_rod_that_is_not_there_leaves_the_box_and_is_not_pushed(browser, address):
    visit(browser, address + "#challenge=push&rod=5", "narrow", quiet=True)
    box = control(browser, "rod")
    look = "return [Array.from(ChainRunning.world.state.v), arguments[0].value, location.hash]"
    before = browser.execute_script(look, box)
    assert before[1:] == ["5", "#challenge=push&rod=5"]
    for rod in ("999", "", "-3", "2.5", "0"):
        box.send_keys("\ue009a\ue000\ue003" + rod)  # all is deleted, then typed
        if rod == "999":
            press(browser, control(browser, "push"))
        else:
            box.send_keys("\ue007")
        reason = f"There is no rod {rod or 'without a number'}: the rods have the numbers 1 to 20."
        assert text(browser, "note") == reason
        assert browser.execute_script(look, box) == before


def test_the_rod_to_push_is_one_of_a_shorter_chain(browser, address):
    visit(browser, address + "#size=60&rod=50", quiet=True)
    slide(browser, size=20)
    assert control(browser, "rod").get_attribute("value") == "20"
    assert browser.current_url.endswith("#size=20&rod=20")
