"""The address of the chain's page holds whatever a click changes, and says why it is refused."""

import re
from urllib.parse import parse_qsl

import pytest
from browser import errors, until
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
const [wanted, done] = arguments, found = [];
const turn = (hash) => new Promise((turned) => {{
  addEventListener('hashchange', turned, {{once: true}});
  location.hash = hash;
}});
const elsewhere = '#size=3&restitution=0.5&amplitude=2&damping=2&gap=1.5&spring=quadratic&box=100'
  + '&mass_ratio=10&rod=3&first=velocities&second=energy&speed=30';
async function look(name) {{
  const hash = location.hash, before = shown(), says = named();
  await turn(elsewhere);
  const there = shown();
  await turn(hash);
  found.push([name, ...says, before, there, shown()]);
}}
(async () => {{
  for (const control of {ALL}) {{
    const name = control.dataset.chain ?? control.ariaLabel ?? control.textContent;
    if (!control.checkVisibility() || !name.match(wanted)) continue;
    const entries = [...control.options ?? [null]].filter((option) => !option?.disabled);
    for (const entry of entries) {{
      use(control, entry);
      await look(`${{name}} ${{entry?.value ?? ''}}`);
    }}
  }}
}})().then(() => done(found), (error) => done(String(error.stack)));
"""


def compare(name, shown, begun, address):
    """Compare what the page shows with what its address says, both by name."""
    said = dict(parse_qsl(address.removeprefix("#"), strict_parsing=True))
    for kind in ("challenge", "preset"):
        said.pop(kind, None)
    assert begun | said == shown, name
    assert not any(said[each] == begun[each] for each in said if each != "size"), name


def again(browser):
    """Reload the page; return what it shows before and then."""
    before = browser.execute_script(f"{LOOK} return shown()")
    browser.refresh()
    return before, browser.execute_script(f"{LOOK} return shown()")


@pytest.mark.parametrize(
    ("beginning", "wanted", "number"),
    [
        ("challenge=push", "^(challenge|preset|reveal|restart)", 17),
        ("challenge=push&size=4&speed=30", "^(?!challenge|preset|save|solve)", 45),
        ("challenge=maxwell&size=4", "^(?!challenge|preset|save|solve)", 31),
    ],
)
def test_whatever_is_clicked_is_in_the_address(browser, address, beginning, wanted, number):
    """Every button, slider and entry of a list, which the address then restores."""
    visit(browser, f"{address}#{beginning}", quiet=True)
    found = browser.execute_async_script(USE + EVERYTHING, wanted)
    assert len(found) == number
    for name, now, begun, hash_, before, there, after in found:
        compare(name, now, begun, hash_)
        assert after == before != there, name
    assert errors(browser) == []


@pytest.mark.parametrize(("screen", "way"), [("wide", "mouse"), ("narrow", "touch")])
def test_a_reload_shows_what_was_clicked_before(browser, address, screen, way):
    """One control of each kind, used by a hand."""
    visit(browser, f"{address}#challenge=push", screen, quiet=True)
    for name in ("challenge-ends", "preset", "reveal", "restart", "restitution", "rod", "speed"):
        element = control(browser, name)
        if element.tag_name == "button":
            press(browser, element, way)
        else:
            element.send_keys("\ue013" if element.tag_name == "input" else "\ue015")
        compare(name, *browser.execute_script(f"{LOOK} return named()"))
        before, after = again(browser)
        assert after == before, name
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


SETTINGS = [
    ("?size=2&gap=5", {"size": 2, "gap": 5}),
    ("#size=30&restitution=0.5&spring=quadratic", {"size": 30, "spring": "quadratic"}),
    ("#challenge=ends&gap=0.1", {"size": 20, "restitution": 0.9, "gap": 0.1}),
    ("#restitution=0.955", {"size": 100, "restitution": 0.955}),
    ("?siz=20", "siz is none of challenge, preset, size, restitution"),
    ("#toString=1", "toString is none of"),
    ("#foo", "foo is not of the form name=value"),
    ("#size=201", "size must be a whole number from 2 to 200, got 201"),
    ("#size=20.5", "size must be a whole number from 2 to 200, got 20.5"),
    ("#size=", "size must be a whole number from 2 to 200, got nothing"),
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
]


def looked(browser, expected):
    """Look whether the page has the expected chain, or says why not; return whether it has it."""
    if not isinstance(expected, str):
        assert expected.items() <= browser.execute_script(CHAIN).items()
        return True
    said = text(browser, "note")
    assert expected in said
    assert re.fullmatch(r"The address is not understood: .*\.", said)
    return False


@pytest.mark.parametrize(("setting", "expected"), SETTINGS[:5])
def test_an_address_restores_a_setting_or_says_why_not(browser, address, setting, expected):
    visit(browser, address + setting, quiet=True)
    if looked(browser, expected):
        slide(browser, damping=2)
        browser.refresh()
        looked(browser, expected | {"damping": 2})


def test_an_address_that_changes_is_read_like_that_of_a_new_page(browser, address):
    visit(browser, address, quiet=True)
    for setting, expected in SETTINGS:
        if setting.startswith("#"):
            turn(browser, setting)
            looked(browser, expected)


@pytest.mark.parametrize("way", ["mouse", "touch", "Enter", "Tab", "p"])
def test_a_rod_that_is_not_there_leaves_the_box_and_is_not_pushed(browser, address, way):
    visit(browser, address + "#challenge=push&rod=5", "narrow", quiet=True)
    box = control(browser, "rod")
    look = "return [Array.from(ChainRunning.world.state.v), arguments[0].value, location.hash]"
    before = browser.execute_script(look, box)
    assert before[1:] == ["5", "#challenge=push&rod=5"]
    for rod in ("999", "", "-3", "2.5", "0") if way in ("mouse", "Enter") else ("999", ""):
        box.send_keys("\ue009a\ue000\ue003" + rod)  # all is deleted, then typed
        if way in ("mouse", "touch"):
            press(browser, control(browser, "push"), way)
        else:
            box.send_keys({"Enter": "\ue007", "Tab": "\ue004"}.get(way, way))
        said, which = text(browser, "note"), rod or "without a number"
        assert said == f"There is no rod {which}: the rods have the numbers 1 to 20."
        assert browser.execute_script(look, box) == before


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
