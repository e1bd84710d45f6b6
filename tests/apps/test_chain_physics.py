"""The chain of docs/chain.md computes in the reader's browser what the package computes."""

from collections.abc import Iterator

import numpy as np
import pytest
from chain_pictures import written

import crazybilliards as cb
from crazybilliards.comparison.coverage import coverage_density
from crazybilliards.particles.dynamics import default_merging, make_dynamics, make_step, start_noise
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import drift, make_law, make_scratch
from crazybilliards.particles.scales import default_time_step
from crazybilliards.particles.stepping import advance

RESTITUTIONS = [0.0, 0.5, 1.0, 1.05]
BLOCKS, RUNS = 64, 32  # of the page, of the package
pytestmark = [pytest.mark.validate, pytest.mark.compiled]

STATE = """
const [chain, y, v, duration, steps] = arguments;
const state = ChainPhysics.makeState(chain, 1);
state.y.set(y);
state.v.set(v);
"""
DRIFT = "ChainPhysics.driftInOrder(state, ChainPhysics.makeStep(chain, duration));"
RESULT = "return [Array.from(state.y), Array.from(state.v), state.collisions];"
MEASURE = """
const [chain, seed, step, warm, every, samples, blocks] = arguments;
const state = ChainPhysics.makeState(chain, seed), found = [];
ChainPhysics.advance(state, step, warm);
for (let block = 0; block < blocks; block++) {
  const measurement = new ChainMeasuring.Measurement(state, 40);
  measurement.settling = 0;
  for (let k = 0; k < samples; k++) {
    ChainPhysics.advance(state, step, every);
    measurement.add(state, every * step);
  }
  found.push([Array.from(measurement.squares), measurement.coverage().map(([, share]) => share)]);
}
return [found, new ChainMeasuring.Measurement(state, 40).coverage().map(([x]) => x)];
"""


@pytest.fixture(scope="module")
def page(browser) -> Iterator:
    with written() as address:
        browser.get(address)
        browser.execute_script("ChainControls.pause()")
        browser.set_script_timeout(300)
        yield browser


def plain(chain):
    """Return the parameters that the page knows."""
    names = ("size", "restitution", "amplitude", "damping", "gap")
    return {name: getattr(chain, name) for name in names}


def measure(page, chain, *, step, duration):
    """Return W_v^2 and coverage of the page's chain in blocks of time, and the places of these."""
    every, warm = max(1, round(0.5 / step)), round(100 / step)
    samples = round(duration / BLOCKS / (every * step))
    blocks, places = page.execute_script(
        MEASURE, plain(chain), 1, step, warm, every, samples, BLOCKS
    )
    squares, shares = (np.array(each) for each in zip(*blocks, strict=True))
    return squares / samples, shares, places


def averaged(blocks):
    """Return the mean of independent blocks and its standard error."""
    return blocks.mean(0), blocks.std(0, ddof=1) / len(blocks) ** 0.5


@pytest.mark.parametrize("e", RESTITUTIONS)
def test_a_collision_keeps_momentum_and_the_energy_that_restitution_leaves(page, e):
    """Rods of one chain meet here once: their energy changes by -(1 - e^2) m (v1 - v2)^2/4."""
    chain = plain(cb.Chain(size=2, restitution=e))
    rng = np.random.default_rng(1)
    for v in rng.normal((2.0, -2.0), size=(20, 2)):
        _, after, collisions = page.execute_script(
            STATE + DRIFT + RESULT, chain, [-0.1, 0.1], list(v), 1.0
        )
        after = np.array(after)
        assert collisions == 1
        assert after.sum() == pytest.approx(v.sum(), abs=1e-14)
        lost = (v**2).sum() / 2 - (after**2).sum() / 2
        assert lost == pytest.approx((1 - e**2) * (v[0] - v[1]) ** 2 / 4, abs=1e-13)


@pytest.mark.parametrize("e", RESTITUTIONS)
def test_a_flight_with_many_collisions_is_that_of_the_package(page, e):
    chain = cb.Chain(size=20, restitution=e, amplitude=0.0)
    law = make_law(chain, 1.0, "event-driven", 0.0, 1.0)
    rng = np.random.default_rng(2)
    for _ in range(20):
        y, v = np.sort(rng.uniform(0, 5, 20)), rng.normal(size=20)
        found_y, found_v, met = page.execute_script(
            STATE + DRIFT + RESULT, plain(chain), list(y), list(v), 1.0
        )
        assert met > 8  # at e = 0 there are at most 19, after which all rods move as one
        assert sum(found_v) == pytest.approx(v.sum(), abs=1e-12)
        tally = make_tally(20, contacts=False)
        drift(y, v, chain.reduced_anchors, 1.0, law, make_scratch(20), tally)
        np.testing.assert_allclose(found_y, y, atol=1e-11)
        np.testing.assert_allclose(found_v, v, atol=1e-11)


def test_sorting_is_one_elastic_collision_after_the_other(page):
    chain = plain(cb.Chain(size=20))
    rng = np.random.default_rng(3)
    y, v = np.sort(rng.uniform(0, 5, 20)), rng.normal(size=20)
    sort = "ChainPhysics.driftBySorting(state, duration);"
    one, other = (
        page.execute_script(STATE + way + RESULT, chain, list(y), list(v), 1.0)
        for way in (DRIFT, sort)
    )
    np.testing.assert_allclose(one[0], other[0], atol=1e-12)
    np.testing.assert_allclose(one[1], other[1], atol=1e-12)
    assert one[2] == other[2] > 20


@pytest.mark.parametrize("e", RESTITUTIONS)
def test_steps_without_noise_are_those_of_the_package(page, e):
    chain = cb.Chain(size=10, restitution=e, amplitude=0.0, damping=0.5, gap=0.3)
    rng = np.random.default_rng(4)
    y, v = np.sort(rng.normal(0, 3, 10)), rng.normal(size=10)
    go = "ChainPhysics.advance(state, duration, steps);"
    found = page.execute_script(STATE + go + RESULT, plain(chain), list(y), list(v), 0.05, 60)
    dynamics = make_dynamics(chain, 0.05, speed=1.0)
    noise = start_noise(np.random.SeedSequence(1), dynamics)
    scratch, tally = make_scratch(10), make_tally(10, contacts=False)
    advance(y, v, noise, dynamics, scratch, tally, 60)
    np.testing.assert_allclose(found[0], y, atol=1e-9)
    np.testing.assert_allclose(found[1], v, atol=1e-9)


def test_scales_are_those_of_the_package(page):
    chains = [
        cb.Chain(size=20, restitution=e, damping=damping, gap=gap, amplitude=2.0)
        for e in (0.0, 0.7, 1.0, 1.05)
        for damping in (0.3, 3.0, 9.0)
        for gap in (0.0, 0.5)
    ]
    for chain in chains:
        step, width, length = page.execute_script(
            "const P = ChainPhysics, chain = arguments[0];"
            "return [P.timeStep(chain), P.freeWidth(chain), P.thermalLength(chain)];",
            plain(chain),
        )
        assert step == pytest.approx(default_time_step(chain), rel=1e-12)
        assert width == pytest.approx(chain.free_velocity_width, rel=1e-12)
        assert length == pytest.approx(chain.thermal_length, rel=1e-12)


def test_the_same_seed_gives_the_same_chain(page):
    chain, script = (
        plain(cb.Chain(size=10, restitution=0.5)),
        (
            "const state = ChainPhysics.makeState(arguments[0], arguments[1]);"
            "ChainPhysics.advance(state, 0.05, 200); return Array.from(state.y);"
        ),
    )
    one, same, other = (page.execute_script(script, chain, seed) for seed in (7, 7, 8))
    assert one == same != other


def test_noise_is_normal_and_white(page):
    script = (
        "const normal = ChainPhysics.makeNoise(5);"
        "return Array.from({length: 200000}, () => normal());"
    )
    x = np.array(page.execute_script(script))
    error = len(x) ** -0.5
    assert abs(x.mean()) < 5 * error
    assert abs((x**2).mean() - 1) < 5 * 2**0.5 * error
    assert abs((x**4).mean() - 3) < 5 * 96**0.5 * error
    for lag in (1, 2, 3, 20):
        assert abs((x[lag:] * x[:-lag]).mean()) < 5 * error


@pytest.mark.parametrize(("size", "gap"), [(10, 0.0), (20, 0.5), (60, 0.0), (30, 3.0)])
def test_the_exact_density_is_that_of_equilibrium(page, size, gap):
    chain = cb.Chain(size=size, amplitude=2.0, damping=0.5, gap=gap)
    expected = coverage_density(cb.equilibrium(chain))
    script = "return ChainMeasuring.exactCoverage(arguments[0], arguments[1]);"
    found = page.execute_script(script, plain(chain), expected.x.values.tolist())
    assert np.abs(np.array(found) - 2 * chain.radius * expected.density.values).max() < 1e-3


@pytest.mark.parametrize("e", [0.0, 0.1, 0.5, 1.0, 1.05])
def test_a_step_has_the_numbers_of_the_package(page, e):
    chain = cb.Chain(size=20, restitution=e, damping=2.0, amplitude=3.0)
    step = make_step(chain, 0.04, "splitting")
    law = make_law(chain, 0.04, "event-driven", default_merging(chain), 1.0)
    found = page.execute_script("return ChainPhysics.makeStep(...arguments)", plain(chain), 0.04)
    numbers = {
        "duration": step.time_step,
        "whole": {"decay": step.decay, "noise": step.noise},
        "half": {"decay": step.outer_decay, "noise": step.outer_noise},
        "closed": step.closed,
        "closedHalf": step.closed_outer,
        "pull": step.kick,
        "mergeSpeed": law.merge_speed if e < 1 else -1,
    }
    for name in ("whole", "half"):
        assert found.pop(name) == pytest.approx(numbers.pop(name), rel=1e-12)
    assert found == pytest.approx(numbers, rel=1e-12)


@pytest.mark.parametrize(("size", "gap"), [(20, 0.5), (10, 0.0)])
def test_widths_and_density_are_exact_at_restitution_one(page, size, gap):
    chain = cb.Chain(size=size, damping=0.5, gap=gap)
    step = default_time_step(chain) / 4  # whose error of the displacements, 0.004 %, is too small
    squares, shares, places = measure(page, chain, step=step, duration=20_000)
    mean, error = averaged(squares)
    assert (np.abs(mean - chain.free_velocity_width**2) < 5 * error).all()
    mean, error = averaged(squares.mean(1))
    assert abs(mean - chain.free_velocity_width**2) < 5 * error
    script = "return ChainMeasuring.exactCoverage(arguments[0], arguments[1]);"
    exact = np.array(page.execute_script(script, plain(chain), places))
    mean, error = averaged(shares)
    seen = (exact > 0.01) & (exact < 0.99)
    assert seen.sum() > 150
    assert (np.abs(mean - exact) < 5 * error)[seen].all()


@pytest.mark.parametrize("e", [0.0, 0.5, 1.05])
def test_widths_are_those_of_simulate(page, e):
    """Those of each rod, and of all rods together, which are known ten times better."""
    chain = cb.Chain(size=20, restitution=e, gap=0.1)
    step = default_time_step(chain)
    squares, *_ = measure(page, chain, step=step, duration=60_000)
    settings = {"duration": 60_000 / RUNS, "time_step": step, "threads": 1}
    runs = [cb.simulate(chain, seed=seed, **settings) for seed in range(RUNS)]
    theirs = np.array([run.velocity_width.values**2 for run in runs])
    for here, there in ((squares, theirs), (squares.mean(1), theirs.mean(1))):
        (mean, error), (expected, expected_error) = averaged(here), averaged(there)
        assert np.abs((mean - expected) / np.hypot(error, expected_error)).max() < 5
