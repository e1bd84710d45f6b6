"""Observers of a chain with walls and two masses, and which gases have a steady state."""

import numpy as np
import pytest
from scipy.fft import dct

from crazybilliards.comparison import smooth
from crazybilliards.comparison.distances import width_deviation
from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.model.grid import position_grid
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import TimeCorrelations

CHAIN = Chain(size=6, box=15, gap=0.2, restitution=0.9, wall_restitution=0.7, mass_ratio=3)
LAGS = TimeCorrelations(longest=130.0, waves=6)


@pytest.fixture(scope="module")
def run():
    observe = ("snapshots", "modes", "covariances", "widths", "density", "velocities", LAGS)
    return simulate(
        CHAIN, duration=400, warmup=60, every=0.5, observe=observe, seed=4, progress=False
    )


def test_averages_are_those_of_the_snapshots(run):
    x, v = run.position.values[0], run.velocity.values[0]
    gaps = np.diff(x) - 2
    np.testing.assert_allclose(run.velocity_width, np.sqrt((v**2).mean(axis=0)))
    np.testing.assert_allclose(run.relative_temperature, (np.diff(v) ** 2).mean(axis=0) / 2)
    np.testing.assert_allclose(run.mean_gap, gaps.mean(axis=0))
    assert (gaps > -1e-12).all()
    assert np.abs(x).max() <= 6.5
    kurtosis = ((v - v.mean(axis=0)) ** 4).mean(axis=0) / v.var(axis=0) ** 2 - 3
    np.testing.assert_allclose(run.velocity_kurtosis, kurtosis)


def test_waves_are_those_of_the_momentum(run):
    x, v = run.position.values[0], run.velocity.values[0]
    of_mean = CHAIN.rod_masses / CHAIN.rod_masses.mean()
    waves = dct(of_mean * v, axis=1, norm="ortho")
    np.testing.assert_allclose(run.mode_velocity_variance, (waves**2).mean(axis=0))
    own = run.wave_velocity_autocorrelation.isel(lag=2)
    np.testing.assert_allclose(own, (waves[2:] * waves[:-2]).mean(axis=0))
    centre = x @ CHAIN.rod_masses / CHAIN.rod_masses.sum()
    moved = ((centre[2:] - centre[:-2]) ** 2).mean()
    np.testing.assert_allclose(run.centre_mean_squared_displacement.isel(lag=2), moved)


def test_the_density_has_all_rods_and_its_grid_ends_at_the_walls(run):
    assert run.outside == 0
    density = smooth(run)
    assert float(density.density.sum()) * float(run.x[1] - run.x[0]) == pytest.approx(6)
    beyond = np.abs(run.x) > CHAIN.box / 2 - CHAIN.radius + 0.1
    assert (run.density[beyond] == 0).all()
    assert float(run.x[-1]) == pytest.approx(CHAIN.box / 2 + 4, abs=0.1)


def test_walls_that_no_rod_reaches_leave_the_grid_as_it_is():
    chain = Chain(size=6)
    np.testing.assert_array_equal(position_grid(chain.replace(box=1e8)), position_grid(chain))


def test_an_even_number_of_two_sorts_is_not_averaged_with_its_mirror_image():
    """Their widths differ by sqrt(3), and the first rod has another mass than the last."""
    chain = Chain(size=6, mass_ratio=3)
    run, theory = simulate(chain, duration=3000, progress=False), equilibrium(chain)
    found = width_deviation(run, theory)
    assert found.largest < 0.1
    assert found.largest_in_errors < 5


# -- steady states -------------------------------------------------------------------------------

# gamma l/(L sqrt(m T)) is 0.1.
GAS = Chain(
    size=50, box=150, stiffness=0, mass=1, damping=0.1, amplitude=np.sqrt(0.2), restitution=1.02
)


@pytest.mark.parametrize(
    ("changed", "critical"),
    [
        ({}, ""),
        ({"restitution": 1.04}, "e_c = 1.034"),
        ({"restitution": 1.04, "stiffness": 1}, ""),  # springs hold them apart
        ({"restitution": 1.04, "size": 1}, ""),
        # The harmonic mean of the masses is 1.6 times as large.
        ({"restitution": 1.028, "mass_ratio": 4}, "e_c = 1.027"),
        ({"restitution": 1.034, "mass_ratio": 1}, ""),
    ],
)
def test_a_gas_that_collisions_heat_too_much_has_no_steady_state(changed, critical):
    reason = GAS.replace(**changed).why_unsteady
    assert critical in reason
    assert bool(critical) == bool(reason)
