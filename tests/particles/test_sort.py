"""The sort of the drift at e = 1; that it is one collision after another, see test_operators."""

import numpy as np
import pytest

from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws import sort
from crazybilliards.particles.laws.law import make_scratch


def drift(y, v, dt):
    sort_and_fly(y, v, dt, make_scratch(y.size))


@kernel
def sort_and_fly(y, v, dt, scratch):
    sort.drift(y, v, dt, scratch)


PLACES = {
    "normal": lambda generator, size: generator.normal(size=size),
    "far away": lambda generator, size: 1e200 * generator.standard_cauchy(size),
    "in one bucket": lambda generator, size: np.append(1e6, 1e-6 * generator.normal(size=size - 1)),
    "at one place": lambda generator, size: np.full(size, 3.0),
    "hardly apart": lambda generator, size: 1 + 2.0**-52 * generator.integers(0, size, size),
    "next to nothing": lambda generator, size: 5e-324 * generator.integers(0, size, size),
}


@pytest.mark.parametrize("size", [2, 15, 16, 17, 63, 64, 65, 128, 200, 1000, 10_001])
@pytest.mark.parametrize("places", PLACES)
def test_rods_are_sorted_wherever_they_are(size, places):
    """Below 16 rods by insertion, beyond by buckets; beyond 64 runs are merged."""
    free = PLACES[places](np.random.default_rng(size), size)
    y, v = free.copy(), np.arange(float(size))
    drift(y, v, 0.0)
    order = np.argsort(free, kind="stable")
    np.testing.assert_array_equal(y, free[order])
    np.testing.assert_array_equal(v, order)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_chain_that_diverges_harms_nothing(wrong):
    """Positions may be no numbers then: all rods are still there."""
    y, v = np.random.default_rng(1).normal(size=100), np.arange(100.0)
    y[[3, 50]] = wrong
    drift(y, v, 0.0)
    assert sorted(v) == list(range(100))


@pytest.mark.parametrize("size", [12, 30, 31, 100, 1000])
def test_rods_at_the_same_place_keep_their_order(size):
    generator = np.random.default_rng(size)
    free = generator.integers(0, size // 3, size).astype(float)  # many rods end at the same place
    names = np.arange(1.0, size + 1)
    y, v = free - names, names.copy()
    drift(y, v, 1.0)
    np.testing.assert_array_equal(v, names[np.argsort(free, kind="stable")])
