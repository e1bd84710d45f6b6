"""Finite elements on the (y, v) plane: integrals, symmetry, order statistics."""

import math

import numpy as np
import pytest
from scipy.special import erf
from skfem import LinearForm

from crazybilliards.kinetic.kinetic_equation.order_statistics import points
from crazybilliards.kinetic.kinetic_equation.velocity_moments import fitting_box, moments
from crazybilliards.kinetic.kinetic_equation.velocity_space import Box, VelocitySpace, graded

BOX = Box(6.5, 6.5, 1.5, 1.5)


def gauss(y, v, tilt=0.0):
    return np.exp(-(y[:, None] ** 2 + v**2 - 2 * tilt * y[:, None] * v) / 2) / (2 * np.pi)


@pytest.fixture(params=[True, False], ids=["half", "whole"])
def space(request):
    return VelocitySpace(BOX, 16, symmetric=request.param)


def test_graded_nodes():
    nodes = graded(10, 50.0, 1.0)
    assert nodes[0] == 0
    assert nodes[-1] == pytest.approx(50)
    assert (np.diff(nodes, 2) > 0).all()


def test_mass_and_energy_of_a_gaussian(space):
    f = space.project(gauss)
    assert space.whole_mass @ f == pytest.approx(1, abs=1e-6)
    assert space.whole_energy @ f == pytest.approx(1, abs=1e-6)


def test_collision_integrals_of_a_gaussian(space):
    """Int |v-u|(v-u) phi(u) du = (1 + v^2) erf(v/sqrt 2) + 2 v phi(v), and its like for |v-u|^3."""
    seen = space.table(space.interpolate(space.project(gauss))[0])
    v, density = space.v, seen @ space.v_weights
    phi = np.exp(-(v**2) / 2) / math.sqrt(2 * math.pi)
    sign = erf(v / math.sqrt(2))
    expected = (
        (1 + v**2) * sign + 2 * v * phi,
        (v**3 + 3 * v) * sign + 2 * (v**2 + 2) * phi,
        3 * ((1 + v**2) * sign + 2 * v * phi),
    )
    middle = np.argmax(density)
    for kernel, exact in zip(space.kernels, expected, strict=True):
        found = seen[middle] @ kernel.T / density[middle]
        np.testing.assert_allclose(found, exact, atol=2e-3 * np.abs(exact).max())


def test_collisions_conserve_momentum(space):
    """The matrix of |v-u|(v-u) is antisymmetric but for the weights: exactly no net force."""
    seen = space.table(space.interpolate(space.project(gauss))[0])
    force = ((seen @ space.kernels[0].T) * seen) @ space.v_weights
    assert np.abs(force).max() < 1e-15


def test_cumulative_is_exact_for_parabolas(space):
    y = space.y
    start = 0.0 if space.symmetric else -BOX.length
    found = space.cumulative(1 + 2 * y + 3 * y**2)
    np.testing.assert_allclose(found, (y + y**2 + y**3) - (start + start**2 + start**3), atol=1e-9)


def test_a_half_plane_is_the_whole_one():
    """A tilted Gaussian is symmetric under (y, v) -> (-y, -v) and in nothing else."""
    half, whole = (VelocitySpace(BOX, 16, symmetric=kind) for kind in (True, False))
    f = half.nodal(gauss(*half.axes, 0.4))
    moved = whole.take_over(half, f)
    np.testing.assert_allclose(moved, whole.nodal(gauss(*whole.axes, 0.4)), atol=1e-12)
    assert half.whole_mass @ f == pytest.approx(whole.whole_mass @ moved, abs=1e-12)


def test_the_box_fits_and_grows():
    narrow = VelocitySpace(BOX, 16)
    y, v = narrow.axes

    def fitted(in_y, in_v):
        f = narrow.nodal(gauss(in_y * y, in_v * v))
        return fitting_box(narrow, f / (narrow.whole_mass @ f))

    box = fitted(3, 2)
    assert box.length == pytest.approx(1.5 * 4.4 / 3, rel=0.15)
    assert box.velocity == pytest.approx(1.5 * 4.4 / 2, rel=0.15)
    wide = fitted(1 / 4, 1 / 4)
    assert wide.length > 1.4 * BOX.length


def test_order_statistics_of_a_gaussian():
    """Mean and variance of the extreme of 2 and 3 normal variables are known in closed form."""
    space = VelocitySpace(BOX, 24, symmetric=False)
    seen = moments(space, space.project(gauss))
    two, three = points(2, seen), points(3, seen)
    np.testing.assert_allclose(two.position, [-1, 1] / np.sqrt(np.pi), atol=1e-3)
    np.testing.assert_allclose(two.position_variance, 1 - 1 / np.pi, atol=3e-3)
    np.testing.assert_allclose(three.position, np.array([-1.5, 0, 1.5]) / np.sqrt(np.pi), atol=1e-3)
    np.testing.assert_allclose(three.velocity_variance, 1, atol=1e-4)


@pytest.mark.parametrize("symmetric", [True, False])
def test_interpolation_and_slopes_are_those_of_the_elements(symmetric):
    space = VelocitySpace(BOX, 5, symmetric)
    f = np.random.default_rng(1).normal(size=space.unknowns.shape[1])
    field = space.basis.interpolate(space.unknowns @ f)
    value, slope = space.interpolate(f)
    np.testing.assert_allclose(value, np.asarray(field), atol=1e-13)
    np.testing.assert_allclose(slope, field.grad[1], atol=1e-12)
    flux = LinearForm(lambda p, w: w.flux * p.grad[1])
    expected = space.assemble(flux, flux=value)
    np.testing.assert_allclose(space.against_slopes(value), expected, atol=1e-12)
