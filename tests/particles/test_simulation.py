"""simulate(): against the exact equilibrium, reproducible, interruptible, strict."""

import tracemalloc

import numpy as np
import pytest
import xarray as xr

from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.dynamics import longest_step

QUANTITIES = ("velocity_width", "mean_displacement", "displacement_width")


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("size", "gap", "spring"),
    [
        (1, 0.2, "quadratic"),
        (20, 0.0, "linear"),
        (20, 0.0, "quadratic"),
        (20, 0.2, "linear"),
        (20, 1.0, "quadratic"),
    ],
)
def test_elastic_chain_is_in_its_exact_equilibrium(size, gap, spring):
    """Every particle's widths and displacement within 5 standard errors, t-distributed."""
    chain = Chain(size=size, gap=gap, spring=spring)
    run = simulate(chain, duration=10_000, replicas=2, seed=7, observe="widths", progress=False)
    exact = equilibrium(chain)
    for name in QUANTITIES:
        error = run[f"{name}_error"]
        assert (error < 0.02 * chain.thermal_length).all()
        assert float(np.abs((run[name] - exact[name]) / error).max()) < 5, name


@pytest.mark.compiled
@pytest.mark.parametrize(("e", "average"), [(0.9, "time"), (1, "ensemble")])
def test_the_same_seed_gives_the_same_bits_whatever_the_threads(e, average):
    chain = Chain(size=10, restitution=e)
    options = {"duration": 100, "replicas": 5, "average": average, "progress": False}
    options["observe"] = ("widths", "density", "energy", "snapshots")
    one, *others = (simulate(chain, threads=threads, seed=5, **options) for threads in (1, 2, 3))
    for run in others:
        xr.testing.assert_identical(run, one)
    other = simulate(chain, seed=6, **options)
    assert (other.velocity_width != one.velocity_width).any()


@pytest.mark.filterwarnings("ignore:.*Without a steady state")
@pytest.mark.parametrize("stepper", ["splitting", "euler"])
@pytest.mark.parametrize(("damping", "stiffness"), [(0, 1), (9, 0.5), (3, 0)])
def test_a_step_is_refused_just_where_it_gets_unstable(stepper, damping, stiffness):
    """One free rod: the growth of its swing in a step is the largest eigenvalue of the step."""
    chain = Chain(size=1, damping=damping, stiffness=stiffness, amplitude=0, radius=0.3, mass=2)
    g, rate2 = damping / chain.mass, stiffness / chain.mass

    def growth(dt):
        flight = np.array([[1, dt], [0, 1]])
        if stepper == "euler":
            step = flight @ np.array([[1, 0], [-rate2 * dt, 1 - g * dt]])
        else:
            half = np.array([[1, 0], [-rate2 * dt / 2, 1]])
            step = np.diag([1, np.exp(-g * dt)]) @ half @ flight @ half
        values = abs(np.linalg.eigvals(step))
        return values.max() if stiffness else abs(step[1, 1])

    pair = chain.replace(size=2, restitution=0.5)  # one rod alone is flown exactly
    limit = longest_step(chain, stepper)
    if limit < np.inf:
        assert growth(1.01 * limit) > 1
        with pytest.raises(ValueError, match="time_step must be below"):
            simulate(pair, time_step=1.01 * limit, stepper=stepper)
    assert growth(0.99 * min(limit, 1e3)) < 1 + 1e-12
    # The left rod's tiny velocity makes this a start that moves.
    start = given_start(pair, pair.anchors, [-1e-9, 0.0])
    longest = {"time_step": 0.99 * min(limit, 10.0), "stepper": stepper}
    simulate(pair, duration=2e3, start=start, **longest)


@pytest.mark.filterwarnings("ignore:.*Without a steady state")
@pytest.mark.parametrize(
    ("average", "observe"),
    [
        ("time", ("widths", "energy")),
        ("time", ("collisions",)),  # which are not averaged over an ensemble
        ("ensemble", ("widths", "energy")),
    ],
)
def test_long_times_between_snapshots_are_taken_in_parts(average, observe, monkeypatch):
    """Without noise, which would be drawn at other moments, nothing else shows."""
    chain = Chain(size=4, amplitude=0, restitution=0.9)
    position = [-9.0, -3.1, 5.0, 7.1]
    options = {"duration": 8.0, "every": 0.1, "time_step": 1e-3, "average": average}
    options |= {"observe": observe, "start": given_start(chain, position), "progress": False}
    whole = simulate(chain, **options)
    assert np.ptp(whole[next(iter(whole.data_vars))].values) > 0
    monkeypatch.setattr("crazybilliards.particles.running.replica._CHUNK", 30 * chain.size)
    xr.testing.assert_allclose(simulate(chain, **options), whole, rtol=1e-9, atol=1e-9)


@pytest.mark.compiled
def test_memory_does_not_grow_with_the_duration():
    chain, often = Chain(size=20), {"every": 0.1, "time_step": 0.1, "progress": False}
    peaks = []
    for duration in (100, 100, 2_000):  # the first one loads what stays loaded
        tracemalloc.start()
        simulate(chain, duration=duration, **often)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    # A full buffer of snapshots is 2 MB; storing the longer run would take 6 MB.
    assert peaks[2] < peaks[1] + 3e6


@pytest.mark.compiled
@pytest.mark.parametrize("average", ["time", "ensemble"])
def test_a_short_run_may_have_short_steps(average):
    """A hundred steps of 1e-9 t_0 cost nothing, and show how noise begins."""
    chain = Chain(size=3)
    arguments = {"duration": 1e-7, "every": 1e-9, "warmup": 0.0, "observe": "energy"}
    run = simulate(chain, average=average, replicas=32, **arguments, progress=False)
    heating = chain.size * chain.amplitude**2 / (2 * chain.mass)
    last = float(run.kinetic_energy[-1])
    error = float(run.kinetic_energy_error[-1]) if average == "ensemble" else 0.2 * last
    assert abs(last - heating * float(run.time[-1])) < 5 * error
