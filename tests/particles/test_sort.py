"""The drift at e = 1 against a slow collision-by-collision twin, and its conservation laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws import sort
from crazybilliards.particles.laws.law import make_scratch


def drift(y, v, dt):
    sort_and_fly(y, v, dt, make_scratch(y.size))


@kernel
def sort_and_fly(y, v, dt, scratch):
    sort.drift(y, v, dt, scratch)


def drift_slowly(y, v, dt):
    """Elastic collisions one at a time: find the next, go there, swap the two velocities."""
    y, v = y.copy(), v.copy()
    remaining = dt
    while True:
        closing = v[:-1] - v[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            times = np.where(closing > 0, np.diff(y) / closing, np.inf)
        pair = int(np.argmin(times)) if times.size else 0
        if times.size == 0 or times[pair] > remaining:
            return y + remaining * v, v
        y += times[pair] * v
        remaining -= times[pair]
        v[pair], v[pair + 1] = v[pair + 1], v[pair]


@st.composite
def states(draw):
    size = draw(st.integers(1, 12))
    seed = draw(st.integers(0, 2**32))
    generator = np.random.default_rng(seed)
    return np.sort(generator.normal(size=size)), generator.normal(size=size)


@given(state=states(), dt=st.floats(0, 3))
def test_equals_its_slow_twin(state, dt):
    y, v = state
    expected_y, expected_v = drift_slowly(y, v, dt)
    y, v = y.copy(), v.copy()
    drift(y, v, dt)
    np.testing.assert_allclose(y, expected_y, atol=1e-12)
    np.testing.assert_allclose(v, expected_v, atol=1e-12)


@given(state=states(), dt=st.floats(0, 3))
def test_keeps_order_momentum_energy_and_moves_the_centre_freely(state, dt):
    y, v = state
    after_y, after_v = y.copy(), v.copy()
    drift(after_y, after_v, dt)
    assert (np.diff(after_y) >= 0).all()
    assert after_v.sum() == pytest.approx(v.sum(), abs=1e-12)
    assert (after_v**2).sum() == pytest.approx((v**2).sum())
    assert after_y.sum() == pytest.approx(y.sum() + dt * v.sum(), abs=1e-11)


@given(state=states(), dt=st.floats(0, 3))
def test_is_reflection_symmetric(state, dt):
    y, v = (each.copy() for each in state)
    mirrored_y, mirrored_v = -state[0][::-1], -state[1][::-1]
    drift(y, v, dt)
    drift(mirrored_y, mirrored_v, dt)
    np.testing.assert_allclose(mirrored_y, -y[::-1], atol=1e-12)
    np.testing.assert_allclose(mirrored_v, -v[::-1], atol=1e-12)


def test_newtons_cradle():
    y, v = np.array([-1.0, 0, 0, 0]), np.array([1.0, 0, 0, 0])
    drift(y, v, 2.0)
    np.testing.assert_array_equal(v, [0, 0, 0, 1])
    np.testing.assert_array_equal(y, [0, 0, 0, 1])


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
