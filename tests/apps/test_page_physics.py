"""The page computes in the reader's browser what the package computes, also of a gas in a box."""

import re
from dataclasses import asdict
from itertools import product

import numpy as np
import pytest
from browser import errors
from driven_page import control, rows, show, slide, text, turn, visit

import crazybilliards as cb
from crazybilliards.comparison.coverage import coverage_density
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import EXACT, make_scratch
from crazybilliards.particles.noise import fill, make_noise
from crazybilliards.particles.scales import default_time_step, relaxation_time
from crazybilliards.particles.stepping import advance

pytestmark = [pytest.mark.validate, pytest.mark.compiled]

STEPS = """
const [chain, y, v, normals, duration, steps] = arguments;
const state = ChainPhysics.makeState(chain, 1);
state.normal = () => normals.shift();
state.y.set(y);
state.v.set(v);
ChainPhysics.advance(state, duration, steps);
return [Array.from(state.y), Array.from(state.v), state.collisions];
"""
NUMBERS = """
const P = ChainPhysics;
return arguments[0].map(([chain, duration]) => {
  const step = P.makeStep(chain, duration);
  const { yy, yv, vy, vv, noise, shared, own } = P.propagator(chain, duration);
  return [P.timeStep(chain), P.relaxationTime(chain), P.freeWidth(chain), P.thermalLength(chain),
    step.whole.decay, step.whole.noise, step.half.decay, step.half.noise, step.pull, step.closed,
    step.closedHalf, step.mergeSpeed, yy, yv, vy, vv, noise, shared, own];
});
"""
GROWTH = """
const [chain, rate] = arguments, { world } = ChainRunning;
ChainRunning.begin(chain);
world.history = Array.from({length: 50}, (_, k) => [k, 5 * Math.exp(rate * k)]);
return ChainRunning.growthRate();
"""
COVERED = """
const found = ChainMeasuring.exactCoverage(...arguments);
return [found, ChainMeasuring.averaged(found.map((share, k) => [k, share])).map(([, y]) => y)];
"""
MEASURE = """
const [chain, blocks, rows] = arguments, { world } = ChainRunning, squares = [], shares = [];
ChainRunning.begin(chain), ChainRunning.setSpeed(100);
for (let block = 0; block < blocks; block++) {
  world.measurement.clear();
  for (let row = 0; row < rows; row++) ChainRunning.goOn();
  squares.push(world.measurement.widths().map((width) => width ** 2));
  shares.push(world.measurement.coverage().map(([, share]) => share));
}
return [squares, shares, world.measurement.coverage().map(([x]) => x)];
"""
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


@pytest.fixture(scope="module")
def page(browser, address):
    visit(browser, address, quiet=True)
    return browser


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("gap", [0.0, 0.3])
@pytest.mark.parametrize("amplitude", [0.0, 1.0])
@pytest.mark.parametrize("e", [0.0, 0.1, 0.5, 1.0, 1.05])
def test_steps_are_those_of_the_package_under_the_same_noise(page, e, amplitude, gap, spring):
    """Many collisions a step. At e = 1, on linear springs without a gap, both fly exactly."""
    others = {"amplitude": amplitude, "damping": 0.5, "gap": gap, "spring": spring}
    chain = cb.Chain(size=20, restitution=e, **others)
    rng = np.random.default_rng(4)
    places, v = rng.uniform(-3, 3, 19), rng.normal(size=20)
    y = np.sort([*places, places[0]])  # two rods touch
    dynamics = make_dynamics(chain, 0.5, speed=1.0)
    noises = [make_noise(np.random.SeedSequence(1)) for _ in range(2)]
    normals = np.empty((4, 2, 20))  # of which the exact flight takes two at once for each rod
    fill(noises[0], normals.ravel())
    if dynamics.law.operator == EXACT:
        normals = normals.swapaxes(1, 2)
    starts = list(y), list(v), normals.ravel().tolist()
    found_y, found_v, met = page.execute_script(STEPS, asdict(chain), *starts, 0.5, 4)
    assert met > 12
    advance(y, v, noises[1], dynamics, make_scratch(20), make_tally(20, contacts=False), 4)
    np.testing.assert_allclose([found_y, found_v], [y, v], atol=1e-9)


def test_scales_and_steps_have_the_numbers_of_the_package(page):
    """Weakly, critically and strongly damped, for short and long steps."""
    asked, expected = [], []
    for e, damping, spring, (gap, duration) in product(
        [0.1, 0.7, 1.0, 1.05],
        [0.1, 2 * (4 * np.pi / 3) ** 0.5, 10.0],
        ["linear", "quadratic"],
        [(0.0, 0.005), (0.5, 0.5), (0.5, 30.0)],
    ):
        others = {"amplitude": 2.0, "damping": damping, "gap": gap, "spring": spring}
        chain = cb.Chain(size=20, restitution=e, **others)
        of = make_dynamics(chain, duration, speed=chain.free_velocity_width)
        scales = default_time_step(chain), relaxation_time(chain)
        scales += chain.free_velocity_width, chain.thermal_length
        steps = *of.step[1:6], *of.step[8:], of.law.merge_speed
        asked.append((asdict(chain), duration))
        expected.append([*scales, *steps, *of.propagator])
    found = page.execute_script(NUMBERS, asked)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_the_growth_is_found(page):
    assert page.execute_script(GROWTH, asdict(cb.Chain(size=34, restitution=1.03)), 0.07) == (
        pytest.approx(0.07)
    )


def test_noise_is_normal_and_white(page):
    x = np.array(page.execute_script("return Array.from({length: 2e5}, ChainPhysics.makeNoise(5))"))
    for power, moment, variance in ((1, 0, 1), (2, 1, 2), (4, 3, 96)):
        assert abs((x**power).mean() - moment) < 5 * (variance / x.size) ** 0.5
    for lag in (1, 2, 3, 20):
        assert abs((x[lag:] * x[:-lag]).mean()) < 5 / x.size**0.5


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("amplitude", [1.0, 10.0])
@pytest.mark.parametrize(("size", "gap"), [(10, 0.0), (20, 0.5), (60, 0.0), (30, 3.0)])
def test_the_exact_density_is_that_of_equilibrium(page, size, gap, amplitude, spring):
    """The package's is the mean over each of its bins, and its average over 2R is smooth."""
    chain = cb.Chain(size=size, amplitude=amplitude, damping=0.5, gap=gap, spring=spring)
    theory = cb.equilibrium(chain)
    places, weights = np.polynomial.legendre.leggauss(3)
    x = theory.x.values
    places = x[:, None] + places * (x[1] - x[0]) / 2
    found, _ = page.execute_script(COVERED, asdict(chain), places.ravel().tolist())
    density = coverage_density(theory).density * 2 * chain.radius
    assert np.abs(np.reshape(found, places.shape) @ weights / 2 - density).max() < 2e-4
    fine = np.arange(x[0], x[-1], 1 / 8)
    _, found = page.execute_script(COVERED, asdict(chain), fine.tolist())
    density = cb.smooth(theory).density.interp(x=fine) * 2 * chain.radius
    assert np.abs(np.array(found) - density).max() < 1e-3


@pytest.mark.parametrize(("gap", "spring"), [(0.0, "linear"), (0.2, "quadratic")])
def test_widths_and_density_are_exact_at_restitution_one(page, gap, spring):
    chain = cb.Chain(size=10, damping=0.5, gap=gap, spring=spring)
    squares, shares, places = page.execute_script(MEASURE, asdict(chain), 64, 200)
    exact = np.array(page.execute_script(COVERED, asdict(chain), places)[0])
    seen = (exact > 0.01) & (exact < 0.99)
    assert seen.sum() > 150
    expected = [chain.free_velocity_width**2, chain.free_velocity_width**2, exact[seen]]
    found = np.array(squares), np.mean(squares, axis=1), np.array(shares)[:, seen]
    for blocks, mean in zip(found, expected, strict=True):
        assert np.all(np.abs(blocks.mean(0) - mean) < 5 * blocks.std(0, ddof=1) / 8)


# -- a gas in a box ----------------------------------------------------------------------------


@pytest.mark.parametrize(("box", "mass_ratio"), [(60, 1), (41, 3), (60, 100)])
def test_a_gas_flies_like_that_of_the_package(page, box, mass_ratio):
    """Until the rods have met a hundred times or more; later two masses forget how they began."""
    gas = cb.Chain(size=20, amplitude=0, damping=0, stiffness=0, box=box, mass_ratio=mass_ratio)
    rng = np.random.default_rng(8)
    free, duration, steps = box - 40, (box - 40) / 40, 20
    y, v = np.sort(rng.uniform(-free / 2, free / 2, 20)), rng.normal(size=20)
    start = asdict(gas) | {"spring": "none"}, y.tolist(), v.tolist(), duration, steps
    page_y, page_v, collisions, *hits, impulse = page.execute_script(FLIGHT, *start)
    assert collisions > 100
    assert sum(hits) > 5
    momentum = gas.rod_masses * v
    dynamics = make_dynamics(gas, duration, speed=1.0)
    scratch, tally = make_scratch(20, dynamics.inverse), make_tally(20, contacts=False)
    advance(y, v, make_noise(np.random.SeedSequence(1)), dynamics, scratch, tally, steps)
    np.testing.assert_allclose([page_y, page_v], [y, v], atol=1e-9)
    assert impulse >= abs((gas.rod_masses * v - momentum).sum())


def test_two_rods_count_the_digits_of_pi_in_every_box(page):
    assert page.execute_script(COUNTED) == [[n] * 3 for n in (3, 31, 314, 3141)]


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
    show(browser)
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
    numbers = re.search(r"mean ([\d.]+) ± ([\d.]+), exact: L T/\(X \S 2RL\) = ([\d.]+)\.", gauge)
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
        show(browser)
        assert reason in rows(browser, 1500)
        assert text(browser, "answer") == ""
