"""The chain to play with in a browser: everybody can use it, and it knows what is achieved."""

import json
import re
from pathlib import Path
from urllib.parse import parse_qsl, urlsplit

import chain_curves
import numpy as np
import pytest
from accessibility import audit, tabbed
from browser import errors, until
from driven_page import (
    ALL,
    CHAIN,
    SCREENS,
    SEEN,
    TIME,
    challenges,
    control,
    press,
    rows,
    slide,
    text,
    visit,
)
from matplotlib.image import imread
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.action_builder import ActionBuilder

from crazybilliards.apps.explore.theory import compute, read
from crazybilliards.model import Chain
from crazybilliards.model.parameters import Parameters

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.validate

DRAWN = """return ['stage', 'second'].map((name) =>
  document.querySelector(`[data-chain=${name}]`).toDataURL().length)"""
# The chain goes on by itself, once the page has drawn a frame.
GOES_ON = """const { time } = ChainRunning.world.state, [done] = arguments;
const look = () => (ChainRunning.world.state.time > time ? done() : requestAnimationFrame(look));
look()"""
# What is seen of every control in the middle of the screen; and of the rods, beside what changes
# the chain.
ALL_SEEN = f"""const seen = function () {{ {SEEN} }};
const shown = Array.from({ALL}).filter((control) => control.checkVisibility());
const changes = ChainAddress.NAMES.map((name) => shown.find((each) => each.dataset.chain === name));
const look = (place) => (each) => [each.dataset.chain ?? each.ariaLabel, place, seen(each, place)];
return [...shown.map(look('center')), ...changes.filter(Boolean).map(look('nearest'))];"""
# The theory is asked for, and answered by the test in place of the server.
HOLD = """let asked;
window.fetch = (address) => new Promise((answer) => {
  asked = address;
  window.answer = (text) => answer({json: async () => JSON.parse(text)});
});
arguments[0].click();
return [asked, document.querySelector('[data-chain=theory]').textContent];"""
ANSWER = """const [text, done] = arguments, waiting = () => ChainTheory.asked();
const look = () => (waiting() ? requestAnimationFrame(look) : done());
window.answer(text), look()"""
ELSEWHERE = """return performance.getEntriesByType('resource').map((each) => each.name)
  .filter((name) => !name.startsWith(location.origin) && !name.startsWith('data:'))"""


def goes_on(browser):
    browser.set_script_timeout(20)
    browser.execute_async_script(GOES_ON)


def test_the_files_are_small_plain_and_ask_nobody_else():
    files = (ROOT / "apps/explore/page").iterdir()
    texts = {file.name: file.read_text(encoding="utf-8") for file in files}
    scripts = {name: text for name, text in texts.items() if name.endswith(".js")}
    assert sum(len(text.encode()) for text in scripts.values()) <= 100_000
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


@pytest.mark.parametrize(
    ("screen", "way"), [("wide", "mouse"), ("wide", "keys"), ("narrow", "touch")]
)
def test_every_challenge_is_reached_and_the_chain_goes_on(browser, address, screen, way):
    visit(browser, address, screen)
    asked = browser.execute_script("return ChainChallenges.list.map(({chain}) => chain)")
    for button, chain in zip(challenges(browser), asked, strict=True):
        press(browser, button, way)
        until(lambda expected=chain: browser.execute_script(CHAIN) == expected, 20)
    press(browser, control(browser, "restart"), way)
    goes_on(browser)
    assert errors(browser) == []


@pytest.mark.parametrize("screen", SCREENS)
def test_every_preset_is_seen_by_everybody_and_fits(browser, address, screen):
    """In light and dark mode."""
    for dark in (False, True):
        visit(browser, address, screen, dark=dark)
        assert audit(browser)[0] == []
    for chain in browser.execute_script("return ChainPresets.list.map(({chain}) => chain)"):
        control(browser, "preset").send_keys("\ue015")
        assert browser.execute_script(CHAIN) == chain
        goes_on(browser)
        assert min(browser.execute_script(DRAWN)) > 5000
        if screen == "wide":
            assert browser.execute_script(SEEN, control(browser, "stage"), "nearest")[1]
    assert browser.execute_script("return document.body.scrollWidth") <= SCREENS[screen][0]
    assert browser.execute_script(ELSEWHERE) == []
    assert errors(browser) == []


@pytest.mark.parametrize("challenge", ["push", "pressure"])
@pytest.mark.parametrize("screen", SCREENS)
def test_nothing_covers_a_control_and_the_picture_is_seen_with_it(
    browser, address, screen, challenge
):
    visit(browser, f"{address}#challenge={challenge}", screen, quiet=True)
    seen = browser.execute_script(ALL_SEEN)
    assert len(seen) >= (30 if challenge == "push" else 20)
    for name, place, found in seen:
        assert found[0], (name, place)
        if place == "nearest":
            assert found == [True, True], name
    for name in browser.execute_script("return ChainAddress.NAMES"):
        if not control(browser, name).is_displayed():
            continue
        value = browser.execute_script(CHAIN)[name]
        for button in browser.find_elements("css selector", f".slider:has(#chain-{name}) button"):
            press(browser, button, "touch")  # less, then more
            until(lambda n=name, v=value: browser.execute_script(CHAIN)[n] != v, 20)
            value = browser.execute_script(CHAIN)[name]


def test_keys_alone_reach_push_pause_and_change(browser, address):
    visit(browser, address, quiet=True)
    fast = "return ChainRunning.world.state.v[arguments[0]]"
    free = Chain(damping=0.3).free_velocity_width
    speed = browser.execute_script(fast, 0)
    ActionChains(browser).send_keys("p").perform()  # on a fresh page, before anything has the focus
    assert browser.execute_script(fast, 0) == pytest.approx(speed + 8 * free)
    visit(browser, address, quiet=True)
    reached = tabbed(browser)
    named = {each.accessible_name: outline for each, outline, *_ in reached}
    assert len(named) == len(reached) == 33
    assert min(named.values()) >= 3
    speed = browser.execute_script(fast, 0)
    control(browser, "push").send_keys(" ")
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


@pytest.mark.compiled
def test_a_theory_is_solved_on_request_and_says_its_error(browser, address):
    visit(browser, address + "#size=20&restitution=0.95", quiet=True)
    press(browser, control(browser, "solve"))
    assert text(browser, "theory").startswith("Being solved")
    until(lambda: not browser.execute_script("return ChainTheory.asked()"), 200)
    said = r"kinetic .*: velocity widths within [\d.]+ %, .*density within"
    assert re.match(said, text(browser, "theory"))
    slide(browser, damping=0.5)
    assert text(browser, "theory") == ""
    assert errors(browser) == []


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("chain", "said"),
    [
        ({"gap": 0.5}, r"exact equilibrium: exact\. force balance: .*density within"),
        ({"amplitude": 0}, "No theory: without noise there is no steady motion"),
    ],
)
def test_what_the_server_answers_is_said_of_a_chain(browser, address, chain, said):
    visit(browser, address + "#size=20", quiet=True)
    slide(browser, **chain)
    asked, meanwhile = browser.execute_script(HOLD, control(browser, "solve"))
    assert meanwhile == "Being solved, 0 s."
    parameters = read(dict(parse_qsl(urlsplit(asked).query)))
    assert parameters == Parameters(size=20, **chain)
    browser.execute_async_script(ANSWER, json.dumps(compute(parameters)))
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
        (1, [({"restitution": 1}, "= 1: it arr"), ({"restitution": 0.9}, "= 0.9: it does not")]),
        (2, [({"size": 15, "restitution": 1.05}, "times"), ({"damping": 0.2}, "than .* 6.1 rods")]),
        (3, [({}, "clearly below 3"), ({"size": 60, "restitution": 0.5}, "clearly above 3")]),
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
                browser.execute_script("arguments[0].click()", control(browser, "push"))
            if re.search(said, last := rows(browser, 400)):
                break
        assert re.search(said, last)
    assert [each.text[-1] == "✓" for each in challenges(browser)].index(True) == number - 1
    for seen in ("answer", "second"):
        place = control(browser, seen).rect
        assert place["height"] > 15
        assert place["y"] + place["height"] <= SCREENS["wide"][1]
