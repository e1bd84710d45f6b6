"""The law of the springs: force and stiffness are derivatives, and the chain uses this law."""

import numpy as np
import pytest

from crazybilliards.model import Chain, spring
from crazybilliards.particles.dynamics import make_step
from crazybilliards.particles.stepping import FIRST, kick

D = np.concatenate([-np.geomspace(10, 0.01, 30), np.geomspace(0.01, 10, 30)])


def derivative(function, d):
    h = 1e-4 * np.abs(d)
    return (function(d + h) - function(d - h)) / (2 * h)


@pytest.mark.parametrize("exponent", [2, 3])
def test_force_and_stiffness_are_derivatives(exponent):
    force = derivative(lambda d: spring.potential(d, exponent), D)
    np.testing.assert_allclose(spring.force(D, exponent), force, rtol=1e-7)
    stiffness = derivative(lambda d: spring.force(d, exponent), D)
    np.testing.assert_allclose(spring.stiffness(D, exponent), stiffness, rtol=1e-7)
    assert spring.potential(0.0, exponent) == spring.force(0.0, exponent) == 0


@pytest.mark.parametrize("exponent", [2, 3])
def test_displacement_is_the_inverse_of_the_force(exponent):
    np.testing.assert_allclose(spring.displacement(spring.force(D, exponent), exponent), D)


@pytest.mark.parametrize("kind", ["linear", "quadratic"])
def test_chain_and_kernel_follow_the_law(kind):
    chain = Chain(size=D.size, spring=kind, stiffness=2.5, mass=1.5)
    n = chain.potential_exponent
    np.testing.assert_array_equal(chain.force(D), 2.5 * spring.force(D, n))
    np.testing.assert_array_equal(chain.potential(D), 2.5 * spring.potential(D, n))
    v = np.zeros(D.size)
    without = np.zeros(D.size)
    kick(D.copy(), v, without, without, make_step(chain, 0.1, "euler"), FIRST)
    np.testing.assert_allclose(v, -0.1 / 1.5 * chain.force(D), rtol=1e-14)
