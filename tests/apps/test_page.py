"""The chain to play with in a browser: everybody can use it, and it knows what is achieved."""

import re
from pathlib import Path
from urllib.parse import urlencode

import chain_curves
import numpy as np
import pytest
from axe_core_python.base import AXE_SCRIPT
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
    show,
    slide,
    text,
    visit,
)
from matplotlib.colors import to_hex
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.action_builder import ActionBuilder

from crazybilliards.apps.explore import theory
from crazybilliards.comparison.drawing import DIRECTIONS
from crazybilliards.model import Chain

PAGE = Path(__file__).parents[2] / "apps" / "explore" / "page"
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
ELSEWHERE = """return performance.getEntriesByType('resource').map((each) => each.name)
  .filter((name) => !name.startsWith(location.origin) && !name.startsWith('data:'))"""
LABEL = "return document.querySelector('[data-chain=second]').ariaLabel"
# The serious findings of axe-core, which has judged the contrast of all text.
AUDIT = """
const [done] = arguments, serious = ({impact}) => ['serious', 'critical'].includes(impact);
axe.run(document, {resultTypes: ['violations', 'passes']}).then(
  ({violations, passes}) => done([violations.filter(serious).map(({id, nodes}) => [id, nodes]),
    passes.find(({id}) => id === 'color-contrast').nodes.length]),
  error => done([String(error), 0]));
"""
ANSWERED = "const [given] = arguments; window.fetch = async () => ({json: () => given});"
FOCUSED = """
const focused = document.activeElement;
if (!focused || focused === document.body) return null;
const style = getComputedStyle(focused);
return [focused, style.outlineStyle === 'solid' ? parseFloat(style.outlineWidth) : 0];
"""


def test_the_files_are_small_and_ask_nobody_else():
    texts = {file.name: file.read_text(encoding="utf-8") for file in PAGE.iterdir()}
    scripts = {name: script for name, script in texts.items() if name.endswith(".js")}
    assert sum(len(script.encode()) for script in scripts.values()) <= 113_000
    assert not re.search(r"http|import |export |innerHTML|eval\(", "".join(texts.values()))
    assert all(f'src="_static/{name}"' in texts["chain.html"] for name in scripts)


def test_orange_moves_right_and_blue_left_in_page_and_film():
    style = (PAGE / "chain.css").read_text(encoding="utf-8")
    for name, end, colour in (("left", 0.0, "#0072b2"), ("right", 1.0, "#e69f00")):
        assert re.search(rf"--{name}: (#\w+);", style)[1] == to_hex(DIRECTIONS(end)) == colour


@pytest.mark.compiled
def test_the_stored_curves_are_those_of_the_theory():
    texts = chain_curves.CURVES.read_text(encoding="utf-8"), chain_curves.script()
    stored, solved = (re.split(r"(\d\.\d+)", script) for script in texts)
    assert stored[::2] == solved[::2]
    np.testing.assert_allclose(np.array(stored[1::2], float), np.float64(solved[1::2]), atol=0.0015)


@pytest.mark.parametrize(("screen", "way"), [("wide", "keys"), ("narrow", "touch")])
def test_every_challenge_is_reached_and_the_chain_goes_on(browser, address, screen, way):
    visit(browser, address, screen)
    chains = browser.execute_script("return ChainChallenges.list.map(({chain}) => chain)")
    for button, chain in zip(challenges(browser), chains, strict=True):
        press(browser, button, way)
        until(lambda expected=chain: browser.execute_script(CHAIN) == expected, 20)
    press(browser, control(browser, "restart"), way)
    browser.execute_async_script(GOES_ON)
    assert browser.execute_script(ELSEWHERE) == []
    assert errors(browser) == []


@pytest.mark.parametrize("screen", SCREENS)
def test_every_preset_is_seen_by_everybody_and_fits(browser, address, screen):
    """In light and dark mode. Each asks a question, whose answer is seen on demand."""
    for dark in (True, False) if screen == "wide" else (False,):
        visit(browser, address, screen, dark=dark, quiet=True)
        browser.execute_script(AXE_SCRIPT)
        serious, judged = browser.execute_async_script(AUDIT)
        assert serious == []
        assert judged > 20
    for chain in browser.execute_script("return ChainPresets.list.map(({chain}) => chain)"):
        control(browser, "preset").send_keys("\ue015")
        assert browser.execute_script(CHAIN) == chain
        rows(browser, 20)
        if screen == "narrow":
            assert min(browser.execute_script(DRAWN)) > 3000
            continue
        assert browser.execute_script(SEEN, control(browser, "stage"), "nearest")[1]
        assert "?" in text(browser, "ask")
        for _ in range(
            2
        ):  # nothing is shown before the prediction, and no answer with what is measured
            assert text(browser, "answer") == ""
            press(browser, control(browser, "reveal"), "keys")
        assert len(text(browser, "answer")) > 50
    assert browser.execute_script("return document.body.scrollWidth") <= SCREENS[screen][0]
    assert errors(browser) == []


@pytest.mark.parametrize(("challenge", "number"), [("push", 30), ("pressure", 20)])
@pytest.mark.parametrize("screen", SCREENS)
def test_nothing_covers_a_control_and_the_picture_is_seen_with_it(
    browser, address, screen, challenge, number
):
    visit(browser, f"{address}#challenge={challenge}", screen, quiet=True)
    controls = browser.execute_script(ALL_SEEN)
    assert len(controls) >= number
    for name, place, (uncovered, pictures) in controls:
        assert uncovered, (name, place)
        assert pictures or place == "center", name


def test_keys_alone_reach_push_pause_and_change(browser, address):
    visit(browser, address, quiet=True)
    fast = "return ChainRunning.world.state.v[0]"
    push = 8 * Chain(damping=0.3).free_velocity_width
    speed = browser.execute_script(fast)
    ActionChains(browser).send_keys("p").perform()  # on a fresh page, before anything has the focus
    assert browser.execute_script(fast) == pytest.approx(speed + push)
    visit(browser, address, quiet=True)
    reached = []  # by Tab, from the top to the end
    while (focused := browser.execute_script(FOCUSED)) or not reached:
        if focused in reached[:1] or len(reached) == 100:
            break
        reached += [focused] if focused else []
        ActionChains(browser).send_keys("\ue004").perform()
    outlines = {element.accessible_name: outline for element, outline in reached}
    assert len(outlines) == len(reached) == 33
    assert min(outlines.values()) >= 3
    control(browser, "restitution").send_keys("\ue012")
    assert browser.execute_script(CHAIN)["restitution"] == 0.99
    time = browser.execute_script(TIME)
    until(lambda: browser.execute_script("return performance.now()") > 1000, 20)
    assert browser.execute_script(TIME) == time  # whoever wants no motion gets none
    press(browser, control(browser, "step"), "keys")
    assert re.match(r"Met at t = [\d.]+ t₀: rods \d+ and \d+", text(browser, "status"))
    control(browser, "play").send_keys(" ")
    until(lambda: browser.execute_script(TIME) > time + 0.1, 20)


def test_each_picture_is_described_in_numbers(browser, address):
    visit(browser, address + "#size=20&restitution=0.9&speed=100", quiet=True)
    rows(browser, 200)
    for option, description in (
        ("density", r"Density, measured: rods .* \d+ % of the time, from x = -?\d+ to \d+ R\."),
        ("widths", r"Velocity widths .*, measured: 0\.\d+, 0\.\d+, 0\.\d+ W; gas: 0.*\."),
        ("velocities", r"Velocities, measured: .* \d\.\d W in the middle and \d\.\d W at .*"),
        ("energy", r"Energy: from [\d.]+ to [\d.]+ times that of free rods within \d+ t₀\."),
    ):
        script = "arguments[0].value = arguments[1]"
        browser.execute_script(script, control(browser, "second-picture"), option)
        rows(browser, 1)
        assert re.fullmatch(description, browser.execute_script(LABEL))
    stage = control(browser, "stage").get_attribute("aria-label")
    assert re.search(r"The rods, .* Now \d+ of 20 rods move to the right\.$", stage, re.DOTALL)


def test_a_rod_follows_the_pointer_and_pushes_the_others(browser, address):
    visit(browser, address)
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


def test_a_theory_is_solved_as_the_chain_changes_and_states_its_error(browser, address):
    """By the server; the other answers come from this process, which needs no start."""
    visit(browser, address + "#size=20", quiet=False)
    slide(browser, restitution=0.95)
    gas = r"gas: velocity widths within [\d.]+ %, .*density within"
    until(lambda: re.match(gas, text(browser, "theory")), 60)
    for chain, statement in (
        ({"gap": 0.5}, r"exact equilibrium: exact\. force balance: .*density within"),
        ({"amplitude": 0}, "No theory: without noise there is no steady motion"),
    ):
        browser.execute_script(ANSWERED, theory.answer(urlencode({"size": 20, **chain})))
        slide(browser, restitution=1, **chain)
        until(lambda said=statement: re.match(said, text(browser, "theory")), 60)
    assert errors(browser) == []


@pytest.mark.parametrize(
    ("number", "moves"),
    [
        (1, [({"restitution": 1}, "= 1: it arr"), ({"restitution": 0.9}, "= 0.9: it does not")]),
        (2, [({"size": 15, "restitution": 1.05}, "times"), ({"damping": 0.2}, "than .* 6.1 rods")]),
    ],
)
def test_a_challenge_is_solved_by_its_sliders_and_then_answered(browser, address, number, moves):
    """By the last of the moves, each of which has come to its end when the page says something."""
    visit(browser, address, quiet=True)
    press(browser, challenges(browser)[number - 1])
    show(browser)
    for values, verdict in moves:
        assert text(browser, "answer") == ""
        slide(browser, **values)
        for _ in range(50):
            if number == 1:
                browser.execute_script("arguments[0].click()", control(browser, "push"))
            if re.search(verdict, last := rows(browser, 400)):
                break
        assert re.search(verdict, last)
    assert [button.text[-1] == "✓" for button in challenges(browser)].index(True) == number - 1
    assert len(text(browser, "answer")) > 50
