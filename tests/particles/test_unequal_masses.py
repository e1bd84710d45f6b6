"""Collisions of unequal masses and with walls, against a slow twin and what must be kept."""

import math

import numpy as np
import pytest
import unequal_masses
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.impacts import make_impacts
from crazybilliards.particles.laws.law import EVENTS, Law, drift, make_scratch

LAW = Law(EVENTS, 1.0, 0.0, 10**6, unequal=True)
MOST = 400  # collisions in a drawn case


@st.composite
def cases(draw):
    """Draw rods of two masses, between walls or not, their anchors, a step and a law."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    size = draw(st.integers(1, 12))
    y, v = np.sort(generator.normal(size=size)), generator.normal(size=size)
    if draw(st.booleans()):
        v = 0.1 * v - y  # towards inelastic collapse
    ratio = draw(st.sampled_from([0.01, 0.5, 1.0, 3.0, 100.0]))
    e = draw(st.sampled_from([0.0, 0.1, 0.5, 0.95, 1.0, 1.05]))
    wall = draw(st.sampled_from([0.0, 0.5, 1.0, 1.1]))
    room = draw(st.sampled_from([math.inf, 1.0, 1.5]))
    high = room * np.abs(y).max()
    law = LAW._replace(
        restitution=e,
        most=MOST,
        merge_speed=draw(st.sampled_from([1e-9, 0.1])) if min(e, wall) < 1 else 0.0,
        pull=draw(st.sampled_from([0.0, 0.5])),
        exponent=draw(st.sampled_from([2, 3])),
        low=-high,
        high=high,
        wall_restitution=wall,
    )
    masses = np.where(np.arange(size) % 2, ratio, 1.0)
    anchors = draw(st.sampled_from([0.0, 0.3])) * np.arange(size)
    dt = draw(st.floats(0.01, 3))
    if law.pull > 0:  # a stable step
        dt = min(dt, math.sqrt(masses.min() / law.pull))
    return y, v, masses, anchors, dt, law


def drifted(y, v, masses, anchors, dt, law):
    """Positions, velocities, the tally, and the record of clusters after a drift."""
    walls = [0.0] if law.high < math.inf else []
    scratch = make_scratch(y.size, np.array([*walls, *(masses[0] / masses), *walls]))
    tally = make_tally(y.size, contacts=True)
    tally = tally._replace(impacts=make_impacts(y.size), struck=np.zeros((2, 2)))
    y, v = y.copy(), v.copy()
    if drift(y, v, anchors, dt, law, scratch, tally) < 0:
        reject()
    return y, v, tally, scratch


@settings(max_examples=300)
@given(cases())
def test_the_slow_twin_moves_the_rods_alike(case):
    y, v, tally, scratch = drifted(*case)
    expected = unequal_masses.drift(*case)
    np.testing.assert_allclose(y, expected.y, atol=1e-9)
    np.testing.assert_allclose(v, expected.v, atol=1e-9 * np.abs(case[1]).max())
    assert tally.contacts.tolist() == expected.contacts
    np.testing.assert_allclose(tally.struck[0], expected.impulses, rtol=1e-9, atol=1e-9)
    assert tally.struck[1].tolist() == expected.hits
    assert (scratch.joint == scratch.inverse).all()


@settings(max_examples=200)
@given(cases())
def test_the_mirror_image_moves_as_the_mirror_image(case):
    y, v, masses, anchors, dt, law = case
    here, there = (
        drifted(*case),
        drifted(
            -y[::-1],
            -v[::-1],
            masses[::-1],
            -anchors[::-1],
            dt,
            law._replace(
                pull=law.pull * masses[0] / masses[-1],
                merge_speed=law.merge_speed * masses[0] / masses[-1],
            ),
        ),
    )
    np.testing.assert_allclose(here[0], -there[0][::-1], atol=1e-9)
    np.testing.assert_allclose(here[1], -there[1][::-1], atol=1e-9 * max(np.abs(v).max(), 1))


@settings(max_examples=200)
@given(cases())
def test_momentum_and_energy_go_where_the_tally_says(case):
    _, v, masses, _, _, law = case
    _, w, tally, _ = drifted(*case)
    lost = masses * (v - w)
    scale = 1e-10 * (masses * np.abs(v)).sum() * max(np.abs(w).max() / np.abs(v).max(), 1) + 1e-12
    if law.pull > 0:
        return
    left, right = tally.struck[0]
    given_away = tally.impacts[0] + tally.impacts[2]
    np.testing.assert_allclose(lost.sum(), right - left, atol=scale)
    np.testing.assert_allclose(given_away, np.cumsum(lost)[:-1] + left, atol=scale)


@pytest.mark.parametrize(("zeros", "collisions"), list(enumerate([3, 31, 314, 3141, 31415])))
def test_a_wall_and_two_masses_count_the_digits_of_pi(zeros, collisions):
    """A rod of mass 100^n pushes one of mass 1 towards a wall (G. Galperin, 2003)."""
    masses, y, v = np.array([1.0, 100.0**zeros]), np.array([1.0, 2.0]), np.array([0.0, -1.0])
    _, w, tally, _ = drifted(y, v, masses, np.zeros(2), 1e3, LAW._replace(low=0.0, high=1e6))
    assert tally.contacts[0] + tally.struck[1, 0] == collisions
    assert masses @ w**2 == pytest.approx(masses[1], rel=1e-9)
