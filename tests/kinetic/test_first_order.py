"""Covariances of pairs to first order in 1 - e: the theory against the exact calculation.

What is tested here stands on the page on correlations, with what is wrong.
"""

import numpy as np
import pytest
from first_order import displacement_source, hermite, mode_variances
from scipy.stats import norm

from crazybilliards.kinetic.correlations.closure import Closure, background
from crazybilliards.kinetic.correlations.displacements import relaxing_pairs
from crazybilliards.kinetic.correlations.one_rod import profiles_of_one_rod
from crazybilliards.kinetic.correlations.pair_covariance import Problem, parts, scales
from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.kinetic.kinetic_equation.continuation import elastic_state
from crazybilliards.model import Chain

CHAIN = Chain(size=100, restitution=0.999)
NUMBER = 6
DAMPING = CHAIN.relative_damping
DISPLACEMENT, VELOCITY, TEMPERATURE = range(3)


@pytest.fixture(scope="module")
def exact():
    """Return the variances of modes over 1 - e."""
    return mode_variances(CHAIN.restitution, DAMPING, NUMBER) / (1 - CHAIN.restitution)


def around_equilibrium(size=CHAIN.size):
    """Return the problem and what its pairs fluctuate about."""
    problem = Problem.of(CHAIN.replace(size=size))
    rod = profiles_of_one_rod(problem.cells, elastic_state(problem.chain, 2, 24))
    return problem, background(problem, rod, Closure.independent(problem.cells))


def relaxing(size=CHAIN.size):
    """Return the response and the covariances of which displacement widths are made."""
    problem, around = around_equilibrium(size)
    return relaxing_pairs(problem, around, 0 * around.shared)


def modes(cells):
    """Return the waves of cells and of contacts."""
    size = cells.rods.sum()
    places = (cells.centres, cells.rods), (cells.contacts, cells.distances)
    return [
        np.array([hermite(n, norm.ppf(labels / size)) for n in range(NUMBER)]) * rods / size
        for labels, rods in places
    ]


def of_theory(pairs):
    """Return the variances of modes over 1 - e of the theory."""
    of_cells, of_contacts = modes(make_cells(CHAIN.size))
    fields = (pairs.displacement, of_cells), (pairs.velocity, of_cells)
    fields = *fields, (pairs.temperature, of_contacts)
    found = [np.diag(waves @ field @ waves.T) for field, waves in fields]
    return np.array(found) / (1 - CHAIN.restitution)


def test_all_rods_together_move_with_the_energy_that_collisions_take(exact):
    """A pair loses (1 - e^2)/2 <|v - u|^3 delta(y_1 - y_2)>/2 per time; damping takes 2 Gamma."""
    shared = (1 + CHAIN.restitution) / 4 * (8 / np.sqrt(np.pi)) / (2 * np.sqrt(np.pi)) / 2
    assert exact[VELOCITY, 0] == pytest.approx(shared / DAMPING, rel=1e-9)
    assert exact[DISPLACEMENT, 0] == pytest.approx(exact[VELOCITY, 0], rel=1e-12)


def test_displacements_have_the_right_source():
    """What collisions make of displacement and temperature, against the exact integrals."""
    problem, around = around_equilibrium(1000)
    at, cells = problem.cells.contacts, problem.on_whole_cells().cells
    around = around._make(np.interp(cells.contacts, at, each) for each in around)
    u, _, Th, _ = parts(cells.rods.size)
    size, (of_cells, of_contacts) = scales(cells, around), modes(cells)
    noise = relaxing(1000)[0].noise[u, Th] * np.outer(size[u], size[Th])
    found = (of_cells @ noise @ of_contacts.T)[:3, :4]
    exact = displacement_source(CHAIN.restitution, 4)[:3]
    np.testing.assert_allclose(found, exact, atol=0.005 * np.abs(exact).max())


def test_displacements_are_right_to_first_order(exact):
    found = of_theory(relaxing()[1])
    np.testing.assert_allclose(found[DISPLACEMENT, :3], exact[DISPLACEMENT, :3], rtol=0.07)
    np.testing.assert_allclose(found[VELOCITY, :4], exact[VELOCITY, :4], rtol=0.12)
    np.testing.assert_allclose(found[TEMPERATURE, 0], exact[TEMPERATURE, 0], rtol=0.03)
