"""Collisions of unequal masses and with walls, against a slow twin and digits of pi."""

import numpy as np
import pytest
import unequal_masses
from drifts import Around, drifted, moved
from hypothesis import given, settings
from hypothesis import strategies as st

from crazybilliards.model import Chain
from crazybilliards.particles import given_start, simulate
from crazybilliards.particles.laws.event_driven import LONG
from crazybilliards.particles.laws.law import EVENTS

MOST = 400  # collisions in a drawn case


@st.composite
def cases(draw):
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
    e = draw(st.sampled_from([0.0, 0.1, 0.5, 0.95, 1.0, 1.05]))
    return (y, v), dt, e, springs | {"around": around}


def agree(state, dt, e, around_it, most):
    """Require that a drift is that of the slow twin."""
    found = drifted(EVENTS, state, dt, e, most=most, **around_it)
    if found.collisions < 0:
        return
    expected = unequal_masses.drift(*state, found.masses, found.anchors, dt, found.law)
    np.testing.assert_allclose(found.y, expected.y, atol=1e-9)
    np.testing.assert_allclose(found.v, expected.v, atol=1e-9 * np.abs(state[1]).max())
    assert found.contacts.tolist() == expected.contacts
    np.testing.assert_allclose(found.struck, [expected.impulses, expected.hits], atol=1e-9)
    assert found.clusters == expected.clusters


@settings(max_examples=300)
@given(cases())
def test_the_slow_twin_moves_the_rods_alike(case):
    agree(*case, most=MOST)


@pytest.mark.parametrize("e", [0.5, 1.0])
@pytest.mark.parametrize("around", [Around(masses=(1, 3)), Around(0.1, 0.5), Around(0, 1, (1, 3))])
def test_long_rows_of_touching_rods_move_as_with_the_twin(around, e):
    """In a tournament."""
    state = np.full(LONG + 2, 0.3), np.random.default_rng(1).normal(size=LONG + 2)
    agree(state, 0.05, e, {"around": around, "merge_speed": 0.1}, most=10**6)


@pytest.mark.parametrize("stiffness", [0.0, 0.4])
@pytest.mark.parametrize("mass_ratio", [1.0, 4.0])
def test_many_steps_between_walls_are_those_of_the_twin(mass_ratio, stiffness):
    """Quadratic springs or none, a gap, and losses at rods and walls."""
    lossy = {"restitution": 0.9, "box": 18.0, "wall_restitution": 0.5, "mass_ratio": mass_ratio}
    springs = {"spring": "quadratic", "gap": 0.2, "stiffness": stiffness}
    chain = Chain(size=8, amplitude=0, damping=0.05, mass=2, **lossy, **springs)
    state = chain.reduced_anchors, 2 * np.cos(2.0 * np.arange(8))
    y, v, contacts, hits = unequal_masses.moved(chain, state, 0.02, 300)
    assert contacts > 20
    assert hits >= 10
    np.testing.assert_allclose(moved(chain, state, 0.02, 300), (y, v), rtol=0, atol=1e-9)


@pytest.mark.parametrize(("zeros", "collisions"), list(enumerate([3, 31, 314, 3141, 31415])))
def test_a_wall_and_two_masses_count_the_digits_of_pi(zeros, collisions):
    """A rod of mass 100^n pushes one of mass 1 towards a wall (G. Galperin, 2003)."""
    alone = {"amplitude": 0, "damping": 0, "stiffness": 0}
    chain = Chain(size=2, mass=1, mass_ratio=100.0**zeros, box=1e4, **alone)
    start = given_start(chain, np.array([3.0, 8.0]) - chain.box / 2, [0.0, -1.0])
    seen = {"observe": ("collisions", "walls", "energy"), "every": 100, "time_step": 1}
    run = simulate(chain, duration=1000, start=start, progress=False, **seen)
    counted = 1000 * float(run.collision_rate[0] + run.wall_collision_rate[0])
    assert counted == pytest.approx(collisions, rel=1e-12)
    np.testing.assert_allclose(run.total_energy, chain.rod_masses[1] / 2, rtol=1e-11)
