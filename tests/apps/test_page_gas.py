"""The page's gas in a box: it flies like the package's, and its challenges can be solved."""

import re
from dataclasses import asdict

import numpy as np
import pytest
from browser import errors
from driven_page import control, rows, slide, text, turn, visit

import crazybilliards as cb
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.stepping import advance

pytestmark = pytest.mark.validate

FLIGHT = """
const [chain, y, v, duration, steps] = arguments, state = ChainGas.makeState(chain, 1);
state.y.set(y), state.v.set(v);
for (let k = 0; k < steps; k++) ChainGas.go(state, duration);
return [Array.from(state.y), Array.from(state.v), state.collisions, ...state.hits, state.impulse];
"""
COUNTED = """
return [1, 100, 1e4, 1e6].map((mass_ratio) => [8, 30, 600].map((box) => {
  const state = ChainGas.makeState({spring: "none", size: 2, box, mass_ratio}, 1);
  while (state.series === null) ChainGas.go(state, 0.1);
  return state.series;
}));
"""


@pytest.mark.compiled
@pytest.mark.parametrize(("box", "mass_ratio"), [(60, 1), (41, 3), (60, 100)])
def test_a_gas_flies_like_that_of_the_package(browser, address, box, mass_ratio):
    """Until the rods have met a hundred times or more; later two masses forget how they began."""
    gas = cb.Chain(size=20, amplitude=0, damping=0, stiffness=0, box=box, mass_ratio=mass_ratio)
    rng = np.random.default_rng(8)
    free, duration, steps = box - 40, (box - 40) / 40, 20
    y, v = np.sort(rng.uniform(-free / 2, free / 2, 20)), rng.normal(size=20)
    start = asdict(gas) | {"spring": "none"}, y.tolist(), v.tolist(), duration, steps
    visit(browser, address, quiet=True)
    page_y, page_v, collisions, *hits, impulse = browser.execute_script(FLIGHT, *start)
    assert collisions > 100
    assert sum(hits) > 5
    momentum = gas.rod_masses * v
    dynamics = make_dynamics(gas, duration, speed=1.0)
    scratch, tally = make_scratch(20, dynamics.inverse), make_tally(20, contacts=False)
    advance(y, v, make_noise(np.random.SeedSequence(1)), dynamics, scratch, tally, steps)
    np.testing.assert_allclose([page_y, page_v], [y, v], atol=1e-9)
    assert impulse >= abs((gas.rod_masses * v - momentum).sum())


def test_two_rods_count_the_digits_of_pi_in_every_box(browser, address):
    visit(browser, address, quiet=True)
    assert browser.execute_script(COUNTED) == [[n] * 3 for n in (3, 31, 314, 3141)]


@pytest.mark.parametrize(
    ("name", "values", "verdict"),
    [
        ("pressure", {"box": (80, 50, 160)}, r"begins at (2\.0\d\d|1\.9\d\d) ± 0\.0"),
        ("maxwell", {"mass_ratio": (1, 2)}, r"one mass: 1\.00 ± 0\.00, of two: 2\.[678]"),
        ("count", {"mass_ratio": (100, 10000, 1)}, "3 with 1, 31 with 100, 314 with 10000"),
    ],
)
def test_a_challenge_of_the_gas_is_solved_and_then_answered(
    browser, address, name, values, verdict
):
    visit(browser, f"{address}#challenge={name}", "narrow", quiet=True)
    assert not control(browser, "damping").is_displayed()
    assert not control(browser, "push").is_displayed()
    [(parameter, series)] = values.items()
    for value in series:
        assert text(browser, "answer") == ""
        slide(browser, **{parameter: value})
        last = rows(browser, 1500)
    assert re.search(verdict, last)
    assert len(text(browser, "answer")) > 50
    assert errors(browser) == []


def test_the_gauge_is_beside_the_exact_force_and_the_box_holds_its_rods(browser, address):
    visit(browser, address + "#spring=none&size=20&box=60&mass_ratio=3&speed=100", quiet=True)
    rows(browser, 3000)
    gauge = text(browser, "gauge")
    numbers = re.search(r": ([\d.]+) ± ([\d.]+), exact: L T/\(X \S 2RL\) = ([\d.]+)\.", gauge)
    force, error, law = (float(number) for number in numbers.groups())
    assert abs(force - law) < 5 * error < 0.1 * law
    slide(browser, size=200)
    assert browser.execute_script("return ChainRunning.world.state.chain.box") == 402
    assert errors(browser) == []


def test_a_question_is_not_judged_on_a_chain_that_it_is_not_about(browser, address):
    visit(browser, address, quiet=True)
    for setting, spring, reason in (
        ("ends", "none", "This question is about rods on springs."),
        ("maxwell", "linear", "This question is about a gas in a box."),
        ("maxwell&size=9", "none", "Only gases of 10 rods or more"),
    ):
        turn(browser, f"#challenge={setting}&speed=300")
        slide(browser, spring=spring)
        assert reason in rows(browser, 1500)
        assert text(browser, "answer") == ""
