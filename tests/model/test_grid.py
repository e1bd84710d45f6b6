"""The position grid and hat weights."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.model.grid import bins_per_rod, deposit, position_grid, thermal_reach


@pytest.mark.parametrize("amplitude", [0.1, 1, 100])
@pytest.mark.parametrize("size", [1, 2, 100, 100_000])
@pytest.mark.parametrize("gap", [0, 3])
def test_the_grid_is_symmetric_odd_per_rod_and_wide_enough(amplitude, size, gap):
    chain = Chain(amplitude=amplitude, size=size, gap=gap)
    x = position_grid(chain)
    n = bins_per_rod(chain)
    assert n % 2 == 1
    np.testing.assert_allclose(np.diff(x), 2 * chain.radius / n, rtol=1e-6)
    np.testing.assert_array_equal(x, -x[::-1])
    assert x[-1] >= chain.anchors[-1] + thermal_reach(chain) + 4 * chain.radius
    assert x.size <= 2**18 + 4


def deposit_slowly(points, nodes):
    """Twin of the kernel: every node's hat function at every point."""
    h = nodes[1] - nodes[0]
    return np.maximum(1 - np.abs(points[:, None] - nodes) / h, 0).sum(axis=0)


@given(points=st.lists(st.floats(-4.999, 4.999), max_size=30))
def test_deposit_equals_its_slow_twin(points):
    nodes = np.linspace(-5, 5, 41)
    weights = np.zeros(nodes.size)
    points = np.array(points, dtype=float)
    assert deposit(points, nodes[0], nodes[1] - nodes[0], weights) == 0
    np.testing.assert_allclose(weights, deposit_slowly(points, nodes), atol=1e-12)
    # Hat weights keep the number of points and their centre of mass.
    assert weights.sum() == pytest.approx(points.size)
    assert weights @ nodes == pytest.approx(points.sum(), abs=1e-9)


def test_points_outside_and_nan_are_counted_not_lost():
    weights = np.zeros(11)
    points = np.array([-0.1, 0.0, 5.5, 10.0, 1e300, np.nan, -np.inf])
    assert deposit(points, 0.0, 1.0, weights) == 5
    assert weights.sum() == 2


def test_a_grid_that_cannot_be_is_refused():
    with pytest.raises(ValueError, match="lost in the rounding of positions"):
        position_grid(Chain(size=10, amplitude=1e-9, gap=1.0))
    with pytest.raises(ValueError, match=r"would take .* GiB of memory"):
        position_grid(Chain(amplitude=1e20))
