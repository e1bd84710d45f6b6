"""What somebody relies on who cannot check: error bars, step errors, new noise, all rods."""

import warnings

import numpy as np
import pytest

from crazybilliards.comparison import coverage_density, deviation, overlay, smooth
from crazybilliards.kinetic import equilibrium, equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import ShortRunWarning, given_start, relaxation_time, simulate
from crazybilliards.particles.observers import Density, TimeCorrelations

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
        (FIVE.replace(restitution=0.05), {}, True),
        (DISSIPATIVE, {"observe": "energy"}, True),
        (WIDE, {}, True),
        (FIVE.replace(spring="quadratic"), {}, True),
        (FIVE, {"stepper": "euler"}, True),
        (FIVE.replace(restitution=0.0), {"method": "contact-dynamics"}, True),
        (DISSIPATIVE.replace(amplitude=0), {"start": "pushed"}, False),
        (DISSIPATIVE.replace(damping=0), {"observe": "energy"}, False),
        (WIDE.replace(damping=0), {}, False),
        (WIDE, {"stepper": "euler"}, False),
        (FIVE, {"method": "contact-dynamics"}, False),
        (DISSIPATIVE, {"method": "contact-dynamics"}, False),
    ],
)
def test_the_error_of_the_step_is_never_zero_where_there_is_one(chain, settings, known):
    if "start" in settings:
        pushed = given_start(chain, chain.anchors, np.arange(5.0), replicas=8)
        settings = settings | {"start": pushed}
    error = ensemble(chain, **settings).attrs["time_step_error"]
    # Estimated from eight replicas it can be larger than 1.
    assert 0 < error < np.inf if known else np.isnan(error)


@pytest.mark.compiled
def test_the_error_of_eulers_step_is_that_of_a_free_rod():
    chain = Chain(size=3, damping=4.0)
    run = simulate(chain, duration=40_000, time_step=0.2, stepper="euler", seed=1, **QUIET)
    ratio = np.sqrt(np.mean(run.velocity_width**2)) / chain.free_velocity_width - 1
    error = float(run.velocity_width_error.mean()) / chain.free_velocity_width / 3**0.5
    heat = 1 - chain.damping * 0.2 / (2 * chain.mass) - chain.stiffness * 0.2**2 / (4 * chain.mass)
    assert run.attrs["time_step_error"] == pytest.approx(heat**-0.5 - 1)
    assert abs(float(ratio) - run.attrs["time_step_error"]) < 5 * error


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("damping", [0.1, 1.0, 10.0])
@pytest.mark.parametrize("relaxations", [20, 60, 300])
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


def test_a_run_states_the_memory_of_its_chain():
    chain = Chain(size=3, damping=0.2)
    assert ensemble(chain).attrs["relaxation_time"] == relaxation_time(chain)
    assert relaxation_time(chain) == pytest.approx(2 * chain.mass / chain.damping)


SHORT = [
    (Chain(size=3), {"duration": 100}, "duration=100 .* at least 167.6, or 10 replicas"),
    (Chain(size=3, damping=0.01), {"duration": 5000}, "duration=5000 .* at least 1.676e"),
    (Chain(size=3), {"warmup": 1}, "warmup=1 .* at least 41.89"),
    (Chain(size=3), {"start": "shifted"}, "warmup=0 .* at least 41.89"),
    (Chain(size=3, damping=0), {"time_step": 0.1}, "damping=0: .* never forgets .* mean nothing"),
    (Chain(size=3, stiffness=0), {}, "stiffness=0: .* spread .* mean nothing"),
    (Chain(size=1, stiffness=0), {"duration": 5000}, "stiffness=0: .* spread .* mean nothing"),
    (Chain(size=3, spring="quadratic", stiffness=0, restitution=0.5), {}, "stiffness=0"),
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


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"duration": 20, "replicas": 10},
        {"duration": 100, "observe": "snapshots"},
        {"duration": 5, "average": "ensemble", "replicas": 2},
    ],
)
def test_what_is_long_enough_says_nothing(settings):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(Chain(size=3), **({"duration": 200, "observe": "widths"} | settings), **QUIET)


def test_a_chain_without_noise_has_nothing_to_forget():
    free = Chain(size=3, amplitude=0, damping=0)
    start = given_start(free, free.anchors, [1.0, 0.0, -1.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(free, duration=np.pi, every=0.1, observe="collisions", start=start, **QUIET)


@pytest.mark.parametrize("e", [1.0, 0.9])
def test_a_run_that_continues_another_one_has_new_noise(e):
    chain = Chain(size=4, restitution=e)
    times = {"duration": 400.0, "every": 1.0, "average": "ensemble", "observe": "snapshots"}
    centres, start = [], None
    for _ in range(3):
        run = simulate(chain, start=start, **times, **QUIET)
        start = run.isel(time=-1)
        centres.append(run.velocity.values[0, 50:].mean(axis=1))
    for one, other in ((0, 1), (1, 2), (0, 2)):
        assert abs(np.corrcoef(centres[one], centres[other])[0, 1]) < 5 / 100**0.5
    again = simulate(chain, start=start, **times, **QUIET)
    np.testing.assert_array_equal(
        again.velocity, simulate(chain, start=start, **times, **QUIET).velocity
    )


def rods(density):
    return float((density.sum("x") * (density.x[1] - density.x[0])).min())


@pytest.mark.parametrize(
    ("chain", "spread", "speed"),
    [
        (Chain(size=40, stiffness=0, damping=0, amplitude=0), 300.0, 3.0),
        (Chain(size=40, stiffness=0, damping=0), 30.0, 1.0),
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
    settings = {"duration": 20.0, "every": 0.5, "time_step": 0.05, "replicas": 4}
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


@pytest.mark.parametrize("particles", [[1], [1, 2], [3], None])
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
    one_rod = states.isel(particle=[2])
    with pytest.raises(ValueError, match="hold 1 and 6 rods"):
        deviation(smooth(one_rod), twice)
    with (
        pytest.warns(UserWarning, match="different chains: size 9 and 6"),
        pytest.raises(ValueError, match="hold 9 and 6 rods"),
    ):
        deviation(smooth(equilibrium(Chain(size=9))), twice)
    with pytest.warns(
        UserWarning, match="different chains: amplitude 2.0 and 1.0, gap 0.5 and 0.0"
    ):
        deviation(smooth(equilibrium(Chain(size=6, gap=0.5, amplitude=2.0))), twice)


@pytest.mark.compiled
@pytest.mark.validate
def test_the_largest_deviation_in_errors_is_as_documented():
    """Of 40 runs that agree with the exact density; rarely visited bins are left out."""
    for chain in (Chain(size=100), Chain(size=20, amplitude=5.0, gap=1.0)):
        exact = smooth(equilibrium(chain))
        largest = [
            deviation(smooth(simulate(chain, seed=s, observe="density", **QUIET)), exact)
            for s in range(40)
        ]
        pulls = np.array([each.maximum_in_errors for each in largest])
        assert 2.7 < np.median(pulls) < 3.8
        assert (pulls > 4.5).mean() <= 0.125
        assert pulls.max() < 6
