"""Covariances of pairs to first order in 1 - e: the theory against the exact calculation.

What is left are terms of the order 1/L: with 1000 rods the same numbers are right to a hundredth.
"""

import numpy as np
import pytest
from first_order import displacement_source, hermite, mode_variances
from scipy.stats import norm

from crazybilliards.kinetic.gas.agreement import in_agreement
from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.kinetic.gas.displacements import relaxing_pairs
from crazybilliards.model import Chain

CHAIN = Chain(size=100, restitution=0.99999)
NUMBER = 6
DAMPING = CHAIN.relative_damping
DISPLACEMENT, VELOCITY, TEMPERATURE = range(3)


@pytest.fixture(scope="module")
def exact():
    """Return the variances of modes over 1 - e."""
    return mode_variances(CHAIN.restitution, DAMPING, NUMBER) / (1 - CHAIN.restitution)


@pytest.fixture(scope="module")
def found():
    """Return what pairs fluctuate about, its cells being rods, their linear response and h'.

    Shared motion, whose noise is smaller by 1/L, is left out.
    """
    state = in_agreement(CHAIN, make_cells(CHAIN.size)).fluctuations.background
    around = state._replace(shared=0 * state.shared, collective=0 * state.collective)
    return around, *relaxing_pairs(around)


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


def test_displacements_have_the_right_source(found):
    """What collisions make of displacement and temperature, against the exact integrals."""
    around, response, _ = found
    u, _, Th, _ = around.parts
    of_cells, of_contacts = modes(around.cells)
    made = (of_cells @ response.noise[u, Th] @ of_contacts.T)[:3, :4]
    exact = displacement_source(CHAIN.restitution, 4)[:3]
    np.testing.assert_allclose(made, exact, atol=0.03 * np.abs(exact).max())


def test_displacements_are_right_to_first_order(exact, found):
    variances = of_theory(found[-1])
    np.testing.assert_allclose(variances[DISPLACEMENT, :3], exact[DISPLACEMENT, :3], rtol=0.04)
    np.testing.assert_allclose(variances[VELOCITY, :4], exact[VELOCITY, :4], rtol=0.05)
    np.testing.assert_allclose(variances[TEMPERATURE, 0], exact[TEMPERATURE, 0], rtol=0.06)
