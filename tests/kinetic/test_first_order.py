"""Covariances of pairs to first order in 1 - e: the theory against the exact calculation.

What is tested here stands on the page on correlations, with what is wrong.
"""

import numpy as np
import pytest
from first_order import hermite, mode_variances
from scipy.stats import norm

from crazybilliards.kinetic.correlations import pair_covariance
from crazybilliards.kinetic.correlations.cells import make_cells, of_cells
from crazybilliards.kinetic.correlations.closure import Closure, background
from crazybilliards.kinetic.correlations.collision_moments import moments_of_collisions
from crazybilliards.kinetic.correlations.one_rod import profiles_of_one_rod
from crazybilliards.kinetic.kinetic_equation.continuation import elastic_state
from crazybilliards.model import Chain

CHAIN = Chain(size=100, restitution=0.999)
NUMBER = 6
DAMPING = CHAIN.damping / np.sqrt(CHAIN.stiffness * CHAIN.mass)
DISPLACEMENT, VELOCITY, TEMPERATURE = range(3)


@pytest.fixture(scope="module")
def exact():
    """Return the variances of modes over 1 - e."""
    return mode_variances(CHAIN.restitution, DAMPING, NUMBER) / (1 - CHAIN.restitution)


def of_theory():
    """Return the same of the theory, about the state of equilibrium."""
    cells = make_cells(CHAIN.size)
    rod = profiles_of_one_rod(cells, elastic_state(CHAIN, 2, 24))
    around = background(rod, Closure.independent(cells), CHAIN.restitution)
    pairs = pair_covariance.solve_pairs(
        cells, around, moments_of_collisions(CHAIN.restitution), DAMPING
    )
    found = []
    for field, labels, rods in (
        (pairs.displacement, cells.centres, cells.rods),
        (pairs.velocity, cells.centres, cells.rods),
        (pairs.temperature, cells.contacts, cells.distances),
    ):
        y = norm.ppf(labels / CHAIN.size)
        waves = np.array([hermite(n, y) for n in range(NUMBER)]) * rods / CHAIN.size
        found.append(np.diag(waves @ field @ waves.T))
    return np.array(found) / (1 - CHAIN.restitution)


def test_all_rods_together_move_with_the_energy_that_collisions_take(exact):
    """A pair loses (1 - e^2)/2 <|v - u|^3 delta(y_1 - y_2)>/2 per time; damping takes 2 Gamma."""
    shared = (1 + CHAIN.restitution) / 4 * (8 / np.sqrt(np.pi)) / (2 * np.sqrt(np.pi)) / 2
    assert exact[VELOCITY, 0] == pytest.approx(shared / DAMPING, rel=1e-9)
    assert exact[DISPLACEMENT, 0] == pytest.approx(exact[VELOCITY, 0], rel=1e-12)


def test_it_is_of_first_order():
    one, half = (mode_variances(1 - x, DAMPING, NUMBER) / x for x in (2e-4, 1e-4))
    np.testing.assert_allclose(one, half, rtol=2e-3, atol=1e-5)


def test_the_theory_is_wrong_where_the_page_says_so(exact):
    """The longest waves but one: displacements 3.3 times too large, velocities of wrong sign."""
    found = of_theory()
    assert found[DISPLACEMENT, 0] == pytest.approx(exact[DISPLACEMENT, 0], rel=0.02)
    assert found[VELOCITY, 0] == pytest.approx(exact[VELOCITY, 0], rel=0.02)
    assert found[DISPLACEMENT, 1] / exact[DISPLACEMENT, 1] == pytest.approx(3.3, abs=0.1)
    assert found[VELOCITY, 1] == pytest.approx(-0.134, abs=0.005)
    assert exact[VELOCITY, 1] == pytest.approx(0.0497, abs=0.0005)


def test_with_the_right_source_it_is_right_to_a_tenth(exact, monkeypatch):
    """Two rods that are close are one more at their place, and 1/L fewer everywhere else."""
    noise = pair_covariance._noise

    def repaired(cells, state, moments, damping):
        Q = noise(cells, state, moments, damping)
        u, _, Th, _ = pair_covariance._parts(cells.rods.size)
        beyond = np.tril(np.ones((cells.rods.size, cells.rods.size - 1)), -1)
        moved = of_cells(state.gap)[:, None] * (beyond - cells.centres[:, None] / cells.rods.sum())
        Q[u, Th] = moved * pair_covariance.dissipation(state, moments)
        Q[Th, u] = Q[u, Th].T
        return Q

    monkeypatch.setattr(pair_covariance, "_noise", repaired)
    found = of_theory()
    np.testing.assert_allclose(found[DISPLACEMENT, :3], exact[DISPLACEMENT, :3], rtol=0.07)
    np.testing.assert_allclose(found[VELOCITY, :4], exact[VELOCITY, :4], rtol=0.12)
    np.testing.assert_allclose(found[TEMPERATURE, 0], exact[TEMPERATURE, 0], rtol=0.03)
