"""Rods that drift or step without noise, and what every collision operator has to keep."""

import math
from typing import NamedTuple

import numpy as np
import pytest

from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally, make_waves
from crazybilliards.particles.laws.impacts import make_impacts
from crazybilliards.particles.laws.law import CONTACTS, EVENTS, Law, make_scratch
from crazybilliards.particles.laws.unequal import row_restitution
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.stepping import advance
from studies.time_step import drift

OPERATORS = (EVENTS, CONTACTS)  # for any restitution
UNSEEN = make_tally(2, contacts=False)


def everything(size):
    """Return a tally that keeps all there is."""
    waves = {"pushes": make_waves(size), "triggered": make_waves(size)}
    return make_tally(size, contacts=True)._replace(impacts=make_impacts(size), **waves)


class Around(NamedTuple):
    """Two walls, so far beyond the outermost rod, or none; and the masses of the rods in turn."""

    room: float = math.inf
    wall: float = 1.0  # restitution
    masses: tuple[float, float] = (1.0, 1.0)


PLAIN = Around()


class Drifted(NamedTuple):
    y: np.ndarray
    v: np.ndarray
    collisions: int  # -1 if there were too many
    impacts: np.ndarray
    contacts: np.ndarray  # collisions of each
    struck: np.ndarray  # what the left and the right wall received: impulses, hits
    masses: np.ndarray
    anchors: np.ndarray
    law: Law


def drifted(
    operator,
    state,
    dt,
    e,
    *,
    gap=0.0,
    pull=0.0,
    exponent=2,
    merge_speed=1e-9,
    around=PLAIN,
    most=10**6,
):
    """Let rods drift; ``pull`` is k/m of springs for a mass of 1, and anchors are a gap apart."""
    y, v = (np.array(each, dtype=float) for each in state)
    tally = make_tally(y.size, contacts=True)
    tally = tally._replace(impacts=make_impacts(y.size), struck=np.zeros((2, 2)))
    high, masses = float(np.abs(y).max() + around.room or 1.0), np.resize(around.masses, y.size)
    walls = [0.0] if high < math.inf else []
    inverse = np.array([*walls, *(1 / masses), *walls] if around != PLAIN else [])
    merging = merge_speed if min(e, around.wall) < 1 else 0.0
    from_row = row_restitution(e, around.wall)
    springs = pull, exponent, -high, high, float(around.wall), around != PLAIN, from_row
    law, scratch = Law(operator, e, merging, most, *springs), make_scratch(y.size, inverse)
    anchors = gap * (np.arange(y.size) - (y.size - 1) / 2)
    collisions = drift(y, v, anchors, dt, law, scratch, tally)
    assert collisions >= 0 or most < 10**6
    if operator == EVENTS and collisions >= 0:
        assert tally.contacts.sum() + tally.struck[1].sum() == collisions
    assert (scratch.joint == scratch.inverse).all()
    counted = tally.impacts, tally.contacts, tally.struck
    return Drifted(y, v, collisions, *counted, masses, anchors, law)


def require_kept(operator, state, dt, e, **around_it):
    """Order, room, momentum and centre of mass for all laws; energy and impulses as promised."""
    y, v = (np.array(each, dtype=float) for each in state)
    after = drifted(operator, state, dt, e, **around_it)
    end, w, masses, impacts = after.y, after.v, after.masses, after.impacts
    scale = max(np.abs(v).max(), np.abs(w).max(), 1.0) * masses.sum()
    lost, (left, right) = masses * (v - w), after.struck[0]
    assert (np.diff([after.law.low, *end, after.law.high]) >= 0).all()
    if after.law.high == np.inf:
        rounding = 1e-12 * scale + 1e-13 * (masses * np.abs(y)).sum() / dt
        assert lost.sum() == pytest.approx(0, abs=rounding)
        there = masses @ (y + dt * v)
        assert masses @ end == pytest.approx(there, abs=1e-12 * scale * max(dt, 1))
    if operator != EVENTS:
        return
    assert min(left, right) >= 0  # no wall pulls
    np.testing.assert_allclose(lost.sum(), right - left, atol=1e-12 * scale)
    alike = around_it.get("around", PLAIN) == PLAIN and not around_it.get("gap")
    if around_it.get("pull") and not alike:
        return
    energy, taken = masses @ (v**2 - w**2) / 2, (impacts[1] - impacts[3]).sum()
    given_away, rounding = impacts[0] + impacts[2], 1e-12 * scale**2
    np.testing.assert_allclose(given_away, left + np.cumsum(lost)[:-1], atol=1e-12 * scale)
    assert taken >= 0 or e > 1
    if after.law.wall_restitution == 1:  # what walls take is not counted
        assert energy == pytest.approx(taken, abs=rounding)
    assert energy >= taken - rounding or after.law.wall_restitution > 1


def require_alike(one, other, state, dt, e, **around_it):
    """Two operators move the rods alike."""
    ours, theirs = (drifted(each, state, dt, e, **around_it) for each in (one, other))
    np.testing.assert_allclose(ours.y, theirs.y, atol=1e-11 * max(dt, 1))
    np.testing.assert_allclose(ours.v, theirs.v, atol=1e-11)


def moved(chain, state, time_step, steps, *, step=None, tally=None, **settings):
    """Positions and velocities after some steps without noise; ``step`` replaces the usual one."""
    y, v = (np.array(each, dtype=float) for each in state)
    dynamics = make_dynamics(chain, time_step, speed=max(np.abs(v).max(), 1.0), **settings)
    if step is not None:
        dynamics = dynamics._replace(step=step)
    if tally is None:
        tally = make_tally(y.size, contacts=settings.get("counted", False))
    noise = make_noise(np.random.SeedSequence(0))
    scratch = make_scratch(y.size, dynamics.inverse)
    assert advance(y, v, noise, dynamics, scratch, tally, steps) >= 0
    return y, v
