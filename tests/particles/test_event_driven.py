"""Collisions in their order, against the twin that looks through all contacts, and digits of pi.

Rods of equal masses move to the last bit as the twin's.
"""

import next_collision
import numpy as np
import pytest
from drifts import Around, drift, drifted, everything
from hypothesis import given, settings
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.event_driven import LONG
from crazybilliards.particles.laws.law import EVENTS, Law, make_scratch

MOST = 400  # collisions in a drawn case
RESTITUTIONS = st.sampled_from([0.0, 0.1, 0.5, 0.95, 1.0, 1.05])


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


@given(
    state=states(),
    e=RESTITUTIONS,
    merge_speed=st.sampled_from([1e-9, 1e-3, 0.1]),
    gap=st.sampled_from([0.0, 0.01, 1.0]),
    exponent=st.sampled_from([2, 3]),
)
def test_every_bit_is_that_of_the_twin(state, e, merge_speed, gap, exponent):
    """Positions, velocities, collisions, waves; and the same without a tally."""
    agree_to_the_bit(*state, e, merge_speed if e < 1 else 0.0, gap, exponent)


@pytest.mark.parametrize("e", [0.05, 0.9999, 1.05])
@pytest.mark.parametrize(("rods", "rows"), [(LONG + 2, 1), (5, 10)])
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
    agree_to_the_bit(y, v, 1.5, e, 0.1 if e < 1 else 0.0, 0.0, 2, most=10_000)


def agree_to_the_bit(y, v, dt, e, merge_speed, gap, exponent, most=MOST):
    """Require that a drift is that of the twin, with and without a tally."""
    anchors = gap * (np.arange(y.size) - y.size / 3)
    law, scratch = Law(EVENTS, e, merge_speed, most, 0.1 * gap, exponent), make_scratch(y.size)
    expected_tally = everything(y.size)
    expected = next_collision.drift(y, v, np.ones(y.size), anchors, dt, law, expected_tally)
    for tally in (everything(y.size), make_tally(y.size, contacts=False)):
        after_y, after_v = y.copy(), v.copy()
        collisions = drift(after_y, after_v, anchors, dt, law, scratch, tally)
        assert (collisions < 0) == (expected is None)
        if collisions < 0:
            return
        assert collisions == sum(expected.contacts)
        np.testing.assert_array_equal((after_y, after_v), (expected.y, expected.v))
        if tally.contacts.size:
            np.testing.assert_array_equal(tally.contacts, expected_tally.contacts)
            np.testing.assert_array_equal(tally.impacts, expected_tally.impacts)
            np.testing.assert_array_equal(tally.pushes.sizes, expected_tally.pushes.sizes)
            np.testing.assert_array_equal(tally.triggered.sizes, expected_tally.triggered.sizes)


@st.composite
def unequal_cases(draw):
    """Draw rods, a step, and what is round them."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    size = draw(st.integers(1, 12))
    y, v = np.sort(generator.normal(size=size)), generator.normal(size=size)
    if draw(st.booleans()):
        v = 0.1 * v - y  # towards inelastic collapse
    ratio = draw(st.sampled_from([0.01, 0.5, 1.0, 3.0, 100.0]))
    room = draw(st.sampled_from([np.inf, 0.0, 0.5]))
    around = Around(room, draw(st.sampled_from([0.0, 0.5, 1.0, 1.1])), (1.0, ratio))
    springs = {
        "gap": draw(st.sampled_from([0.0, 0.3])),
        "pull": draw(st.sampled_from([0.0, 0.5])),
        "exponent": draw(st.sampled_from([2, 3])),
        "merge_speed": draw(st.sampled_from([1e-9, 0.1])),
    }
    dt = draw(st.floats(0.01, 3))
    if springs["pull"] > 0:  # a stable step
        dt = min(dt, np.sqrt(min(ratio, 1.0) / springs["pull"]))
    return (y, v), dt, draw(RESTITUTIONS), springs | {"around": around}


def agree(state, dt, e, around_it, most):
    """Require that a drift is that of the slow twin."""
    found = drifted(EVENTS, state, dt, e, most=most, **around_it)
    if found.collisions < 0:
        return
    expected = next_collision.drift(*state, found.masses, found.anchors, dt, found.law)
    np.testing.assert_allclose(found.y, expected.y, atol=1e-9)
    np.testing.assert_allclose(found.v, expected.v, atol=1e-9 * np.abs(state[1]).max())
    assert found.contacts.tolist() == expected.contacts
    np.testing.assert_allclose(found.struck, [expected.impulses, expected.hits], atol=1e-9)


@settings(max_examples=200)
@given(unequal_cases())
def test_unequal_masses_and_walls_move_as_with_the_twin(case):
    agree(*case, most=MOST)


@pytest.mark.parametrize("e", [0.5, 1.0])
@pytest.mark.parametrize("around", [Around(masses=(1, 3)), Around(0.1, 0.5), Around(0, 1, (1, 3))])
def test_long_rows_of_unequal_masses_move_as_with_the_twin(around, e):
    """In a tournament."""
    state = np.full(LONG + 2, 0.3), np.random.default_rng(1).normal(size=LONG + 2)
    agree(state, 0.05, e, {"around": around, "merge_speed": 0.1}, most=10**6)


@pytest.mark.parametrize(
    ("zeros", "collisions"), list(enumerate([3, 31, 314, 3141, 31415, 314159, 3141592]))
)
def test_a_wall_and_two_masses_count_the_digits_of_pi(zeros, collisions):
    """A rod of mass 100^n pushes one of mass 1 towards a wall (G. Galperin, 2003)."""
    alone = {"amplitude": 0, "damping": 0, "stiffness": 0}
    chain = Chain(size=2, mass=1, mass_ratio=100.0**zeros, box=1e4, **alone)
    start = given_start(chain, np.array([3.0, 8.0]) - chain.box / 2, [0.0, -1.0])
    seen = {"observe": ("collisions", "walls", "energy"), "every": 100, "time_step": 1}
    run = simulate(chain, duration=1000, start=start, progress=False, **seen)
    counted = 1000 * float(run.collision_rate[0] + run.wall_collision_rate[0])
    assert counted == pytest.approx(collisions, rel=1e-12)
    rounding = 1e-11 + 1e-16 * collisions
    np.testing.assert_allclose(run.total_energy, chain.rod_masses[1] / 2, rtol=rounding)
