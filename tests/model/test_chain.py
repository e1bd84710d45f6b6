"""The chain: what it accepts, the scales it derives, its springs, its grid of positions."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model import Chain, spring
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.model.grid import deposit, position_grid
from crazybilliards.particles.dynamics import make_step
from crazybilliards.particles.stepping import FIRST, kick

positive = st.floats(min_value=1e-6, max_value=1e6)
gaps = st.floats(0, 10).map(lambda gap: round(gap, 6))


WRONG = [-1, -1e-9, 1e70, 10**400, np.nan, np.inf, 1j, None, True, "1", "x" * 999, ["linear"]]


@pytest.mark.parametrize("name", Chain().parameters())
def test_a_wrong_parameter_is_one_short_line(name):
    for value in [*WRONG, np.array(-1.0), np.array([1.0]), np.zeros((9, 9)), np.array(["a"] * 2)]:
        with pytest.raises(ValueError, match=f"^{name} must be .*, got ") as caught:
            Chain(**{name: value})
        assert "\n" not in str(caught.value)
        assert len(str(caught.value)) < 250


def test_zero_amplitude_damping_and_stiffness_are_chains_without_a_steady_state():
    for name in ("amplitude", "damping", "stiffness"):
        chain = Chain(**{name: 0})
        with pytest.raises(ValueError, match=f"no steady state: {name}=0"):
            chain.require_steady_state()
    assert Chain(damping=0).temperature == math.inf
    assert Chain(amplitude=0, damping=0).temperature == 0


def test_scales_of_the_reference_chain():
    chain = Chain()
    assert chain.temperature == pytest.approx(0.5)
    assert chain.free_velocity_width == pytest.approx(1 / math.sqrt(2 * 4 * math.pi / 3))
    assert chain.thermal_length == pytest.approx(math.sqrt(0.5))
    assert Chain(spring="quadratic").thermal_length == pytest.approx(0.5 ** (1 / 3))


@given(size=st.integers(1, 40), gap=gaps, radius=positive)
def test_reduced_and_physical_coordinates_are_inverse(size, gap, radius):
    chain = Chain(size=size, gap=gap, radius=radius)
    np.testing.assert_allclose(
        chain.reduced(chain.anchors), chain.reduced_anchors, atol=1e-9 * radius * size
    )
    y = np.linspace(-3, 3, size)
    np.testing.assert_allclose(chain.reduced(chain.physical(y)), y, atol=1e-9 * max(radius, 1))
    np.testing.assert_allclose(np.diff(chain.anchors), 2 * radius + gap)
    np.testing.assert_allclose(chain.anchors, -chain.anchors[::-1])


def test_the_middle_tenth_is_within_a_twentieth_of_the_middle():
    """Of few places it is the one or two in the middle."""
    assert [middle_tenth(places) for places in (1, 2, 3)] == [slice(0, 1), slice(0, 2), slice(1, 2)]
    for places in range(10, 2001):
        off = np.abs(Chain(size=places).rank)
        taken = np.zeros(places, dtype=bool)
        taken[middle_tenth(places)] = True
        np.testing.assert_array_equal(taken, 20 * off <= places)


# -- the springs: the force is a derivative ---------------------------------------------------

D = np.concatenate([-np.geomspace(10, 0.01, 30), np.geomspace(0.01, 10, 30)])


@pytest.mark.parametrize("exponent", [2, 3])
def test_the_force_is_a_derivative_and_displacement_is_its_inverse(exponent):
    h = 1e-4 * np.abs(D)
    higher, lower = (spring.potential(d, exponent) for d in (D + h, D - h))
    np.testing.assert_allclose(spring.force(D, exponent), (higher - lower) / (2 * h), rtol=1e-7)
    assert spring.potential(0.0, exponent) == spring.force(0.0, exponent) == 0
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


# -- the grid of positions and its hat weights ------------------------------------------------


@pytest.mark.parametrize("amplitude", [0.1, 1, 100])
@pytest.mark.parametrize("size", [1, 2, 100, 100_000])
@pytest.mark.parametrize("gap", [0, 3])
def test_the_grid_is_symmetric_odd_per_rod_and_wide_enough(amplitude, size, gap):
    chain = Chain(amplitude=amplitude, size=size, gap=gap)
    x = position_grid(chain)
    n = round(2 * chain.radius / (x[1] - x[0]))
    assert n % 2 == 1
    np.testing.assert_allclose(np.diff(x), 2 * chain.radius / n, rtol=1e-6)
    np.testing.assert_array_equal(x, -x[::-1])
    assert x[-1] >= chain.anchors[-1] + chain.thermal_reach + 4 * chain.radius
    assert x.size <= 2**18 + 4


@given(points=st.lists(st.floats(-4.999, 4.999), max_size=30))
def test_deposit_equals_the_hat_function_of_every_node_at_every_point(points):
    nodes = np.linspace(-5, 5, 41)
    weights = np.zeros(nodes.size)
    points = np.array(points, dtype=float)
    h = nodes[1] - nodes[0]
    assert deposit(points, nodes[0], h, weights) == 0
    slowly = np.maximum(1 - np.abs(points[:, None] - nodes) / h, 0).sum(axis=0)
    np.testing.assert_allclose(weights, slowly, atol=1e-12)


def test_points_outside_and_nan_are_counted_not_lost():
    weights = np.zeros(11)
    points = np.array([-0.1, 0.0, 5.5, 10.0, 1e300, np.nan, -np.inf])
    assert deposit(points, 0.0, 1.0, weights) == 5
    assert weights.sum() == 2
