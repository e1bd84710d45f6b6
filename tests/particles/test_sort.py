"""The drift at e = 1 against a slow collision-by-collision twin, and its conservation laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crazybilliards.particles.laws import sort


def drift(y, v, dt):
    return sort.drift(y, v, dt, np.empty(y.size), np.empty(y.size))


def drift_slowly(y, v, dt):
    """Elastic collisions one at a time: find the next, go there, swap the two velocities."""
    y, v = y.copy(), v.copy()
    remaining, collisions = dt, 0
    while True:
        closing = v[:-1] - v[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            times = np.where(closing > 0, np.diff(y) / closing, np.inf)
        pair = int(np.argmin(times)) if times.size else 0
        if times.size == 0 or times[pair] > remaining:
            return y + remaining * v, v, collisions
        y += times[pair] * v
        remaining -= times[pair]
        v[pair], v[pair + 1] = v[pair + 1], v[pair]
        collisions += 1


@st.composite
def states(draw):
    size = draw(st.integers(1, 12))
    seed = draw(st.integers(0, 2**32))
    generator = np.random.default_rng(seed)
    return np.sort(generator.normal(size=size)), generator.normal(size=size)


@given(state=states(), dt=st.floats(0, 3))
def test_equals_its_slow_twin(state, dt):
    y, v = state
    expected_y, expected_v, expected_collisions = drift_slowly(y, v, dt)
    y, v = y.copy(), v.copy()
    collisions = drift(y, v, dt)
    np.testing.assert_allclose(y, expected_y, atol=1e-12)
    np.testing.assert_allclose(v, expected_v, atol=1e-12)
    assert collisions == expected_collisions


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
    assert drift(y, v, 2.0) == 3
    np.testing.assert_array_equal(v, [0, 0, 0, 1])
    np.testing.assert_array_equal(y, [0, 0, 0, 1])


@pytest.mark.parametrize("size", [29, 30, 31, 63, 64, 65, 128, 200, 1000])
@pytest.mark.parametrize("dt", [0.0, 1e-3, 0.1, 10.0])
def test_long_chains_are_sorted_and_every_inversion_is_counted(size, dt):
    """Beyond 64 rods runs are merged: the same as sorting, inversions counted by brute force."""
    generator = np.random.default_rng(size)
    y, v = np.sort(generator.normal(size=size)), generator.normal(size=size)
    free = y + dt * v
    order = np.argsort(free)
    inversions = np.triu(free[:, np.newaxis] > free[np.newaxis, :]).sum()
    velocities = v.copy()
    assert drift(y, v, dt) == inversions
    np.testing.assert_array_equal(y, free[order])
    np.testing.assert_array_equal(v, velocities[order])


@pytest.mark.parametrize("size", [12, 30, 31, 100, 1000])
def test_rods_at_the_same_place_keep_their_order(size):
    generator = np.random.default_rng(size)
    free = generator.integers(0, size // 3, size).astype(float)  # many rods end at the same place
    names = np.arange(1.0, size + 1)
    y, v = free - names, names.copy()
    inversions = np.triu(free[:, np.newaxis] > free[np.newaxis, :]).sum()
    assert drift(y, v, 1.0) == inversions
    np.testing.assert_array_equal(v, names[np.argsort(free, kind="stable")])
