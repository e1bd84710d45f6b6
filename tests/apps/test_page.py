"""The chain to play with in a browser: everybody can use it, and it knows what is achieved."""

import re
from itertools import product
from pathlib import Path

import chain_curves
import numpy as np
import pytest
from accessibility import audit, tabbed
from browser import errors, show_as, until
from matplotlib.image import imread
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput

from crazybilliards.model import Chain

ROOT = Path(__file__).parents[2]
SCREENS = {"wide": (1280, 900), "narrow": (390, 700)}
CHAIN = "return ChainRunning.world.state.chain"
TIME = "return ChainRunning.world.state.time"
LISTS = "return [ChainChallenges.list, ChainPresets.list].map((l) => l.map((each) => each.chain))"
pytestmark = pytest.mark.validate

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
DRAWN = """return ['stage', 'second'].map((name) =>
  document.querySelector(`[data-chain=${name}]`).toDataURL().length)"""
ELSEWHERE = """return performance.getEntriesByType('resource').map((each) => each.name)
  .filter((name) => !name.startsWith(location.origin) && !name.startsWith('data:'))"""


def visit(browser, address, screen="wide", *, dark=False, quiet=False):
    """Open the page; ``quiet``: for a reader who wants nothing to move."""
    show_as(browser, *SCREENS[screen], dark=dark)
    if quiet:
        still = {"name": "prefers-reduced-motion", "value": "reduce"}
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [still]})
    browser.get("about:blank")
    browser.get(address)


def control(browser, name):
    return browser.find_element("css selector", f"[data-chain='{name}']")


def text(browser, name):
    return browser.execute_script("return arguments[0].textContent", control(browser, name))


def press(browser, element, way="mouse"):
    if way == "keys":
        element.send_keys("\ue007")
        return
    browser.execute_script(SEEN, element, "center")
    actions = ActionBuilder(browser, mouse=PointerInput(way, way))
    actions.pointer_action.move_to(element).pointer_down().pointer_up()
    actions.perform()


def slide(browser, **values):
    setting = "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))"
    for name, value in values.items():
        browser.execute_script(setting, control(browser, name), value)


def rows(browser, number):
    """Let the chain go on by so many rows of its strip, and the challenge look at it."""
    going = "for (let k = 0; k < arguments[0] && !ChainRunning.world.ranAway; k++)"
    going += "ChainRunning.goOn(); arguments[1].dispatchEvent(new Event('change'));"
    browser.execute_script(going, number, control(browser, "first-picture"))
    return text(browser, "said")


def challenges(browser):
    return browser.find_elements("css selector", "[aria-pressed]")


def test_the_files_are_small_plain_and_ask_nobody_else():
    files = (ROOT / "apps/explore/page").iterdir()
    texts = {file.name: file.read_text(encoding="utf-8") for file in files}
    scripts = {name: text for name, text in texts.items() if name.endswith(".js")}
    assert sum(len(text.encode()) for text in scripts.values()) <= 80_000
    assert all(text.count("\n") < 300 for text in texts.values())
    assert not re.search(r"http|import |export |innerHTML|eval\(", "".join(texts.values()))
    for name, script in scripts.items():  # of one page: each adds one name
        names = [line.split()[1] for line in script.splitlines() if line.startswith("const ")]
        assert names == [f"Chain{name.removesuffix('.js').title()}"][name == "controls.js" :]
        assert f'src="_static/{name}"' in texts["chain.html"]
    assert "explore/page/chain.html" in (ROOT / "docs/chain.md").read_text(encoding="utf-8")


@pytest.mark.compiled
def test_the_stored_curves_are_those_of_the_best_theories():
    texts = chain_curves.CURVES.read_text(encoding="utf-8"), chain_curves.script()
    stored, solved = (re.split(r"(\d\.\d+)", text) for text in texts)
    assert stored[::2] == solved[::2]
    np.testing.assert_allclose(np.array(stored[1::2], float), np.float64(solved[1::2]), atol=0.0015)


@pytest.mark.parametrize(("screen", "dark"), list(product(SCREENS, [False, True])))
@pytest.mark.parametrize("way", ["mouse", "keys", "touch"])
def test_every_challenge_and_preset_is_reached_and_seen(browser, address, screen, dark, way):
    visit(browser, address, screen, dark=dark)
    assert audit(browser)[0] == []
    asked, presets = browser.execute_script(LISTS)
    for button, chain in zip(challenges(browser), asked, strict=True):
        press(browser, button, way)
        until(lambda expected=chain: browser.execute_script(CHAIN) == expected, 20)
    for chain in presets:
        control(browser, "preset").send_keys("\ue015")
        assert browser.execute_script(CHAIN) == chain
        time = browser.execute_script(TIME)
        until(lambda before=time: browser.execute_script(TIME) > before, 20)
        assert min(browser.execute_script(DRAWN)) > 5000
        if screen == "wide":
            assert browser.execute_script(SEEN, control(browser, "stage"), "nearest")[1]
    press(browser, control(browser, "restart"), way)
    time = browser.execute_script(TIME)
    until(lambda: browser.execute_script(TIME) > time, 20)
    assert browser.execute_script("return document.body.scrollWidth") <= SCREENS[screen][0]
    assert browser.execute_script(ELSEWHERE) == []
    assert errors(browser) == []


@pytest.mark.parametrize("screen", SCREENS)
def test_nothing_covers_a_control_and_the_picture_is_seen_with_it(browser, address, screen):
    visit(browser, address, screen, quiet=True)
    for element in browser.find_elements("css selector", ".chain :is(button, select, input)"):
        if element.is_displayed():
            assert browser.execute_script(SEEN, element, "center")[0], element.accessible_name
    for name in browser.execute_script("return ChainAddress.NAMES"):
        assert browser.execute_script(SEEN, control(browser, name), "nearest") == [True, True], name
        value = browser.execute_script(CHAIN)[name]
        for button in browser.find_elements("css selector", f".slider:has(#chain-{name}) button"):
            press(browser, button, "touch")  # less, then more
            until(lambda n=name, v=value: browser.execute_script(CHAIN)[n] != v, 20)
            value = browser.execute_script(CHAIN)[name]


def test_keys_alone_reach_push_pause_and_change(browser, address):
    visit(browser, address, quiet=True)
    reached = tabbed(browser)
    named = {each.accessible_name: outline for each, outline, *_ in reached}
    assert len(named) == len(reached) == 31
    assert min(named.values()) >= 3
    fast = "return ChainRunning.world.state.v[arguments[0]]"
    free = Chain(damping=0.3).free_velocity_width
    for keys, before in ((" ", "push"), ("p", "play")):
        speed = browser.execute_script(fast, 0)
        control(browser, before).send_keys(keys)
        assert browser.execute_script(fast, 0) == pytest.approx(speed + 8 * free)
    control(browser, "restitution").send_keys("\ue012")
    assert browser.execute_script(CHAIN)["restitution"] == 0.99
    time = browser.execute_script(TIME)
    until(lambda: browser.execute_script("return performance.now()") > 1000, 20)
    assert browser.execute_script(TIME) == time  # whoever wants no motion gets none
    press(browser, control(browser, "step"), "keys")
    assert re.match(r"Met at t = [\d.]+ T: rods \d+ and \d+", text(browser, "status"))
    control(browser, "play").send_keys(" ")
    until(lambda: browser.execute_script(TIME) > time + 0.1, 20)


@pytest.mark.parametrize("e", [0, 1])
def test_a_rod_follows_the_pointer_and_pushes_the_others(browser, address, e):
    visit(browser, address)
    slide(browser, restitution=e)
    where = "const {state} = ChainRunning.world, half = ChainDrawing.reach(state.chain);"
    where += "return ChainPhysics.position(state, 0) / half * arguments[0].clientWidth / 2;"
    first = browser.execute_script(where, control(browser, "stage"))
    mouse = ActionBuilder(browser, duration=0)
    mouse.pointer_action.move_to(control(browser, "stage"), int(first), -54)
    mouse.pointer_action.pointer_down().move_by(300, 0)
    mouse.perform()
    position = "return Array.from(ChainRunning.world.state.y)"
    until(lambda: browser.execute_script(position)[0] > 3, 30)
    assert (np.diff(browser.execute_script(position)) >= -1e-9).all()
    mouse.clear_actions()
    assert browser.execute_script("return ChainRunning.world.state.held") == -1


@pytest.mark.parametrize(
    ("setting", "expected"),
    [
        ("?size=2&gap=5", {"size": 2, "gap": 5}),
        ("#size=30&restitution=0.5&spring=quadratic", {"size": 30, "spring": "quadratic"}),
        ("?siz=20", "siz is none of size, restitution"),
        ("#size=201", "size must be a number from 2 to 200, got 201"),
        ("#size=20&gap=<b>", "gap must be a number from 0 to 5, got <b>"),
    ],
)
def test_an_address_restores_a_setting_or_says_why_not(browser, address, setting, expected):
    visit(browser, address + setting, quiet=True)
    if isinstance(expected, str):
        assert expected in text(browser, "ask")
    else:
        slide(browser, damping=2)
        browser.refresh()
        assert (expected | {"damping": 2}).items() <= browser.execute_script(CHAIN).items()


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("chain", "said"),
    [
        ({"restitution": 0.95}, r"kinetic .*: velocity widths within [\d.]+ %, .*density within"),
        ({"gap": 0.5}, r"exact equilibrium: exact\. force balance: .*density within"),
        ({"amplitude": 0}, "No theory: this chain has no steady state"),
    ],
)
def test_a_theory_is_solved_on_request_and_says_its_error(browser, address, chain, said):
    visit(browser, address + "#size=20", quiet=True)
    slide(browser, **chain)
    press(browser, control(browser, "solve"))
    assert text(browser, "theory").startswith("Being solved")
    until(lambda: not browser.execute_script("return ChainTheory.asked()"), 200)
    assert re.match(said, text(browser, "theory"))
    slide(browser, damping=0.5)
    assert text(browser, "theory") == ""
    assert errors(browser) == []


def test_a_theory_is_stopped(browser, address, solvers):
    visit(browser, address + "#size=200&restitution=0", quiet=True)
    press(browser, control(browser, "solve"))
    until(solvers, 60)
    assert text(browser, "solve") == "Stop"
    press(browser, control(browser, "solve"))
    until(lambda: text(browser, "solve") == "Solve the theory", 20)
    assert text(browser, "theory") == ""
    until(lambda: not solvers(), 20)
    assert errors(browser) == []


@pytest.mark.parametrize("dark", [False, True])
def test_the_rods_are_saved_as_a_picture(browser, address, dark, tmp_path):
    allowed = {"behavior": "allow", "downloadPath": str(tmp_path)}
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", allowed)
    visit(browser, address, dark=dark)
    press(browser, control(browser, "save"))
    until((tmp_path / "chain.png").exists, 60)
    picture = imread(tmp_path / "chain.png")
    assert picture.shape[1] == control(browser, "stage").size["width"]
    assert len(np.unique(picture.reshape(-1, 4), axis=0)) > 50
    assert (picture[0, 0, :3] > 0.5).all() != dark


@pytest.mark.parametrize(
    ("number", "moves"),
    [
        (1, [({"restitution": 1}, r"= 1: [1-9]\S* of"), ({"restitution": 0.9}, "= 0.9: 0 of")]),
        (2, [({"size": 15, "restitution": 1.05}, "times"), ({"damping": 0.2}, "than .* 6.1 rods")]),
        (3, [({}, "for [0-9]{4} T"), ({"size": 60, "restitution": 0.5}, "Done: [0-9]")]),
        (4, [({"damping": 3.5}, "concave at .* 3.5"), ({"damping": 2.5}, "convex at .* 2.5,")]),
    ],
)
def test_a_challenge_is_solved_by_its_sliders_and_then_answered(browser, address, number, moves):
    """By the last of the moves, each of which has come to its end when the page says something."""
    visit(browser, address, quiet=True)
    press(browser, challenges(browser)[number - 1])
    for values, said in moves:
        assert text(browser, "answer") == ""
        slide(browser, **values)
        for _ in range(50):
            if number == 1:
                press(browser, control(browser, "push"))
            if re.search(said, last := rows(browser, 400)):
                break
        assert re.search(said, last)
    assert [each.text[-1] == "✓" for each in challenges(browser)].index(True) == number - 1
    for seen in ("answer", "second"):
        place = control(browser, seen).rect
        assert place["height"] > 15
        assert place["y"] + place["height"] <= SCREENS["wide"][1]
    if number < 4:
        press(browser, control(browser, "next"))
        assert challenges(browser)[number].get_attribute("aria-pressed") == "true"
