r"""Covariances of pairs to first order in 1 - e: the theory against the exact calculation.

At e = 1 rods that swap names are independent, each with the Kramers operator A of an oscillator. To
first order in 1 - e the correlation G of two of them is what collisions make of independent ones,

    A_1 G + A_2 G + S = 0,      S = delta(y_1 - y_2) |v_1 - v_2| ( (f f)* - f f ),

f being the Gaussian of equilibrium and * the velocities after a collision. Normalised Hermite
functions of y and v solve it, without a field, a closure or a lattice. The numbers below are this
solution. What is left are terms of the order 1/L: with 1000 rods they are right to a hundredth.
"""

import math

import numpy as np
import pytest
from numpy.polynomial.hermite_e import hermeval
from scipy.stats import norm

from crazybilliards.kinetic.gas.agreement import in_agreement, relaxing_pairs
from crazybilliards.kinetic.gas.cells import make_cells
from crazybilliards.model import Chain

CHAIN = Chain(size=100, restitution=0.99999)
# Variances of modes over 1 - e, in units of the free rod.
DISPLACEMENT = [0.651467, 0.037101, 0.016225]
VELOCITY = [0.651467, 0.049468, 0.029206, 0.020360]
TEMPERATURE = [-0.049455]
# What collisions make of displacement and temperature, over 1 - e.
SOURCE = [[0, -0.318308, 0, 0.194923], [0.159154, 0, -0.168809, 0], [0, 0.112539, 0, -0.114860]]


def hermite(order, x):
    """Return a Hermite polynomial, normalised: its mean square over a Gaussian is 1."""
    return hermeval(x, [0] * order + [1]) / math.sqrt(math.factorial(order))


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
        np.array([hermite(n, norm.ppf(labels / size)) for n in range(4)]) * rods / size
        for labels, rods in places
    ]


def test_displacements_have_the_right_source(found):
    around, response, _ = found
    u, _, Th, _ = around.parts
    of_cells, of_contacts = modes(around.cells)
    made = (of_cells @ response.noise[u, Th] @ of_contacts.T)[:3] / (1 - CHAIN.restitution)
    np.testing.assert_allclose(made, SOURCE, atol=0.03 * np.abs(SOURCE).max())


def test_displacements_are_right_to_first_order(found):
    pairs, (of_cells, of_contacts) = found[-1], modes(make_cells(CHAIN.size))
    for field, waves, exact, rtol in (
        (pairs.displacement, of_cells, DISPLACEMENT, 0.04),
        (pairs.velocity, of_cells, VELOCITY, 0.05),
        (pairs.temperature, of_contacts, TEMPERATURE, 0.06),
    ):
        variances = np.diag(waves @ field @ waves.T)[: len(exact)]
        np.testing.assert_allclose(variances / (1 - CHAIN.restitution), exact, rtol=rtol)
