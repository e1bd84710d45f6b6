"""Rods that drift or step without noise, and what every collision operator has to keep."""

from typing import NamedTuple

import numpy as np
import pytest

from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally, make_waves
from crazybilliards.particles.laws.impacts import make_impacts
from crazybilliards.particles.laws.law import CONTACTS, EVENTS, Law, drift, make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.stepping import advance

OPERATORS = (EVENTS, CONTACTS)  # for any restitution
UNSEEN = make_tally(2, contacts=False)


def everything(size):
    """Return a tally that keeps all there is."""
    waves = {"pushes": make_waves(size), "triggered": make_waves(size)}
    return make_tally(size, contacts=True)._replace(impacts=make_impacts(size), **waves)


class Drifted(NamedTuple):
    y: np.ndarray
    v: np.ndarray
    collisions: int
    impacts: np.ndarray


def drifted(operator, state, dt, e, *, gap=0.0, pull=0.0, exponent=2, merge_speed=1e-9):
    """Let rods drift, which are on springs if ``pull`` is k/m, with anchors a gap apart."""
    y, v = (np.array(each, dtype=float) for each in state)
    tally = make_tally(y.size, contacts=True)._replace(impacts=make_impacts(y.size))
    law = Law(operator, e, merge_speed if e < 1 else 0.0, 10**6, pull, exponent)
    anchors = gap * (np.arange(y.size) - (y.size - 1) / 2)
    collisions = drift(y, v, anchors, dt, law, make_scratch(y.size), tally)
    assert collisions >= 0
    assert operator != EVENTS or tally.contacts.sum() == collisions
    return Drifted(y, v, collisions, tally.impacts)


def require_kept(operator, state, dt, e, **springs):
    """Order, momentum and centre of mass for all laws; energy and impulses as far as promised."""
    y, v = (np.array(each, dtype=float) for each in state)
    end, w, _, impacts = drifted(operator, state, dt, e, **springs)
    scale = max(np.abs(v).max(), 1.0) * y.size
    assert (np.diff(end) >= 0).all()
    assert w.sum() == pytest.approx(v.sum(), abs=1e-12 * scale + 1e-13 * np.abs(y).sum() / dt)
    assert end.sum() == pytest.approx((y + dt * v).sum(), abs=1e-12 * scale * max(dt, 1))
    if operator != EVENTS or (springs.get("gap") and springs.get("pull")):
        return
    assert (w**2).sum() <= (v**2).sum() * (1 + 1e-12) or e > 1
    given_away, taken = impacts[0] + impacts[2], (impacts[1] - impacts[3]).sum()
    np.testing.assert_allclose(given_away, np.cumsum(v - w)[:-1], atol=1e-12 * scale)
    assert taken == pytest.approx(((v**2).sum() - (w**2).sum()) / 2, abs=1e-12 * scale**2)


def require_alike(one, other, state, dt, e, **springs):
    """Two operators move the rods alike."""
    ours, theirs = (drifted(each, state, dt, e, **springs) for each in (one, other))
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
    noise, scratch = make_noise(np.random.SeedSequence(0)), make_scratch(y.size)
    assert advance(y, v, noise, dynamics, scratch, tally, steps) >= 0
    return y, v
