r"""Time stepping: kicks (spring, damping, noise) alternating with drifts that hold the collisions.

**splitting** (default). Per step of length dt

1. exact Ornstein-Uhlenbeck update over half the step, v <- c v + sqrt((T/m)(1 - c^2)) xi with
   c = exp(-gamma dt/2m),
2. half a spring kick, v <- v - (dt/2m) F(d),
3. drift with collisions,
4. half a spring kick,
5. as 1.

Symmetric in time, hence of second order, in transients too. Number 5 of a step and number 1 of
the next are drawn as one, over dt: one noise draw per step. Steps 2-4 are the symplectic Verlet
scheme and 1 and 5 leave every Maxwellian unchanged, so a linear chain without gap has exactly
the right velocity width at any dt, and <d^2> = (T/k)/(1 - (w0 dt/2)^2).

**euler** (the paper's, eq. ``eq:discrete``). v <- v + (dt/m)(-F(d) - gamma v) + (A/m) sqrt(dt) xi,
then the drift. First order: a free rod without spring has W^2 = (T/m)/(1 - gamma dt/2m).
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain, spring
from crazybilliards.model.kernels import inlined, kernel
from crazybilliards.particles.laws.closed_contacts import (
    CLOSED_KICK,
    CRITICAL_RESTITUTION,
    find_clusters,
    second_half,
    strengthen,
)
from crazybilliards.particles.laws.law import Law, Method, drift, make_law
from crazybilliards.particles.noise import fill
from crazybilliards.particles.scales import spring_rate

MERGING = 0.03  # in velocity kicks of one step: rods that separate more slowly move as one

Stepper = Literal["splitting", "euler"]

FIRST, WHOLE, LAST = range(3)  # parts of a kick

_pull = inlined(spring.force)


class Step(NamedTuple):
    """What a kernel needs to know of the chain and the scheme: plain numbers."""

    time_step: float
    decay: float  # factor on v from the damping
    noise: float  # standard deviation of the velocity kick
    outer_decay: float  # the same for the first kick of successive steps (and the last one)
    outer_noise: float
    kick: float  # velocity kick per unit of F/k, one half of it for the splitting
    exponent: int  # of the spring's potential
    symmetric: bool  # splitting: half kicks of spring and noise after the drift
    closed: float  # strength of the noise that opens closed contacts; 1: as all other noise
    closed_outer: float  # the same for the half kick after a snapshot


class Dynamics(NamedTuple):
    """All that the kernels need to know of a run: the same for all replicas."""

    anchors: NDArray[np.float64]  # reduced, (L,)
    step: Step
    law: Law
    fastest: float  # a rod that is faster has left every steady state: the chain has diverged


def make_dynamics(
    chain: Chain,
    time_step: float,
    *,
    speed: float,
    method: Method = "event-driven",
    stepper: Stepper = "splitting",
    merging: float = MERGING,
    counted: bool = False,
    diverged: float = 1e6,
) -> Dynamics:
    """Return what the kernels need to know of a chain.

    Parameters
    ----------
    chain, time_step, method, stepper, merging
        As in ``simulate``.
    speed
        A typical speed of the rods [R/T].
    counted
        Whether every collision is to be recorded at its contact.
    diverged
        In typical speeds: a chain with a faster rod has diverged. The steady states of e > 1 stay
        within some tens of them.
    """
    return Dynamics(
        chain.reduced_anchors,
        make_step(chain, time_step, stepper, method),
        make_law(chain, time_step, method, merging, speed, counted=counted),
        diverged * speed if speed > 0 else math.inf,
    )


def make_step(
    chain: Chain, time_step: float, stepper: Stepper, method: Method = "event-driven"
) -> Step:
    """Return the numbers of one step of the chain under the named scheme."""
    m, gamma = chain.mass, chain.damping
    full_kick = chain.stiffness * time_step / m
    exponent = chain.potential_exponent
    if stepper == "euler":
        decay = 1 - gamma * time_step / m
        noise = chain.amplitude / m * math.sqrt(time_step)
        return Step(time_step, decay, noise, decay, noise, full_kick, exponent, False, 1.0, 1.0)
    inner, outer = (_ornstein_uhlenbeck(chain, duration) for duration in (time_step, time_step / 2))
    # Contact Dynamics is left as the paper describes it.
    sticking = chain.restitution < CRITICAL_RESTITUTION and method == "event-driven"
    strength = CLOSED_KICK if sticking else 1.0
    outer_strength = second_half(strength, outer[0])
    return Step(time_step, *inner, *outer, full_kick / 2, exponent, True, strength, outer_strength)


def longest_step(chain: Chain, stepper: Stepper) -> float:
    """Time step from which on a swinging rod gains energy without end, or its damping does.

    2/w0 with the splitting; with euler 4/(g + sqrt(g^2 + 4 w0^2)), g = gamma/m. Infinite for a
    quadratic spring without damping, which has no rate: there the steps show whether it diverges.
    """
    if chain.spring == "quadratic" and math.isinf(chain.temperature):
        return math.inf
    rate = spring_rate(chain)
    damping = chain.damping / chain.mass if stepper == "euler" else 0.0
    slowest = damping + math.hypot(damping, 2 * rate)
    return 4 / slowest if slowest > 0 else math.inf


def _ornstein_uhlenbeck(chain: Chain, duration: float) -> tuple[float, float]:
    """Decay and noise of the velocity under damping and noise alone, exactly."""
    rate = 2 * chain.damping * duration / chain.mass
    # (1 - c^2)/rate -> 1 without damping: the noise alone, variance A^2 dt/m^2.
    share = -math.expm1(-rate) / rate if rate > 0 else 1.0
    return math.exp(-rate / 2), chain.amplitude / chain.mass * math.sqrt(duration * share)


@kernel
def kick(y, v, anchors, kicks, step, part):  # type: ignore[no-untyped-def]
    """Kick the rods by spring, damping and noise; ``kicks``: normal numbers, shape (L,).

    ``part``: FIRST, a first half, or the whole of a step without halves; WHOLE, the second half of
    a step and the first of the next; LAST, a second half.
    """
    decay = step.decay if part == WHOLE else step.outer_decay
    noise = step.noise if part == WHOLE else step.outer_noise
    before = 0.0 if part == FIRST else 1.0
    after = 0.0 if part == LAST else 1.0
    for i in range(y.size):
        pull = step.kick * _pull(y[i] - anchors[i], step.exponent)
        v[i] = decay * (v[i] - before * pull) - after * pull + noise * kicks[i]


@inlined
def take_step(y, v, kicks, part, dynamics, scratch, tally):  # type: ignore[no-untyped-def]
    """Kick the rods and, unless it was the LAST half, let them drift; changes ``kicks``, (L,).

    Return the collisions, or -1 if the chain diverged.
    """
    step = dynamics.step
    if part == LAST:
        kick(y, v, dynamics.anchors, kicks, step, LAST)
        return 0
    strength = step.closed_outer if part == FIRST else step.closed
    if strength != 1.0:
        strengthen(kicks, scratch.clusters, strength)
    kick(y, v, dynamics.anchors, kicks, step, part)
    return drift(y, v, step.time_step, dynamics.law, scratch, tally)


@kernel
def advance(y, v, noise, dynamics, scratch, tally, steps):  # type: ignore[no-untyped-def]
    """Take ``steps`` steps of the chain in place; return the collisions, or -1 if diverged.

    ``y``, ``v``: float arrays of shape (L,) in the reduced coordinate; ``noise``: a stream of this
    thread's own, see ``noise.py``; ``scratch``: see ``laws/law.py``; ``tally``: see
    ``laws/avalanche.py``.
    """
    if steps == 0:
        return 0
    step, kicks = dynamics.step, scratch.kicks
    if step.closed != 1.0:
        find_clusters(y, scratch.clusters)
    collisions, row, rows = 0, 0, 0
    # The second half kick of a step is merged into the first one of the next.
    part = FIRST
    due = steps + 1 if step.symmetric else steps
    for taken in range(due):
        if row == rows:  # noise for several steps at once
            row, rows = 0, min(kicks.shape[0], due - taken)
            fill(noise, kicks.ravel()[: rows * y.size])
        if taken == steps:
            part = LAST
        met = take_step(y, v, kicks[row], part, dynamics, scratch, tally)
        if met < 0:
            return -1
        row += 1
        collisions += met
        if step.symmetric:
            part = WHOLE
    return collisions


@kernel
def bounded(y, v, fastest):  # type: ignore[no-untyped-def]
    """Whether the state is finite and no rod faster than ``fastest``; false for NaN."""
    for i in range(y.size):
        if not (abs(v[i]) <= fastest and abs(y[i]) < np.inf):
            return False
    return True


@kernel
def record(  # type: ignore[no-untyped-def]
    y, v, noise, dynamics, scratch, tally, stride, y_buffer, v_buffer
):
    """Fill the buffers, shape (snapshots, L), with the state after every ``stride`` steps.

    Return how many snapshots are good: fewer than there is room for if the chain diverged, that
    is, an operator gave up or a rod became too fast. Collisions at the contacts are
    then those up to the last good one: the steps that blew up may have had a million.
    """
    contacts = tally.contacts.copy()
    for snapshot in range(y_buffer.shape[0]):
        met = advance(y, v, noise, dynamics, scratch, tally, stride)
        if met < 0 or not bounded(y, v, dynamics.fastest):
            tally.contacts[:] = contacts
            return snapshot
        contacts[:] = tally.contacts
        y_buffer[snapshot] = y
        v_buffer[snapshot] = v
    return y_buffer.shape[0]
