"""Correlations in time, against an oscillator, which the centre of mass is, and raw snapshots."""

import numpy as np
import pytest
from described_runs import a_run
from scipy.fft import dct

import crazybilliards as cb
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import TimeCorrelations
from crazybilliards.particles.observers.base import Snapshots

CRITICAL = 2 * np.sqrt(4 * np.pi / 3)
QUANTITIES = ("velocity_autocorrelation", "displacement_autocorrelation")
QUANTITIES += ("mean_squared_displacement", "velocity_spectrum")


def oscillator(chain, t):
    """Autocorrelations of displacement and velocity of a free rod, k c(t)/T and m c_v(t)/T."""
    half = chain.damping / (2 * chain.mass)
    swing = np.sqrt(complex(chain.stiffness / chain.mass - half**2))
    sine = np.sin(swing * t) / swing if abs(swing) > 1e-6 else t
    decay, cosine = np.exp(-half * t), np.cos(swing * t)
    return (decay * (cosine + half * sine)).real, (decay * (cosine - half * sine)).real


@pytest.mark.filterwarnings("ignore:.*spectra are NaN")
def test_the_error_of_a_lag_that_one_block_holds_alone_is_infinite():
    run = simulate(Chain(size=6), duration=50, observe="time-correlations", progress=False)
    for name in ("velocity_autocorrelation", "mean_squared_displacement"):
        error = run[f"{name}_error"].values
        assert not np.isnan(error).any()
        assert np.isinf(error[:, -1]).all()
        assert np.isfinite(error[:, 0]).all()


@pytest.mark.compiled
@pytest.mark.parametrize(("damping", "e"), [(1.0, 1.0), (CRITICAL, 0.5), (10.0, 0.5)])
def test_the_centre_of_mass_is_a_damped_oscillator_at_any_restitution(damping, e):
    chain = Chain(size=5, restitution=e, damping=damping)
    how = {"duration": 10_000, "seed": 3, "progress": False}
    longest = 5 * cb.relaxation_time(chain)
    how["every"] = longest / 100
    run = simulate(chain, observe=TimeCorrelations(longest=longest), **how)
    displacement, velocity = oscillator(chain, run.lag.values)
    displacement *= chain.temperature / chain.stiffness / chain.size
    velocity *= chain.temperature / chain.mass / chain.size
    spectrum = run.lag.values[1] * dct(velocity, type=1)
    moved = 2 * (displacement[0] - displacement)
    for name, expected in zip(QUANTITIES, (velocity, displacement, moved, spectrum), strict=True):
        pulls = (run[f"centre_{name}"] - expected) / run[f"centre_{name}_error"]
        assert np.nanmax(abs(pulls)) < 5
    assert (run.centre_velocity_autocorrelation_error[0] < 0.04 * velocity[0]).all()
    np.testing.assert_allclose(run.frequency, np.pi * np.arange(101) / float(run.lag[-1]))


@pytest.mark.parametrize("relaxations", [0.5, 4.9])
def test_a_spectrum_of_short_lags_is_not_given(relaxations):
    chain = Chain(size=1)
    memory = cb.relaxation_time(chain)
    how = {"duration": 20 * memory, "progress": False}
    with pytest.warns(UserWarning, match=rf"spectra .* longest lag .* {5 * memory:.4g}; longest="):
        run = simulate(chain, observe=TimeCorrelations(longest=relaxations * memory), **how)
    for of in ("", "wave_", "centre_"):
        assert run[f"{of}velocity_spectrum"].isnull().all()
        assert run[f"{of}velocity_autocorrelation"].notnull().all()


@pytest.mark.compiled
@pytest.mark.validate
def test_stated_errors_are_the_scatter_in_runs_of_twenty_longest_lags():
    """The blocks that the schedule makes there are shorter than the longest lag."""
    chain = Chain(size=10, gap=1000.0)  # rods that never meet: runs of one each
    how = {"duration": 1000, "every": 0.5, "progress": False}
    how["observe"] = TimeCorrelations(longest=5 * cb.relaxation_time(chain), lags=100, waves=1)
    runs = [simulate(chain, seed=seed, **how) for seed in range(10)]
    for name in QUANTITIES:
        values, errors = (
            np.concatenate([run[each].values for run in runs]) for each in (name, f"{name}_error")
        )
        used = errors.max(axis=0) > 0  # the first mean squared displacement is 0
        stated = np.sqrt(np.mean(errors**2, axis=0))[used]
        assert 0.75 < np.median(values.std(axis=0, ddof=1)[used] / stated) < 1.25


@pytest.mark.compiled
def test_in_an_ensemble_pairs_are_those_of_the_first_snapshot_and_each():
    chain, observe = Chain(size=4, restitution=0.5), ["time-correlations", "snapshots"]
    how = {"duration": 6, "every": 2.0, "replicas": 40, "average": "ensemble", "progress": False}
    run = simulate(chain, observe=observe, **how)
    rods = run.position.values - chain.anchors, run.velocity.values
    waves = [dct(each, norm="ortho") for each in rods]
    for of, (d, v) in {"": rods, "wave_": waves, "centre_": [w[..., 0] / 2 for w in waves]}.items():
        first = d[:, :1]
        kept = (first * d).mean(axis=0) - first.mean(axis=0) * d.mean(axis=0)
        expected = (v[:, :1] * v).mean(axis=0), kept, ((d - first) ** 2).mean(axis=0)
        for name, values in zip(QUANTITIES, expected, strict=False):
            np.testing.assert_allclose(run[of + name], values, atol=1e-12)


@pytest.mark.filterwarnings("ignore:.*spectra are NaN")
def test_pairs_are_those_of_all_snapshots_however_they_come():
    """Against sums over all pairs, with every third snapshot used and parts of any length."""
    observer = TimeCorrelations(longest=30, lags=10, waves=3)
    chain = Chain(size=4)
    run = a_run(chain, duration=200, every=1.0, particles=[2, 4], observe=observer)
    [own] = (each.prepared(run, 1) for each in run.observers)
    generator = np.random.default_rng(1)
    snapshots, length = run.snapshots, run.block
    y, v = generator.normal(size=(2, snapshots, 4))
    first, counts = 0, np.bincount(np.arange(snapshots) // length, minlength=run.blocks)
    while first < snapshots:
        block = first // length
        part = slice(first, min(first + generator.integers(1, 4), (block + 1) * length))
        own.observe(Snapshots(block, first, 0, y[part], v[part], np.zeros(3, dtype=np.int64)))
        first = part.stop
    report = own.report(counts)
    lag = own.coordinates()["lag"]
    np.testing.assert_allclose(lag, 3 * np.arange(11))
    d, w = y[::3], v[::3]
    for place in range(11):
        early, late = slice(len(d) - place), slice(place, None)
        product = (w[early] * w[late]).mean(axis=0)[[1, 3]]
        moved = ((d[late] - d[early]) ** 2).mean(axis=0)[[1, 3]]
        np.testing.assert_allclose(report["velocity_autocorrelation"][1][:, place], product)
        np.testing.assert_allclose(report["mean_squared_displacement"][1][:, place], moved)
        kept = d.var(axis=0)[[1, 3]] - moved / 2
        np.testing.assert_allclose(report["displacement_autocorrelation"][1][:, place], kept)
    centre = y[::3].mean(axis=1)
    moved = np.mean((centre[7:] - centre[:-7]) ** 2)
    assert report["centre_mean_squared_displacement"][1][7] == pytest.approx(moved)
    assert report["wave_velocity_autocorrelation"][1].shape == (3, 11)


FINE = {"every": 0.1, "duration": 60, "replicas": 10}
ASKED = [
    ({"longest": 42}, FINE | {"every": 0.05}, 0.05, 42),
    ({"longest": 42, "lags": 100}, FINE, 0.5, 42),
    ({}, FINE, 0.1, 30),  # at most 300
    ({"longest": 2.55}, FINE, 0.1, 2.5),
    ({"longest": 39.7, "lags": 4}, FINE, 9.9, 39.6),
    ({"longest": 0.7, "lags": 4}, FINE, 0.2, 0.6),
]


@pytest.mark.filterwarnings("ignore:.*relaxation time")
@pytest.mark.parametrize(("parameters", "how", "first", "last"), ASKED)
def test_the_first_lag_is_the_time_between_snapshots_and_the_last_the_longest(
    parameters, how, first, last
):
    run = a_run(Chain(size=3), observe=TimeCorrelations(**parameters), **how)
    [own] = (each.prepared(run, 1) for each in run.observers)
    lag = own.coordinates()["lag"]
    assert lag[1] == pytest.approx(first)
    assert lag[-1] == pytest.approx(last)


DECAYS = [
    Chain(size=1),
    Chain(size=1, damping=50.0),
    Chain(size=30),
    Chain(size=30, restitution=0.3),
    Chain(size=10, spring="quadratic", damping=10.0),
    Chain(size=30, damping=0.1, amplitude=3.0, gap=3.0),
]


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore:.*relaxation time")
@pytest.mark.parametrize("chain", DECAYS)
@pytest.mark.parametrize("parameters", [{}, {"longest": 2.0}])
def test_the_lags_of_nobody_s_choice_resolve_the_first_decay(chain, parameters):
    how = {"duration": 200, "particles": [(chain.size + 1) // 2], "progress": False}
    run = simulate(chain, observe=TimeCorrelations(**parameters), **how)
    [speeds] = run.velocity_autocorrelation.values
    assert (speeds[1:3] > [0.5 * speeds[0], 0.2 * speeds[0]]).all()


def test_a_finer_time_between_snapshots_leaves_the_time_step_as_it_was():
    chain = Chain(size=5, restitution=0.8)
    widths, both = a_run(chain), a_run(chain, observe=["widths", "time-correlations"])
    assert both.time_step == widths.time_step
    assert both.stride < widths.stride
    given = a_run(chain, observe="time-correlations", time_step=0.05)
    assert given.time_step == 0.05


@pytest.mark.filterwarnings("ignore:.*spectra are NaN")
def test_lags_that_a_run_cannot_have_are_refused():
    with pytest.raises(ValueError, match="duration above the longest lag inf"):
        simulate(Chain(damping=0), observe="time-correlations", progress=False)
    chain, how = Chain(size=3), {"duration": 400, "every": 1.0, "progress": False}
    with pytest.raises(ValueError, match="duration above the longest lag 400, got 400"):
        simulate(chain, observe=TimeCorrelations(longest=400, lags=100), **how)
    run = simulate(chain, observe=TimeCorrelations(longest=396, lags=99), **how)
    assert np.isfinite(run.velocity_spectrum).all()
