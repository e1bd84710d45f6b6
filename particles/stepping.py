r"""Time stepping: kicks (spring, damping, noise) alternate with drifts (flight and collisions).

**splitting** (default). A step of length dt consists of

1. exact Ornstein-Uhlenbeck update over half the step, v <- c v + sqrt((T/m)(1 - c^2)) xi with
   c = exp(-gamma dt/2m),
2. half a spring kick, v <- v - (dt/2m) F(d),
3. drift with collisions,
4. half a spring kick,
5. the same as 1.

With collisions in their order it is of second order, in transients too, as long as no rods merge,
and symmetric in time at e = 1. Contact Dynamics makes it of first order. Part 5 of a step and part
1 of the next are done as one over dt. A linear elastic chain without a gap has exactly the right
velocity width at any dt, because 2-4 are the symplectic Verlet scheme, and 1 and 5 leave a
Maxwellian unchanged, and <d^2> = (T/k)/(1 - (w0 dt/2)^2).

**euler** (the paper's, eq. ``eq:discrete``). v <- v + (dt/m)(-F(d) - gamma v) + (A/m) sqrt(dt) xi,
then the drift. It is of first order: a free rod without a spring has
W^2 = (T/m)/(1 - gamma dt/2m).
"""

from collections.abc import Iterable

import numpy as np

from crazybilliards.model import Array, Chain, spring
from crazybilliards.model.grid import deposit
from crazybilliards.model.kernels import copy, inlined, kernel
from crazybilliards.particles.dynamics import Dynamics, make_dynamics
from crazybilliards.particles.laws import unequal
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.closed_contacts import find_clusters, strengthen
from crazybilliards.particles.laws.exact_flight import propagate
from crazybilliards.particles.laws.law import EXACT, ISOTONIC, Scratch, drift, make_scratch
from crazybilliards.particles.laws.sort import sort_pairs
from crazybilliards.particles.laws.walls import fold
from crazybilliards.particles.noise import Noise, fill, make_noise

FIRST, WHOLE, LAST = range(3)  # parts of a kick

_pull = inlined(spring.force)


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


@inlined
def draw_kicks(noise, kicks, width, due):  # type: ignore[no-untyped-def]
    """Fill ``kicks`` for as many of the ``due`` steps of ``width`` numbers as have room.

    Return for how many. One by one is slower.
    """
    rows = min(kicks.size // width, due)
    fill(noise, kicks[: rows * width])
    return rows


@inlined
def take_step(y, v, kicks, part, dynamics, scratch, tally):  # type: ignore[no-untyped-def]
    """Kick the rods and, unless it was the LAST half, let them drift; changes ``kicks``, (L,).

    Return the collisions, or -1 if the chain diverged.
    """
    anchors, step, second, law = dynamics.anchors, dynamics.step, dynamics.second, dynamics.law
    strength = step.closed_outer if part == FIRST else step.closed
    if strength != 1.0 and part != LAST:
        if law.operator != ISOTONIC:  # which has listed them
            find_clusters(y, scratch.clusters, law.low, law.high)
        if law.unequal:
            unequal.strengthen(kicks, y, strength, law, scratch)
        else:
            strengthen(kicks, scratch.clusters, strength)
    if step.decay == second.decay and step.noise == second.noise and step.kick == second.kick:
        kick(y, v, anchors, kicks, step, part)
    else:  # one sort after the other, which takes longer
        kick(y[::2], v[::2], anchors[::2], kicks[::2], step, part)
        kick(y[1::2], v[1::2], anchors[1::2], kicks[1::2], second, part)
    if part == LAST:
        return 0
    return drift(y, v, anchors, step.time_step, law, scratch, tally)


@inlined
def _fly(y, v, noise, dynamics, scratch, steps):  # type: ignore[no-untyped-def]
    """Take steps of a chain whose motion is known exactly; collisions are not counted."""
    width, row, rows, walled = 2 * y.size, 0, 0, dynamics.law.unequal
    for taken in range(steps):
        if row == rows:
            row, rows = 0, draw_kicks(noise, scratch.kicks, width, steps - taken)
        kicks = scratch.kicks[row * width : (row + 1) * width]
        propagate(y, v, kicks, dynamics.propagator)
        if walled:
            fold(y, v, dynamics.law.low, dynamics.law.high)
        sort_pairs(y, v, scratch)
        row += 1


@inlined(once=True)
def _step(y, v, noise, dynamics, scratch, tally, steps):  # type: ignore[no-untyped-def]
    """Take steps of kicks and drifts; return the collisions, or -1 if the chain diverged."""
    if steps == 0:
        return 0
    step, size = dynamics.step, y.size
    if step.closed != 1.0:
        find_clusters(y, scratch.clusters, dynamics.law.low, dynamics.law.high)
    collisions, row, rows = 0, 0, 0
    # The second half kick of a step is merged into the first one of the next.
    due = steps + 1 if step.symmetric else steps
    for taken in range(due):
        if row == rows:
            row, rows = 0, draw_kicks(noise, scratch.kicks, size, due - taken)
        part = FIRST if taken == 0 or not step.symmetric else LAST if taken == steps else WHOLE
        kicks = scratch.kicks[row * size : (row + 1) * size]
        number = take_step(y, v, kicks, part, dynamics, scratch, tally)
        if number < 0:
            return -1
        row += 1
        collisions += number
    return collisions


@kernel
def bounded(y, v, fastest):  # type: ignore[no-untyped-def]
    """Return whether all values are finite and no rod is faster than ``fastest``."""
    for i in range(y.size):
        if not (abs(v[i]) <= fastest and abs(y[i]) < np.inf):
            return False
    return True


@inlined(once=True)
def _copy_records(source, target, tally):  # type: ignore[no-untyped-def]
    """Copy what ``tally`` records of collisions, from or to the scratch space."""
    for contact in range(tally.contacts.size):
        target.contacts[contact] = source.contacts[contact]
    for row in range(tally.impacts.shape[0]):
        for contact in range(tally.impacts.shape[1]):
            target.impacts[row, contact] = source.impacts[row, contact]
    for row in range(tally.struck.shape[0]):
        for wall in range(tally.struck.shape[1]):
            target.struck[row, wall] = source.struck[row, wall]


@kernel
def record_flight(y, v, noise, dynamics, scratch, stride, y_buffer, v_buffer):  # type: ignore[no-untyped-def]
    """Do as ``record`` does, with a chain whose motion is known exactly."""
    for snapshot in range(y_buffer.shape[0]):
        _fly(y, v, noise, dynamics, scratch, stride)
        if not bounded(y, v, dynamics.fastest):
            return snapshot, 0
        copy(y, y_buffer[snapshot])
        copy(v, v_buffer[snapshot])
    return y_buffer.shape[0], 0


@kernel
def record_steps(y, v, noise, dynamics, scratch, tally, stride, y_buffer, v_buffer):  # type: ignore[no-untyped-def]
    """Do as ``record`` does, in steps of kicks and drifts."""
    collisions = 0
    _copy_records(tally, scratch.kept, tally)
    for snapshot in range(y_buffer.shape[0]):
        number = _step(y, v, noise, dynamics, scratch, tally, stride)
        if number < 0 or not bounded(y, v, dynamics.fastest):
            _copy_records(scratch.kept, tally, tally)
            return snapshot, collisions
        _copy_records(tally, scratch.kept, tally)
        collisions += number
        copy(y, y_buffer[snapshot])
        copy(v, v_buffer[snapshot])
    return y_buffer.shape[0], collisions


def record(
    y: Array,
    v: Array,
    noise: Noise,
    dynamics: Dynamics,
    scratch: Scratch,
    tally: Tally,
    stride: int,
    y_buffer: Array,
    v_buffer: Array,
) -> tuple[int, int]:
    """Fill the buffers, shape (snapshots, L), with the state after every ``stride`` steps.

    ``y`` and ``v`` are float arrays of shape (L,) in the reduced coordinate, changed in place.

    Return the number of valid snapshots and the collisions until then, which are 0 where rods are
    sorted. There are fewer snapshots than the buffers have room for if the chain diverged,
    because a drift had too many collisions or a rod became too fast. Contacts and impacts are then
    those up to the last valid snapshot, but avalanches and speeds of impacts include all.
    """
    state = y, v, noise, dynamics, scratch
    if dynamics.law.operator == EXACT:
        return record_flight(*state, stride, y_buffer, v_buffer)
    return record_steps(*state, tally, stride, y_buffer, v_buffer)


def advance(
    y: Array, v: Array, noise: Noise, dynamics: Dynamics, scratch: Scratch, tally: Tally, steps: int
) -> int:
    """Take ``steps`` steps in place as ``record``; return the collisions, or -1 if diverged."""
    last = np.empty((2, 1, y.size))
    valid, collisions = record(y, v, noise, dynamics, scratch, tally, steps, *last)
    return collisions if valid else -1


def compile_kernels(flights: Iterable[bool] = (True, False)) -> None:
    """Compile the kernels, or load them from numba's cache.

    ``flights``: whether the motions of the chains are known exactly, which needs few kernels.
    """
    y, v = np.zeros((2, 2))
    dynamics = make_dynamics(Chain(size=2), 0.1, speed=1.0, counted=True)
    state = y, v, make_noise(np.random.SeedSequence(0)), dynamics, make_scratch(2)
    snapshots = np.zeros((2, 1, 2))
    for exact in set(flights):
        if exact:
            record_flight(*state, 1, *snapshots)
        else:  # counting collisions compiles event_driven.drift and all that the others need
            record_steps(*state, make_tally(2, contacts=True), 1, *snapshots)
    deposit(y, -1.0, 0.1, np.zeros(30))
