r"""Two walls, between which the rods move.

In the reduced coordinate all rods have the same room, from ``low`` to ``high``. Collisions one at a
time (``event_driven.py``) take a wall as one more rod at each end (``unequal.py``). Rods that merge
with a wall rest at it until the end of the step.

**Elastic rods of equal mass** pass through each other and swap names (``sort.py``). If their
springs have one anchor, or if there are none, each is alone with the walls.

* Without springs the free motion, with noise and damping, has the same law when it is seen in a
  mirror. The motion between two mirrors is therefore the free one, folded (``fold``), at any step.
* A flight on linear springs turns (y, v/w0), w0 = sqrt(k/m), on a circle, and a wall reflects the
  circle. ``turn`` is this flight, exactly. It keeps the Gibbs measure, as damping and noise before
  and after it do, so the steady state is right at any step. Without springs the flight is straight.
"""

import numpy as np

from crazybilliards.model.kernels import copy, inlined, kernel
from crazybilliards.particles.laws import event_driven


@inlined(once=True)
def drift(y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` by ``dt``, one collision after the other; return their number."""
    n = y.size
    places, speeds, ties = scratch.floats[0], scratch.floats[1], scratch.floats[2]
    places[0] = ties[0] = law.low
    places[n + 1] = ties[n + 1] = law.high
    speeds[0] = speeds[n + 1] = 0.0
    rods_y, rods_v = places[1 : n + 1], speeds[1 : n + 1]
    copy(y, rods_y)
    copy(v, rods_v)
    copy(anchors, ties[1 : n + 1])
    collisions = event_driven.drift(places, speeds, ties, dt, law, scratch, tally)
    copy(rods_v, v)
    for i in range(n):
        y[i] = min(max(rods_y[i], law.low), law.high)
    return collisions


@kernel
def fold(y, v, low, high):  # type: ignore[no-untyped-def]
    """Put points that have passed through the walls to where mirrors at the walls show them."""
    room = high - low
    for i in range(y.size):
        turns = np.floor((y[i] - low) / room)
        inside = min(max(y[i] - turns * room, low), high)
        if turns % 2.0 == 1.0:
            y[i], v[i] = low + (high - inside), -v[i]
        else:
            y[i] = inside


@inlined
def _strike(flips, momentum, moves_right, struck):  # type: ignore[no-untyped-def]
    """Add the impulses of a point that meets the walls in turn to what the walls have received."""
    if struck.size > 0 and flips * momentum > 0.0:  # a point at rest at a wall does not meet it
        first = np.ceil(flips / 2.0)
        side = 1 if moves_right else 0
        struck[0, side] += 2.0 * momentum * first
        struck[1, side] += first
        struck[0, 1 - side] += 2.0 * momentum * (flips - first)
        struck[1, 1 - side] += flips - first


@kernel
def turn(y, v, dt, pull, low, high, struck):  # type: ignore[no-untyped-def]
    """Move points on linear springs to y = 0, each alone with two elastic walls at -+ ``high``."""
    if pull == 0.0:
        for i in range(y.size):
            y[i] += dt * v[i]
            turns = np.floor((y[i] - low) / (high - low))
            _strike(np.abs(turns), np.abs(v[i]), v[i] > 0.0, struck)
        fold(y, v, low, high)
        return
    rate = np.sqrt(pull)
    angle = rate * dt
    for i in range(y.size):
        speed = v[i] / rate
        radius = np.hypot(y[i], speed)
        phase = np.arctan2(-speed, y[i])  # y = radius cos(phase)
        if radius > high:
            # y = high and low are at the phases -+ edge and pi -+ edge. A wall skips 2 edge.
            edge = np.arccos(high / radius)
            flight = np.pi - 2.0 * edge
            start = edge - np.pi if speed > 0.0 else edge
            passed = max(phase - start, 0.0) + angle
            flips = np.floor(passed / flight)
            phase = start + (passed - flips * flight) + flips * np.pi
            _strike(flips, rate * radius * np.sin(edge), speed > 0.0, struck)
        else:
            phase += angle
        y[i] = min(max(radius * np.cos(phase), low), high)
        v[i] = -rate * radius * np.sin(phase)
