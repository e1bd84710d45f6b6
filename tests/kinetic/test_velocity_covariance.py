"""Covariances of velocities over the separation: exact cases, other results, a simulation."""

import numpy as np
import pytest

from crazybilliards.kinetic import steady_state
from crazybilliards.kinetic.gas.cells import make_cells, of_rods
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Covariances

CHAIN = Chain(size=30, restitution=0.9)


@pytest.fixture(scope="module")
def theory():
    return steady_state(CHAIN)


def whole(covariance):
    """Return the symmetric matrix of covariances given over particle and separation."""
    size = len(covariance)
    matrix = np.empty((size, size))
    for r in range(size):
        i = np.arange(size - r)
        matrix[i, i + r] = matrix[i + r, i] = covariance[: size - r, r]
    return matrix


def test_rods_and_neighbours_have_what_the_other_results_say(theory):
    found = theory.velocity_covariance
    np.testing.assert_allclose(found.sel(separation=0), theory.velocity_width**2, rtol=1e-12)
    neighbours = found.sel(separation=1).values[:-1]
    np.testing.assert_allclose(neighbours, theory.neighbour_covariance, rtol=1e-12)
    np.testing.assert_allclose(whole(found.values), whole(found.values)[::-1, ::-1], rtol=1e-6)


def test_its_waves_are_the_modes(theory):
    """Long ones to a hundredth; of short ones it has more, 15 % for the shortest."""
    q, i = np.arange(30)[:, None], np.arange(30) + 0.5
    waves = np.sqrt(np.where(q == 0, 1, 2) / 30) * np.cos(np.pi * q * i / 30)
    found = np.einsum("qi,ij,qj->q", waves, whole(theory.velocity_covariance.values), waves)
    modes = theory.mode_velocity_variance.values
    np.testing.assert_allclose(found[:4], modes[:4], rtol=0.012)
    np.testing.assert_allclose(found, modes, rtol=0.15)
    assert found[0] / CHAIN.free_velocity_width**2 == pytest.approx(1, abs=0.01)


@pytest.mark.compiled
def test_simulation(theory):
    """Every pair, within the errors that the theory states for W_v^2, in the observer's form."""
    how = {"duration": 6000, "every": 0.5, "seed": 3, "threads": 1, "progress": False}
    run = simulate(CHAIN, observe=Covariances(separations=29), **how)
    found, measured = theory.velocity_covariance, run.velocity_covariance
    assert found.dims == measured.dims
    assert found.attrs == measured.attrs
    np.testing.assert_array_equal(found.separation, measured.separation)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(measured))
    own = theory.velocity_width**2
    errors = (theory.attrs[f"{name}_model_error"] for name in ("velocity_width", "border"))
    stated = 2 * max(errors) * own
    off, known = np.abs(found - measured), measured.notnull().values
    assert (off <= 5 * run.velocity_covariance_error + stated).values[known].all()
    mean = measured.mean("particle") / own.mean()
    assert float(mean[5]) > 0.05, "what is compared is there"


def test_a_cell_that_is_one_rod_has_the_covariance_of_the_rod():
    cells = make_cells(20)
    given = np.random.default_rng(1).normal(size=(20, 20))
    given = given + given.T
    found = whole(of_rods(given, cells))
    np.fill_diagonal(found, np.diag(given))
    np.testing.assert_allclose(found, given, rtol=1e-12)


def test_rods_within_cells_have_the_covariance_along_the_line_to_the_next_cells():
    """A covariance that falls along the chain: errors of the second order in cell over length."""

    def fall(a, b):
        return np.exp(-np.abs(a - b) / 60) * (1 + (a + b) / 1000)

    rods, within, beyond = np.arange(400) + 0.5, [], []
    far = (np.abs(rods[:, None] - rods) > 20)[20:-20, 20:-20]
    for most in (50, 100):
        cells = make_cells(400, most)
        found = of_rods(fall(cells.centres[:, None], cells.centres), cells)
        wanted = fall(rods[:, None], rods)
        away = np.abs(whole(found) - wanted)[20:-20, 20:-20]
        within.append(away[~far].max())
        beyond.append(away[far].max())
    assert within[0] < 0.08
    assert within[1] < within[0] / 3
    assert beyond[0] < 0.01
    assert beyond[1] < beyond[0] / 3
