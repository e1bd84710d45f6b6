"""Collisions in their order, to the bit, against the twin that looks through all contacts."""

import next_collision
import numpy as np
import pytest
from drifts import drift, everything
from hypothesis import given, settings
from hypothesis import strategies as st

from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.event_driven import LONG
from crazybilliards.particles.laws.law import EVENTS, Law, make_scratch

MOST = 400


def running(waves):
    """Return front and origin of all running waves; in which places they are kept is no matter."""
    found = []
    for front, wave in enumerate(waves.heads):
        while wave >= 0:
            found.append((front, waves.origins[wave]))
            wave = waves.following[wave]
    return sorted(found)


def numbers(tally):
    """Return all that a tally has recorded."""
    both = tally.pushes, tally.triggered
    waves = [each for one in both for each in (one.sizes, running(one))]
    return [tally.contacts, *waves, tally.impacts]


@st.composite
def states(draw):
    """Draw points, some in contact or on a lattice, thrown at one another or not, and a step."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    size = draw(st.integers(1, 40))
    gaps, v = generator.exponential(size=size), generator.normal(size=size)
    kind = draw(st.sampled_from(["random", "touching", "lattice", "coarse", "compressed"]))
    if kind == "touching":
        gaps[generator.random(size) < 0.5] = 0
    if kind in ("lattice", "coarse"):  # meetings at the same time
        gaps[:] = 1
        if kind == "coarse":  # and with the same speed
            v = np.round(v)
    y = np.cumsum(gaps)
    if kind == "compressed":  # towards inelastic collapse
        v = 0.1 * v + (y.mean() - y) / size
    return y, v, draw(st.floats(0.01, 20))


@settings(max_examples=150)
@given(
    state=states(),
    e=st.sampled_from([0.0, 0.1, 0.5, 0.95, 1.0, 1.05]),
    merge_speed=st.sampled_from([1e-9, 1e-3, 0.1]),
    gap=st.sampled_from([0.0, 0.01, 1.0]),
    exponent=st.sampled_from([2, 3]),
)
def test_every_bit_is_that_of_the_twin(state, e, merge_speed, gap, exponent):
    """Positions, velocities, clusters, collisions, waves; and the same without a tally."""
    agree(*state, e, merge_speed if e < 1 else 0.0, gap, exponent)


@pytest.mark.parametrize("e", [0.05, 0.5, 0.9999, 1.05])
@pytest.mark.parametrize(("rods", "rows"), [(LONG + 1, 1), (LONG + 2, 1), (5, 30)])
@pytest.mark.parametrize("thrown", ["at random", "with equal speeds", "at rest", "in two halves"])
def test_long_rows_of_touching_rods_move_to_the_bit_as_with_the_twin(thrown, rods, rows, e):
    """Longer rows than a tournament needs, and many short ones, with exact ties."""
    y = np.repeat(np.arange(float(rows)), rods)
    v = np.random.default_rng(rods).normal(size=y.size) / 9
    if thrown == "with equal speeds":
        v = np.sign(v)
    elif thrown == "at rest":
        v = np.eye(1, y.size)[0]
    elif thrown == "in two halves":
        v = -np.sign(np.arange(y.size) - (y.size - 1) / 2)
    agree(y, v, 1.5, e, 0.1 if e < 1 else 0.0, 0.0, 2, most=10_000)


def agree(y, v, dt, e, merge_speed, gap, exponent, most=MOST):
    """Require that a drift is that of the twin, with and without a tally."""
    anchors = gap * (np.arange(y.size) - y.size / 3)
    law, scratch = Law(EVENTS, e, merge_speed, most, 0.1 * gap, exponent), make_scratch(y.size)
    expected_tally = everything(y.size)
    *expected, clusters, collisions = next_collision.drift(y, v, anchors, dt, law, expected_tally)
    for tally in (everything(y.size), make_tally(y.size, contacts=False)):
        after_y, after_v = y.copy(), v.copy()
        assert drift(after_y, after_v, anchors, dt, law, scratch, tally) == collisions
        if collisions < 0:
            return
        np.testing.assert_array_equal((after_y, after_v), expected)
        firsts, lasts, number = scratch.clusters
        assert list(zip(firsts[: number[0]], lasts[: number[0]], strict=True)) == clusters
        if tally.contacts.size:
            for kept, other in zip(numbers(tally), numbers(expected_tally), strict=True):
                np.testing.assert_array_equal(kept, other)
