r"""Time stepping: kicks (spring, damping, noise) alternate with drifts (flight and collisions).

**splitting** (default). A step of length dt consists of

1. exact Ornstein-Uhlenbeck update over half the step, v <- c v + sqrt((T/m)(1 - c^2)) xi with
   c = exp(-gamma dt/2m),
2. half a spring kick, v <- v - (dt/2m) F(d),
3. drift with collisions,
4. half a spring kick,
5. the same as 1.

The scheme is symmetric in time and therefore of second order, in transients too. Part 5 of a step
and part 1 of the next are done as one over dt, with one draw of noise per step. Parts 2-4 are the
symplectic Verlet scheme, and 1 and 5 leave a Maxwellian unchanged. A linear chain without a gap
therefore has exactly the right velocity width at any dt, and <d^2> = (T/k)/(1 - (w0 dt/2)^2).

**euler** (the paper's, eq. ``eq:discrete``). v <- v + (dt/m)(-F(d) - gamma v) + (A/m) sqrt(dt) xi,
then the drift. It is of first order: a free rod without a spring has
W^2 = (T/m)/(1 - gamma dt/2m).
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain, spring
from crazybilliards.model.kernels import copy, inlined, kernel
from crazybilliards.particles.exact_flight import Propagator, fly, make_propagator
from crazybilliards.particles.laws.closed_contacts import (
    CLOSED_KICK,
    CRITICAL_RESTITUTION,
    find_clusters,
    second_half,
    strengthen,
)
from crazybilliards.particles.laws.law import EXACT, Law, Method, drift, make_law
from crazybilliards.particles.noise import Noise, fill, make_noise
from crazybilliards.particles.scales import spring_rate

# In velocity kicks of one step: rods that separate more slowly move as one. Below the critical
# restitution a larger threshold adds energy, because the noise of closed contacts is stronger.
_MERGING, _MERGING_OF_CLOSED = 0.1, 0.03

Stepper = Literal["splitting", "euler"]

FIRST, WHOLE, LAST = range(3)  # parts of a kick

_pull = inlined(spring.force)


class Step(NamedTuple):
    """The plain numbers of the chain and the scheme that a kernel needs."""

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
    """Everything that the kernels need of a run; it is the same for all replicas."""

    anchors: NDArray[np.float64]  # reduced, (L,)
    step: Step
    law: Law
    propagator: Propagator  # of a step, if the law is EXACT
    fastest: float  # with a faster rod the chain has diverged


def make_dynamics(
    chain: Chain,
    time_step: float,
    *,
    speed: float,
    method: Method = "event-driven",
    stepper: Stepper = "splitting",
    merging: float | None = None,
    counted: bool = False,
    diverged: float = 1e6,
) -> Dynamics:
    """Return the numbers and arrays that the kernels need of a chain.

    Parameters
    ----------
    chain, time_step, method, stepper, merging
        As in ``simulate``.
    speed
        A typical speed of the rods [R/T].
    counted
        Whether every collision is to be recorded at its contact.
    diverged
        Speed, in typical speeds, from which on the chain counts as diverged. In the steady
        states for e > 1 rods reach some tens of typical speeds.
    """
    return Dynamics(
        chain.reduced_anchors,
        make_step(chain, time_step, stepper, method),
        make_law(
            chain,
            time_step,
            method,
            default_merging(chain) if merging is None else merging,
            speed,
            counted=counted,
            halves=stepper == "splitting",
        ),
        make_propagator(chain, time_step),
        diverged * speed if speed > 0 else math.inf,
    )


def default_merging(chain: Chain) -> float:
    """Return the threshold of merging at this restitution, in velocity kicks of one step."""
    return _MERGING_OF_CLOSED if chain.restitution < CRITICAL_RESTITUTION else _MERGING


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
    # Contact Dynamics has no correction, as in the paper.
    sticking = chain.restitution < CRITICAL_RESTITUTION and method == "event-driven"
    strength = CLOSED_KICK if sticking else 1.0
    outer_strength = second_half(strength, outer[0])
    return Step(time_step, *inner, *outer, full_kick / 2, exponent, True, strength, outer_strength)


def start_noise(stream: np.random.SeedSequence, dynamics: Dynamics) -> Noise:
    """Return the noise that drives one copy of the chain, from its own random numbers.

    White noise remembers nothing, so it is the same for every chain. Noise with a memory of each
    rod would be made here from ``dynamics``, and :func:`draw_kicks` would correlate it.
    """
    return make_noise(stream)


def longest_step(chain: Chain, stepper: Stepper) -> float:
    """Return the limit of stability: with longer steps the energy of a rod grows without bound.

    It is 2/w0 for the splitting and 4/(g + sqrt(g^2 + 4 w0^2)), g = gamma/m, for euler. It is
    infinite for a quadratic spring without damping, which has no rate. Such a run may diverge.
    """
    if chain.spring == "quadratic" and math.isinf(chain.temperature):
        return math.inf
    rate = spring_rate(chain)
    damping = chain.damping / chain.mass if stepper == "euler" else 0.0
    slowest = damping + math.hypot(damping, 2 * rate)
    return 4 / slowest if slowest > 0 else math.inf


def _ornstein_uhlenbeck(chain: Chain, duration: float) -> tuple[float, float]:
    """Return the exact decay and noise of the velocity under damping and noise alone."""
    rate = 2 * chain.damping * duration / chain.mass
    # (1 - c^2)/rate -> 1 without damping: the noise alone, variance A^2 dt/m^2.
    share = -math.expm1(-rate) / rate if rate > 0 else 1.0
    return math.exp(-rate / 2), chain.amplitude / chain.mass * math.sqrt(duration * share)


@kernel
def kick(y, v, anchors, kicks, step, part):  # type: ignore[no-untyped-def]
    """Kick the rods by spring, damping and noise; ``kicks``: normal numbers, shape (L,).

    ``part`` is FIRST for a first half kick (or for a whole one in a scheme without halves), WHOLE
    for the second half of a step merged with the first of the next, LAST for a second half.
    """
    decay = step.decay if part == WHOLE else step.outer_decay
    noise = step.noise if part == WHOLE else step.outer_noise
    before = 0.0 if part == FIRST else 1.0
    after = 0.0 if part == LAST else 1.0
    for i in range(y.size):
        pull = step.kick * _pull(y[i] - anchors[i], step.exponent)
        v[i] = decay * (v[i] - before * pull) - after * pull + noise * kicks[i]


@kernel
def draw_kicks(noise, kicks, width, due):  # type: ignore[no-untyped-def]
    """Fill ``kicks`` for as many of the ``due`` steps of ``width`` numbers as have room.

    Return for how many. Several are drawn at once, because one by one is slower.
    """
    rows = min(kicks.size // width, due)
    fill(noise, kicks[: rows * width])
    return rows


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
    return drift(y, v, dynamics.anchors, step.time_step, dynamics.law, scratch, tally)


@inlined
def _fly(y, v, noise, dynamics, scratch, steps):  # type: ignore[no-untyped-def]
    """Take steps of a chain whose motion is known exactly; collisions are not counted."""
    width, row, rows = 2 * y.size, 0, 0
    for taken in range(steps):
        if row == rows:
            row, rows = 0, draw_kicks(noise, scratch.kicks, width, steps - taken)
        kicks = scratch.kicks[row * width : (row + 1) * width]
        fly(y, v, kicks, dynamics.propagator, scratch)
        row += 1
    return 0


@inlined
def _step(y, v, noise, dynamics, scratch, tally, steps):  # type: ignore[no-untyped-def]
    """Take steps of kicks and drifts."""
    if steps == 0:
        return 0
    step, size = dynamics.step, y.size
    if step.closed != 1.0:
        find_clusters(y, scratch.clusters)
    collisions, row, rows = 0, 0, 0
    # The second half kick of a step is merged into the first one of the next.
    part = FIRST
    due = steps + 1 if step.symmetric else steps
    for taken in range(due):
        if row == rows:
            row, rows = 0, draw_kicks(noise, scratch.kicks, size, due - taken)
        if taken == steps:
            part = LAST
        kicks = scratch.kicks[row * size : (row + 1) * size]
        met = take_step(y, v, kicks, part, dynamics, scratch, tally)
        if met < 0:
            return -1
        row += 1
        collisions += met
        if step.symmetric:
            part = WHOLE
    tally.collisions[0] += collisions
    return collisions


@inlined
def _advance(y, v, noise, dynamics, scratch, tally, steps):  # type: ignore[no-untyped-def]
    if dynamics.law.operator == EXACT:
        return _fly(y, v, noise, dynamics, scratch, steps)
    return _step(y, v, noise, dynamics, scratch, tally, steps)


@kernel
def advance(y, v, noise, dynamics, scratch, tally, steps):  # type: ignore[no-untyped-def]
    """Take ``steps`` steps of the chain in place; return the collisions, or -1 if diverged.

    ``y`` and ``v`` are float arrays of shape (L,) in the reduced coordinate. ``noise`` is a stream
    for this thread alone (``noise.py``). For ``scratch`` see ``laws/law.py``, for ``tally``
    ``laws/avalanche.py``.
    """
    return _advance(y, v, noise, dynamics, scratch, tally, steps)


@kernel
def bounded(y, v, fastest):  # type: ignore[no-untyped-def]
    """Return whether all values are finite and no rod is faster than ``fastest``."""
    for i in range(y.size):
        if not (abs(v[i]) <= fastest and abs(y[i]) < np.inf):
            return False
    return True


@inlined
def _keep(source, target, tally):  # type: ignore[no-untyped-def]
    """Copy what ``tally`` records of collisions, from or to the scratch space."""
    for contact in range(tally.contacts.size):
        target.contacts[contact] = source.contacts[contact]
    for row in range(tally.impacts.shape[0]):
        for contact in range(tally.impacts.shape[1]):
            target.impacts[row, contact] = source.impacts[row, contact]


@kernel
def record(  # type: ignore[no-untyped-def]
    y, v, noise, dynamics, scratch, tally, stride, y_buffer, v_buffer
):
    """Fill the buffers, shape (snapshots, L), with the state after every ``stride`` steps.

    Return the number of valid snapshots. It is smaller than the buffers if the chain diverged,
    because a drift had too many collisions or a rod became too fast. The counted collisions are
    then those up to the last valid snapshot, because diverging steps may have had a million.
    """
    _keep(tally, scratch, tally)
    for snapshot in range(y_buffer.shape[0]):
        met = _advance(y, v, noise, dynamics, scratch, tally, stride)
        if met < 0 or not bounded(y, v, dynamics.fastest):
            _keep(scratch, tally, tally)
            return snapshot
        _keep(tally, scratch, tally)
        copy(y, y_buffer[snapshot])
        copy(v, v_buffer[snapshot])
    return y_buffer.shape[0]
