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


REPLICAS = 200


@pytest.fixture(scope="module")
def compressed():
    """Release an elastic chain from 0.3 of its thermal width with thermal velocities."""
    chain = Chain(size=30)
    start = equilibrium_states(chain, REPLICAS, seed=1)
    position = 0.3 * chain.reduced(start.position.values)
    start = start.assign(position=(("replica", "particle"), chain.physical(position)))
    how = {"replicas": REPLICAS, "average": "ensemble", "duration": 20, "every": 0.5}
    observe = ("widths", "density", "energy")
    return chain, start, simulate(chain, start=start, observe=observe, progress=False, **how)


@pytest.mark.compiled
def test_elastic_relaxation_is_that_of_independent_oscillators(compressed):
    chain, start, run = compressed
    np.testing.assert_allclose(run.time, np.arange(41) / 2)
    displacement = (start.position - chain.anchors).mean("replica")
    np.testing.assert_allclose(run.mean_displacement[0], displacement, atol=1e-12)
    W = chain.free_velocity_width
    first = np.array([(0.3 * chain.thermal_length) ** 2, 0, W**2])
    exact = oscillator_covariance(chain, first, run.time.values)
    square = (run.mean_displacement**2 + run.displacement_width**2).mean("particle")
    spread = np.sqrt(2 / chain.size / REPLICAS)  # of a mean of independent squares of a Gaussian
    np.testing.assert_allclose(square, exact[:, 0], rtol=5 * spread)
    energy = chain.size * chain.mass / 2 * exact[:, 2]
    assert float(np.abs((run.kinetic_energy - energy) / run.kinetic_energy_error).max()) < 5
    np.testing.assert_allclose(
        chain.mass / 2 * (run.velocity_width**2).sum("particle"), run.kinetic_energy
    )
    # The cloud contracts and expands: the flow at the border is far from thermal.
    assert run.mean_velocity[:, -1].max() > 10 * run.mean_velocity_error[:, -1].mean()


@pytest.mark.compiled
def test_the_density_in_time_holds_every_rod_and_can_be_smoothed(compressed):
    chain, _, run = compressed
    spacing = float(run.x[1] - run.x[0])
    np.testing.assert_allclose(run.density.sum("x") * spacing, chain.size)
    smoothed = smooth(run)
    of_groups = smoothed.density_block.mean("block")  # of 6 and of 7 replicas
    np.testing.assert_allclose(of_groups, smoothed.density, atol=0.01)
    assert float(smoothed.density.max()) < 1.001 * chain.close_packed_density


@pytest.mark.compiled
def test_error_bars_are_those_of_independent_replicas(compressed):
    """Of d of the middle particle, from 32 groups: right to 13 %."""
    _, _, run = compressed
    middle = run.isel(particle=15, time=slice(5, None, 4))
    expected = middle.displacement_width / np.sqrt(REPLICAS)
    np.testing.assert_allclose(middle.mean_displacement_error / expected, 1, atol=0.6)


def test_the_end_of_a_run_is_a_start_of_another():
    how = {"replicas": 5, "average": "ensemble", "duration": 3, "every": 1, "progress": False}
    chain, how["observe"] = Chain(size=7, restitution=0.5), ("widths", "snapshots")
    run = simulate(chain, **how)
    moved = (run.position - chain.anchors).mean("replica")
    np.testing.assert_allclose(moved, run.mean_displacement)
    assert run.position.sizes == {"replica": 5, "time": 4, "particle": 7}
    again = simulate(chain, start=run.isel(time=-1), **how)
    np.testing.assert_allclose(again.position[:, 0], run.position[:, -1], atol=1e-12)


def test_only_chosen_particles_are_reported():
    chain = Chain(size=20)
    arguments = {"duration": 100, "progress": False}
    for observe in (("widths", "velocities", "collisions", "covariances"), "snapshots"):
        arguments["observe"] = observe
        some, whole = simulate(chain, particles=(1, 15), **arguments), simulate(chain, **arguments)
        chosen = {name: [1, 15] for name in {"particle", "contact"} & set(whole.dims)}
        xr.testing.assert_identical(
            some.drop_attrs(deep=False), whole.sel(chosen).drop_attrs(deep=False)
        )
