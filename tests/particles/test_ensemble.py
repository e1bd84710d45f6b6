"""Ensembles: averages over replicas at equal times, against exact evolutions; raw snapshots."""

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import expm

from crazybilliards.comparison import smooth
from crazybilliards.kinetic import equilibrium_states
from crazybilliards.model import Chain
from crazybilliards.particles import simulate


def oscillator_covariance(chain, covariance, times):
    """<d^2>, <dv>, <v^2> of one damped noisy oscillator; exact."""
    m, gamma, k = chain.mass, chain.damping, chain.stiffness
    drift = np.array([[0, 2, 0], [-k / m, -gamma / m, 1], [0, -2 * k / m, -2 * gamma / m]])
    heat = np.array([0, 0, (chain.amplitude / m) ** 2])
    rest = np.linalg.solve(drift, -heat)
    return np.array([expm(drift * t) @ (covariance - rest) + rest for t in times])


@pytest.fixture(scope="module")
def compressed():
    """Release an elastic chain from 0.3 of its thermal width with thermal velocities."""
    chain = Chain(size=50)
    start = equilibrium_states(chain, 300, seed=1)
    position = 0.3 * chain.reduced(start.position.values)
    start = start.assign(position=(("replica", "particle"), chain.physical(position)))
    how = {"replicas": 300, "average": "ensemble", "duration": 20, "every": 0.25}
    observe = ("widths", "density", "energy")
    return chain, start, simulate(chain, start=start, observe=observe, progress=False, **how)


@pytest.mark.compiled
def test_elastic_relaxation_is_that_of_independent_oscillators(compressed):
    chain, _, run = compressed
    W = chain.free_velocity_width
    first = np.array([(0.3 * chain.thermal_length) ** 2, 0, W**2])
    exact = oscillator_covariance(chain, first, run.time.values)
    square = (run.mean_displacement**2 + run.displacement_width**2).mean("particle")
    # A mean of 50 x 300 independent squares of a Gaussian.
    np.testing.assert_allclose(square, exact[:, 0], rtol=5 * np.sqrt(2 / 15_000))
    energy = chain.size * chain.mass / 2 * exact[:, 2]
    assert float(np.abs((run.kinetic_energy - energy) / run.kinetic_energy_error).max()) < 5
    np.testing.assert_allclose(
        chain.mass / 2 * (run.velocity_width**2).sum("particle"), run.kinetic_energy
    )
    # The cloud contracts and expands: the flow at the border is far from thermal.
    assert run.mean_velocity[:, -1].max() > 20 * run.mean_velocity_error[:, -1].mean()


@pytest.mark.compiled
def test_the_first_time_is_the_start_and_the_times_are_those_asked_for(compressed):
    chain, start, run = compressed
    np.testing.assert_allclose(run.time, np.arange(81) / 4)
    displacement = (start.position - chain.anchors).mean("replica")
    np.testing.assert_allclose(run.mean_displacement[0], displacement, atol=1e-12)
    assert run.attrs["end_time"] == 20
    assert run.attrs["status"] == "completed"


@pytest.mark.compiled
def test_the_density_in_time_holds_every_rod_and_can_be_smoothed(compressed):
    chain, _, run = compressed
    spacing = float(run.x[1] - run.x[0])
    np.testing.assert_allclose(run.density.sum("x") * spacing, chain.size)
    smoothed = smooth(run)
    assert smoothed.density_error.dims == ("time", "x")
    np.testing.assert_allclose(
        smoothed.density_block.mean("block"), smoothed.density, atol=0.01
    )  # groups of 9 and of 10 replicas
    assert float(smoothed.density.max()) < 1.001 * chain.close_packed_density


@pytest.mark.compiled
def test_error_bars_are_those_of_independent_replicas(compressed):
    """Of d of the middle particle, from 32 groups: right to 13 %."""
    _, _, run = compressed
    middle = run.isel(particle=25, time=slice(10, None, 5))
    expected = middle.displacement_width / np.sqrt(300)
    np.testing.assert_allclose(middle.mean_displacement_error / expected, 1, atol=0.6)


SMALL = {"replicas": 5, "average": "ensemble", "duration": 3, "every": 1, "progress": False}


@pytest.mark.parametrize("e", [1.0, 0.5])
def test_replicas_are_the_same_whatever_the_threads_and_however_cut(e, tmp_path):
    chain = Chain(size=7, restitution=e)
    observe = ("widths", "density", "energy", "snapshots")
    whole = simulate(chain, observe=observe, threads=1, **SMALL)
    threaded = simulate(chain, observe=observe, threads=3, **SMALL)
    xr.testing.assert_identical(whole, threaded)
    positions = whole.position
    np.testing.assert_allclose((positions - chain.anchors).mean("replica"), whole.mean_displacement)
    assert positions.sizes == {"replica": 5, "time": 4, "particle": 7}
    # The end of one is a start of another.
    again = simulate(chain, start=whole.isel(time=-1), observe=observe, **SMALL)
    np.testing.assert_allclose(again.position[:, 0], positions[:, -1], atol=1e-12)


def test_snapshots_in_a_steady_state_are_what_the_averages_are_of():
    chain = Chain(size=6, gap=0.5)
    run = simulate(chain, duration=100, every=0.5, observe=("widths", "snapshots"), progress=False)
    displacement = (run.position - chain.anchors).mean(("replica", "time"))
    np.testing.assert_allclose(displacement, run.mean_displacement)
    np.testing.assert_allclose(np.diff(run.time), 0.5)
    assert run.sizes["time"] == 200  # of 10 blocks, which are fewer than in a long run


def test_only_chosen_particles_are_reported():
    chain = Chain(size=30)
    arguments = {"duration": 100, "progress": False}
    for observe in (("widths", "velocities", "collisions"), ("widths", "snapshots")):
        arguments["observe"] = observe
        some, whole = simulate(chain, particles=(1, 15), **arguments), simulate(chain, **arguments)
        xr.testing.assert_identical(
            some.drop_attrs(deep=False), whole.sel(particle=[1, 15]).drop_attrs(deep=False)
        )
