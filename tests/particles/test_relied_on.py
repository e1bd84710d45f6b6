"""What somebody relies on who cannot check: error bars, step errors, new noise, all rods."""

import warnings

import numpy as np
import pytest
from described_runs import a_run

from crazybilliards.comparison import coverage_density, deviation, overlay, smooth
from crazybilliards.kinetic import equilibrium, equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import ShortRunWarning, given_start, relaxation_time, simulate
from crazybilliards.particles.observers import Density, TimeCorrelations
from crazybilliards.particles.observers.error_bars import jackknife

QUIET = {"progress": False, "threads": 1}


def ensemble(chain, **settings):
    """Return an ensemble of eight that starts at rest, for a short time."""
    defaults = {"duration": 20, "replicas": 8, "average": "ensemble", "observe": "widths"}
    return simulate(chain, **(defaults | settings), **QUIET)


FIVE = Chain(size=5)
DISSIPATIVE, WIDE = FIVE.replace(restitution=0.9), FIVE.replace(gap=1.0)


@pytest.mark.parametrize(
    ("chain", "settings", "known"),
    [
        (DISSIPATIVE, {}, True),
        (DISSIPATIVE, {"observe": "energy"}, True),
        (WIDE, {}, True),
        (FIVE.replace(spring="quadratic"), {}, True),
        (FIVE, {"stepper": "euler"}, True),
        (DISSIPATIVE.replace(amplitude=0), {"start": "pushed"}, False),
        (DISSIPATIVE.replace(damping=0), {"observe": "energy"}, False),
        (WIDE.replace(damping=0), {}, False),
        (WIDE, {"stepper": "euler"}, False),
        (DISSIPATIVE, {"method": "contact-dynamics"}, False),
    ],
)
def test_the_error_of_the_step_is_never_zero_where_there_is_one(chain, settings, known):
    if "start" in settings:
        pushed = given_start(chain, chain.anchors, np.arange(5.0), replicas=8)
        settings = settings | {"start": pushed}
    error = ensemble(chain, **settings).attrs["time_step_error"]
    # With a width estimated from eight replicas it can be larger than any that is known.
    assert error > 0 if known else np.isnan(error)


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize(("damping", "relaxations"), [(0.1, 60), (1.0, 20), (10.0, 20)])
def test_error_bars_of_short_runs_cover(damping, relaxations):
    """The scatter of 200 runs, whose blocks would be shorter than the memory if they were 64.

    Ten rods that never meet are ten runs of one.
    """
    chain = Chain(size=10, damping=damping, gap=1000.0)
    duration = relaxations * relaxation_time(chain)
    settings = {"duration": duration, "observe": "widths", **QUIET}
    runs = [simulate(chain, seed=seed, **settings) for seed in range(20)]
    for name in ("velocity_width", "displacement_width", "mean_displacement"):
        values, errors = (
            np.concatenate([run[each].values for run in runs]) for each in (name, f"{name}_error")
        )
        assert 0.75 < values.std(ddof=1) / np.sqrt((errors**2).mean()) < 1.3, name


SHORT = [
    (Chain(size=3), {"duration": 100}, "duration=100 .* at least 167.6, or 10 replicas"),
    (Chain(size=3), {"warmup": 1}, "warmup=1 .* at least 41.89"),
    (Chain(size=3), {"start": "shifted"}, "warmup=0 .* at least 41.89"),
    (Chain(size=3, damping=0), {"time_step": 0.1}, "damping=0: .* never forgets .* mean nothing"),
    (Chain(size=3, stiffness=0), {}, "stiffness=0: .* spread .* mean nothing"),
    (Chain(size=3, amplitude=0), {"start": "shifted"}, "amplitude=0: .* rest.* mean nothing"),
]


@pytest.mark.parametrize(("chain", "settings", "message"), SHORT)
def test_an_average_that_is_too_short_says_so_once(chain, settings, message):
    if "start" in settings:
        settings = {"start": given_start(chain, chain.anchors + 5.0)}
    with pytest.warns(ShortRunWarning, match=message) as caught:
        simulate(chain, **({"duration": 200, "observe": "widths"} | settings), **QUIET)
    assert len(caught) == 1
    assert caught[0].filename == __file__


def test_what_free_rods_do_not_have_is_not_given():
    """Of a free rod the velocity has a steady state, and its displacement has none."""
    chain = Chain(size=1, stiffness=0)
    observe = ["widths", TimeCorrelations(longest=25)]
    with pytest.warns(ShortRunWarning, match="stiffness=0"):
        run = simulate(chain, duration=5000, observe=observe, **QUIET)
    assert np.isinf(run.autocorrelation_time).all()
    assert run.attrs["relaxation_time"] == np.inf
    for of in ("", "wave_", "centre_"):
        assert run[f"{of}displacement_autocorrelation"].isnull().all()
        assert run[f"{of}mean_squared_displacement"].notnull().all()
        assert run[f"{of}velocity_autocorrelation"].notnull().all()
    grown = run.mean_squared_displacement.isel(particle=0, lag=-1)
    time, decay = float(run.lag[-1]), chain.mass / chain.damping
    expected = 2 * chain.temperature / chain.damping
    expected *= time - decay * (1 - np.exp(-time / decay))
    error = run.mean_squared_displacement_error.isel(particle=0, lag=-1)
    assert abs(grown - expected) < 5 * error


def test_what_is_long_enough_or_has_nothing_to_forget_says_nothing():
    free = Chain(size=3, amplitude=0, damping=0)
    start = given_start(free, free.anchors, [1.0, 0.0, -1.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(free, duration=np.pi, every=0.1, observe="collisions", start=start, **QUIET)
        for settings in (
            {"duration": 200},
            {"duration": 20, "replicas": 10},
            {"duration": 100, "observe": "snapshots"},
            {"duration": 5, "average": "ensemble", "replicas": 2},
        ):
            simulate(Chain(size=3), **({"observe": "widths"} | settings), **QUIET)


def test_a_run_that_continues_another_one_has_new_noise():
    chain = Chain(size=4, restitution=0.9)
    times = {"duration": 400.0, "every": 1.0, "average": "ensemble", "observe": "snapshots"}
    centres, start = [], None
    for _ in range(3):
        run = simulate(chain, start=start, **times, **QUIET)
        start = run.isel(time=-1)
        centres.append(run.velocity.values[0, 50:].mean(axis=1))
    for one, other in ((0, 1), (1, 2), (0, 2)):
        assert abs(np.corrcoef(centres[one], centres[other])[0, 1]) < 5 / 100**0.5
    one, other = (simulate(chain, start=start, **times, **QUIET).velocity for _ in range(2))
    np.testing.assert_array_equal(one, other)


def rods(density):
    return float((density.sum("x") * (density.x[1] - density.x[0])).min())


@pytest.mark.parametrize(
    ("chain", "spread", "speed"),
    [
        (Chain(size=40, stiffness=0, damping=0, amplitude=0), 300.0, 3.0),
        (Chain(size=40, stiffness=0), 30.0, 1.0),
        (Chain(size=40, damping=0, gap=0.3), 10.0, 1.0),
        (Chain(size=40, restitution=0.5, gap=0.3), 100.0, 5.0),
        (Chain(size=40, spring="quadratic"), 100.0, 5.0),
    ],
)
def test_the_density_holds_every_rod_wherever_it_started(chain, spread, speed):
    generator = np.random.default_rng(1)
    position = chain.physical(np.sort(generator.uniform(-spread, spread, 40)))
    start = given_start(chain, position, speed * generator.normal(size=40), replicas=4)
    settings = {"duration": 20.0, "every": 0.5, "time_step": 0.1, "replicas": 4}
    run = simulate(chain, start=start, average="ensemble", observe="density", **settings, **QUIET)
    assert run.outside == 0
    assert rods(run.density) == pytest.approx(40)


def test_the_grid_of_the_density_can_be_chosen():
    with pytest.warns(UserWarning, match=r"Density\(reach=...\) makes the grid wider") as caught:
        run = ensemble(Chain(size=5, amplitude=20.0), observe=Density(reach=0.1))
    assert caught[0].filename == __file__
    assert run.outside > 0
    wide = ensemble(Chain(size=5), observe=Density(reach=200.0))
    assert wide.x[-1] > 200


@pytest.mark.parametrize("particles", [[1, 2], None])
def test_what_is_smoothed_is_what_was_observed(particles):
    chain = Chain(size=6)
    how = {"particles": particles, "observe": ("density", "snapshots")}
    run = simulate(chain, duration=2000, every=5, **how, **QUIET)
    smoothed = smooth(run)
    assert "density_error" in smoothed
    assert rods(smoothed.density) == pytest.approx(6)
    states = smooth(run.drop_vars(["density", "density_error", "density_block"]))
    assert rods(states.density) == pytest.approx(len(particles or range(6)))


def test_densities_that_are_not_alike_are_not_compared():
    chain = Chain(size=6)
    exact, states = equilibrium(chain), equilibrium_states(chain, 50)
    once, twice = coverage_density(exact), smooth(exact)
    for one, other in ((exact, twice), (once, twice), (exact, once)):
        with pytest.raises(ValueError, match=r"not smoothed alike .* take cb.smooth of all"):
            deviation(one, other)
        with pytest.raises(ValueError, match=r"a: .* b: "):
            overlay({"a": one, "b": other})
    assert deviation(smooth(once), twice).maximum == 0
    with pytest.raises(ValueError, match="hold 1 and 6 rods"):
        deviation(smooth(states.isel(particle=[2])), twice)
    other = smooth(equilibrium(chain.replace(gap=0.5, amplitude=2.0)))
    with pytest.warns(UserWarning, match=r"different chains: amplitude 2.0 and 1.0, gap 0.5 and 0"):
        deviation(other, twice)


@pytest.mark.compiled
@pytest.mark.validate
def test_the_largest_deviation_in_errors_is_as_documented():
    """Of 20 runs that agree with the exact density; rarely visited bins are left out."""
    chain = Chain(size=20, amplitude=5.0, gap=1.0)
    exact, how = smooth(equilibrium(chain)), {"observe": "density", **QUIET}
    runs = (simulate(chain, seed=seed, **how) for seed in range(20))
    pulls = np.array([deviation(smooth(run), exact).maximum_in_errors for run in runs])
    assert 2.7 < np.median(pulls) < 3.8
    assert (pulls > 4.5).mean() <= 0.125
    assert pulls.max() < 6


# -- blocks of time: the jackknife over them, and how long they are --------------------------------


def mean(average):
    return average


def test_the_error_of_a_mean_of_equal_blocks_is_the_standard_error():
    blocks = np.random.default_rng(0).normal(size=(20, 3))
    value, error = jackknife(mean, 7 * blocks, np.full(20, 7))
    np.testing.assert_allclose(value, blocks.mean(axis=0))
    np.testing.assert_allclose(error, blocks.std(axis=0, ddof=1) / np.sqrt(20))


def test_unequal_blocks_are_weighted_and_empty_ones_ignored():
    """Blocks of n samples of variance 1 give the mean of all with an error 1/sqrt(N)."""
    generator = np.random.default_rng(1)
    counts = generator.integers(5, 15, size=4000)
    sums = np.array([generator.normal(size=n).sum() for n in counts])
    value, error = jackknife(mean, sums, counts)
    assert value == pytest.approx(sums.sum() / counts.sum())
    assert error * np.sqrt(counts.sum()) == pytest.approx(1, abs=0.05)
    padded = jackknife(mean, np.append(sums, 0.0), np.append(counts, 0))
    np.testing.assert_allclose(padded, (value, error))


def test_every_time_has_blocks_of_its_own():
    generator = np.random.default_rng(2)
    sums, counts = generator.normal(size=(6, 4, 2, 5)), generator.integers(1, 4, size=(6, 4))

    def difference(average):
        return average[..., 0, :] - average[..., 1, :]

    counts[3:, 2] = 0
    value, error = jackknife(difference, sums * counts[..., None, None], counts)
    assert value.shape == error.shape == (4, 5)
    for time in range(4):
        alone = jackknife(difference, sums[:, time] * counts[:, time, None, None], counts[:, time])
        np.testing.assert_allclose((value[time], error[time]), alone)


def test_one_block_tells_nothing_of_the_error():
    value, error = jackknife(mean, np.array([[2.0, 4.0]]), np.array([2]))
    np.testing.assert_array_equal(value, [1, 2])
    assert np.isinf(error).all()


@pytest.mark.compiled
def test_blocks_are_added_up_in_pairs_and_stay_longer_than_the_memory():
    """The error of a mean is right, from 33 to 64 blocks, as that of a known process."""
    chain = Chain(size=1, damping=2)
    for duration in (2000, 40_000):
        run = a_run(chain, duration=duration, replicas=2, observe="density")
        assert 32 <= 2 * run.blocks <= 64
    # The mean of a displacement over a time t has the variance 2 tau <d^2>/t, tau = gamma/k.
    tau = chain.damping / chain.stiffness
    how = {"duration": 5000, "observe": "widths", "progress": False}
    runs = [simulate(chain, seed=seed, **how) for seed in range(40)]
    found = np.mean([run.mean_displacement_error.item() ** 2 for run in runs])
    known = 2 * tau * chain.temperature / chain.stiffness / 5000
    assert found == pytest.approx(known, rel=5 * np.sqrt(2 / 40 / 32))
    assert np.mean([run.autocorrelation_time.item() for run in runs]) == pytest.approx(tau, rel=0.2)
