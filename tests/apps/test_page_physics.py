"""The page computes in the reader's browser what the package computes."""

import numpy as np
import pytest

import crazybilliards as cb
from crazybilliards.comparison.coverage import coverage_density
from crazybilliards.particles.dynamics import make_dynamics, start_noise
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.exact_flight import make_propagator
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.scales import default_time_step, relaxation_time
from crazybilliards.particles.stepping import advance

RESTITUTIONS = [0.0, 0.5, 1.0, 1.05]
BLOCKS, RUNS = 64, 32  # of the page, of the package
pytestmark = [pytest.mark.validate, pytest.mark.compiled]

STEPS = """
const [chain, y, v, duration, steps] = arguments, state = ChainPhysics.makeState(chain, 1);
state.y.set(y);
state.v.set(v);
ChainPhysics.advance(state, duration, steps);
return [Array.from(state.y), Array.from(state.v), state.collisions];
"""
MEASURE = """
const [chain, seed, step, warm, every, samples, blocks] = arguments;
const state = ChainPhysics.makeState(chain, seed), found = [];
ChainPhysics.advance(state, step, warm);
for (let block = 0; block < blocks; block++) {
  const measurement = new ChainMeasuring.Measurement(state, 40);
  measurement.settling = 0;
  for (let k = 0; k < samples; k++) {
    ChainPhysics.advance(state, step, every);
    measurement.add(state, every * step, 1);
  }
  found.push([Array.from(measurement.squares), measurement.coverage().map(([, share]) => share)]);
}
return [found, new ChainMeasuring.Measurement(state, 40).coverage().map(([x]) => x)];
"""


@pytest.fixture(scope="module")
def page(browser, address):
    browser.get(address)
    browser.execute_script("ChainControls.pause()")
    browser.set_script_timeout(300)
    return browser


def plain(chain):
    """Return the parameters that the page knows."""
    names = ("size", "restitution", "amplitude", "damping", "gap", "spring")
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


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize("gap", [0.0, 0.3])
@pytest.mark.parametrize("e", RESTITUTIONS)
def test_steps_without_noise_are_those_of_the_package(page, e, gap, spring):
    """Many collisions a step. At e = 1, on linear springs without a gap, both fly exactly."""
    chain = cb.Chain(size=20, restitution=e, amplitude=0.0, damping=0.5, gap=gap, spring=spring)
    rng = np.random.default_rng(4)
    y, v = np.sort(rng.uniform(-3, 3, 20)), rng.normal(size=20)
    found_y, found_v, met = page.execute_script(STEPS, plain(chain), list(y), list(v), 0.5, 4)
    assert met > 12
    dynamics = make_dynamics(chain, 0.5, speed=1.0)
    noise = start_noise(np.random.SeedSequence(1), dynamics)
    advance(y, v, noise, dynamics, make_scratch(20), make_tally(20, contacts=False), 4)
    np.testing.assert_allclose(found_y, y, atol=1e-9)
    np.testing.assert_allclose(found_v, v, atol=1e-9)


def test_scales_are_those_of_the_package(page):
    chains = [
        cb.Chain(size=20, restitution=e, damping=damping, gap=gap, amplitude=2.0, spring=spring)
        for e in (0.0, 0.7, 1.0, 1.05)
        for damping in (0.3, 3.0, 9.0)
        for gap in (0.0, 0.5)
        for spring in ("linear", "quadratic")
    ]
    for chain in chains:
        found = page.execute_script(
            "const P = ChainPhysics;"
            "return [P.timeStep, P.relaxationTime, P.freeWidth, P.thermalLength]"
            ".map((scale) => scale(arguments[0]));",
            plain(chain),
        )
        scales = default_time_step(chain), relaxation_time(chain)
        scales += chain.free_velocity_width, chain.thermal_length
        assert found == pytest.approx(scales, rel=1e-12)


@pytest.mark.parametrize("damping", [0.1, 1.0, 2 * (4 * np.pi / 3) ** 0.5, 10.0])
@pytest.mark.parametrize("duration", [0.005, 0.5, 30.0])
def test_the_exact_flight_has_the_numbers_of_the_package(page, damping, duration):
    """Weakly, critically and strongly damped."""
    chain = cb.Chain(damping=damping, amplitude=2.0)
    script = "const p = ChainPhysics.propagator(...arguments);"
    script += "return [p.yy, p.yv, p.vy, p.vv, p.noise, p.shared, p.own];"
    found = page.execute_script(script, plain(chain), duration)
    assert found == pytest.approx(list(make_propagator(chain, duration)), rel=1e-6, abs=1e-9)


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


@pytest.mark.parametrize("spring", ["linear", "quadratic"])
@pytest.mark.parametrize(("size", "gap"), [(10, 0.0), (20, 0.5), (60, 0.0), (30, 3.0)])
def test_the_exact_density_is_that_of_equilibrium(page, size, gap, spring):
    chain = cb.Chain(size=size, amplitude=4.0, damping=0.5, gap=gap, spring=spring)
    expected = coverage_density(cb.equilibrium(chain))
    script = "return ChainMeasuring.exactCoverage(arguments[0], arguments[1]);"
    found = page.execute_script(script, plain(chain), expected.x.values.tolist())
    assert np.abs(np.array(found) - 2 * chain.radius * expected.density.values).max() < 1e-3


@pytest.mark.parametrize(
    ("size", "gap", "spring"), [(20, 0.5, "linear"), (10, 0.0, "linear"), (10, 0.2, "quadratic")]
)
def test_widths_and_density_are_exact_at_restitution_one(page, size, gap, spring):
    chain = cb.Chain(size=size, damping=0.5, gap=gap, spring=spring)
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
