"""Chains with e > 1 on linear springs: points in phase space with heavy tails."""

import numpy as np
import pytest

from crazybilliards.kinetic import steady_state
from crazybilliards.kinetic.gas.driven import driven_points
from crazybilliards.model import Chain


def widths(size, e, damping):
    """Return W_v over that of a free rod; ``damping`` is Gamma."""
    chain = Chain(size=size, restitution=e)
    chain = chain.replace(damping=damping * chain.damping / chain.relative_damping)
    return steady_state(chain).velocity_width.values / chain.free_velocity_width


def test_just_above_1_collisions_add_what_two_rods_add_at_rest():
    """A pair meets at the rate <|w|> int p^2 dy and gains (e^2 - 1)/2 w^2, from Gaussians.

    All L - 1 partners count once. Mutations: the centre of mass without a share, L - 1 for L.
    """
    L, e, Gamma = 5, 1 + 1e-5, 0.7
    gained = (e - 1) * (8 / np.sqrt(np.pi)) / (2 * np.sqrt(np.pi)) * (L - 1) / 2 / (2 * Gamma)
    assert np.mean(widths(L, e, Gamma) ** 2) - 1 == pytest.approx(gained, rel=1e-3)


# W_v of the rods 1, 10 and 50 of 100 with the drag lambda L, from finite elements of 50 x 100 cells
# in y and v. The restitutions are those with ln((1 + e)/2) L = drag.
STORED = [
    (1.0, 0.9424777960769348, [1.590081, 1.580965, 1.621495]),
    (2.0, 2.5132741228718336, [3.178330, 2.604224, 2.445803]),
]


@pytest.mark.parametrize(("damping", "drag", "rods"), STORED)
def test_the_equation_has_the_solution_that_finite_elements_have(damping, drag, rods):
    """Mutations: another power of |v - u|, springs that push, (e^2 - 1)/4 for the logarithm."""
    e = 2 * np.exp(drag / 100) - 1
    found = widths(100, e, damping)[[0, 9, 49]]
    np.testing.assert_allclose(found, rods, rtol=2e-3)


def test_just_above_1_the_heat_flux_carries_what_noise_and_collisions_bring():
    """From Gaussians d(n q)/dl = 2 Gamma (1 - T) + L (e - 1)/2 8/sqrt(pi) n/L.

    Mutations: a flux of the other sign, and of another moment.
    """
    L, e = 100, 1 + 1e-6
    chain = Chain(size=L, restitution=e)
    points, score = driven_points(chain), np.linspace(-3, 3, 601)
    T, flux = points.at(score)
    density = np.exp(-(score**2) / 2) / np.sqrt(2 * np.pi)
    gained = L * (e - 1) / 2 * 8 / np.sqrt(np.pi) * density
    brought = density * (2 * chain.relative_damping * (1 - T) + gained)
    carried = np.gradient(flux, score)
    np.testing.assert_allclose(carried, brought, atol=0.02 * np.abs(brought).max())
