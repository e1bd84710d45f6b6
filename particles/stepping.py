r"""Time stepping: kicks (spring, damping, noise) alternating with drifts that hold the collisions.

**splitting** (default). Per step of length dt

1. exact Ornstein-Uhlenbeck update, v <- c v + sqrt((T/m)(1 - c^2)) xi with c = exp(-gamma dt/m),
2. half a spring kick, v <- v - (dt/2m) F(d),
3. drift with collisions,
4. half a spring kick.

One force evaluation per kick, one noise draw per step. Steps 2-4 are the symplectic Verlet
scheme and step 1 leaves every Maxwellian unchanged, so a linear chain without gap has exactly
the right velocity width at any dt, and <d^2> = (T/k)/(1 - (w0 dt/2)^2): second order. In a
transient the damping runs half a step late: velocities are off by gamma dt/2m, first order.

**euler** (the paper's). v <- v + (dt/m)(-F(d) - gamma v) + (A/m) sqrt(dt) xi, then the drift.
First order: a free rod without spring has W^2 = (T/m)/(1 - gamma dt/2m).
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles.drift import drift
from crazybilliards.particles.kernel import kernel

Stepper = Literal["splitting", "euler"]


class Step(NamedTuple):
    """What a kernel needs to know of the chain and the scheme: plain numbers."""

    time_step: float
    decay: float  # factor on v from the damping
    noise: float  # standard deviation of the velocity kick
    kick: float  # velocity kick per unit of d or d|d|, one half of it for the splitting
    quadratic: bool
    verlet: bool  # splitting: a second half kick after the drift


def make_step(chain: Chain, time_step: float, stepper: Stepper) -> Step:
    """Return the numbers of one step of the chain under the named scheme."""
    m, gamma = chain.mass, chain.damping
    full_kick = chain.stiffness * time_step / m
    quadratic = chain.spring == "quadratic"
    if stepper == "euler":
        noise = chain.amplitude / m * math.sqrt(time_step)
        return Step(time_step, 1 - gamma * time_step / m, noise, full_kick, quadratic, False)
    rate = 2 * gamma * time_step / m
    # (1 - c^2)/rate -> 1 without damping: the noise alone, variance A^2 dt/m^2.
    share = -math.expm1(-rate) / rate if rate > 0 else 1.0
    noise = chain.amplitude / m * math.sqrt(time_step * share)
    return Step(time_step, math.exp(-rate / 2), noise, full_kick / 2, quadratic, True)


@kernel
def _spring_kick(y, v, anchors, kick, quadratic):  # type: ignore[no-untyped-def] # pragma: no cover
    for i in range(y.size):
        d = y[i] - anchors[i]
        v[i] -= kick * (d * abs(d) if quadratic else d)


@kernel
def advance(y, v, anchors, generator, step, law, scratch, tally, steps):  # type: ignore[no-untyped-def] # pragma: no cover
    """Take ``steps`` steps of the chain in place; return the collisions, or -1 if diverged.

    ``y``, ``v``, ``anchors``: float arrays of shape (L,) in the reduced coordinate;
    ``generator``: a numpy Generator of this thread's own; ``tally``: see ``avalanche``.
    """
    collisions = 0
    for _ in range(steps):
        for i in range(y.size):
            d = y[i] - anchors[i]
            pull = step.kick * (d * abs(d) if step.quadratic else d)
            v[i] = step.decay * v[i] + step.noise * generator.standard_normal() - pull
        met = drift(y, v, step.time_step, law, scratch, tally)
        if met < 0:
            return -1
        collisions += met
        if step.verlet:
            _spring_kick(y, v, anchors, step.kick, step.quadratic)
    return collisions


@kernel
def bounded(y, v, fastest):  # type: ignore[no-untyped-def] # pragma: no cover
    """Whether the state is finite and no rod faster than ``fastest``; false for NaN."""
    for i in range(y.size):
        if not (abs(v[i]) <= fastest and abs(y[i]) < np.inf):
            return False
    return True


@kernel
def record(  # type: ignore[no-untyped-def] # pragma: no cover
    y, v, anchors, generator, step, law, scratch, tally, stride, fastest, y_buffer, v_buffer
):
    """Fill the buffers, shape (snapshots, L), with the state after every ``stride`` steps.

    Return how many snapshots are good: fewer than there is room for if the chain diverged, that
    is, an operator gave up or a rod became faster than ``fastest``. Collisions at the contacts are
    then those up to the last good one: the steps that blew up may have had a million.
    """
    contacts = tally.contacts.copy()
    for snapshot in range(y_buffer.shape[0]):
        met = advance(y, v, anchors, generator, step, law, scratch, tally, stride)
        if met < 0 or not bounded(y, v, fastest):
            tally.contacts[:] = contacts
            return snapshot
        contacts[:] = tally.contacts
        y_buffer[snapshot] = y
        v_buffer[snapshot] = v
    return y_buffer.shape[0]
