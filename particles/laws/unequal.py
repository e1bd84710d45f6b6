r"""Collisions of rods of unequal masses, and of rods with a wall.

A wall is a rod of infinite mass at rest, without a spring. In a collision of two rods or clusters
with the inverse masses w and w' (0 for a wall, and for a cluster that rests at one), the left one
takes the share w/(w + w') of the change of their relative velocity, and the right one the rest. The
reduced mass is 1/(w + w'), and rods that merge have the inverse mass w w'/(w + w'). The springs of
the two give different accelerations (``spring_correction.py``), also without a gap. Masses are in
units of the first rod's. The threshold below which two rods merge is in kicks of the noise, so it
is in proportion to the mean of the inverse masses of the two.

**Rods that rest at a wall** stay there when another rod hits them, as part of the wall. The rod
that flies in rebounds with a restitution of its own (``row_restitution``).
"""

import numpy as np

from crazybilliards.model.kernels import INDEX, kernel
from crazybilliards.particles.laws import impacts as rows
from crazybilliards.particles.laws.avalanche import record_collision
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION
from crazybilliards.particles.laws.spring_correction import springs_ahead

_0, _1 = INDEX(0), INDEX(1)


@kernel
def collide(contact, a, b, now, y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Let two rods or clusters collide as ``event_driven`` says; return whether they merge.

    The rods ``a`` and ``b`` are the outermost ones of the two. Between walls the first and the last
    rod are the walls.
    """
    single, joint, neighbour = scratch.inverse, scratch.joint, contact + _1
    w, w_right = joint[contact], joint[neighbour]
    v_left, v_right = v[contact], v[neighbour]
    ahead = 0.0
    alike = w == w_right and anchors[contact] == anchors[neighbour]
    if law.pull > 0.0 and a == contact and b == neighbour and not alike:
        place, since = y[contact] + v_left * now, now - dt / 2
        ahead = springs_ahead(place - anchors[contact], 0.0, law.pull * w, law.exponent, since)
        right = law.pull * w_right
        ahead += springs_ahead(0.0, place - anchors[neighbour], right, law.exponent, since)
    wall = single[contact] == 0.0 or single[neighbour] == 0.0
    at_wall = w * w_right == 0.0
    e = law.wall_restitution if wall else law.row_restitution if at_wall else law.restitution
    e = min(e, 1.0) if now == 0.0 else e
    closing = v_left - v_right - ahead
    rebound = e * closing
    least = law.merge_speed * 0.5 * (single[contact] + single[neighbour])
    least = least if e < 1.0 or at_wall else 0.0
    merges = rebound <= least or (rebound <= ahead and e < 1.0)
    apart = 0.0 if merges else max(rebound - ahead, 0.0)  # no rod passes another
    change = v_left - v_right + apart
    if tally.contacts.size + tally.impacts.size + tally.struck.size > 0:
        true = closing, 0.0 if merges else rebound
        _record(contact, a, b, true, change, v_left, v_right, scratch, tally)
    share, other_share = w / (w + w_right), w_right / (w + w_right)
    # Each from its own velocity: that of a heavy rod must not get the rounding of a light one's.
    new_left, new_right = v_left - share * change, v_right + other_share * change
    if apart == 0.0:
        new_left = new_right = new_left if share < other_share else new_right
    y_left = y_right = y[contact] + (v_left - new_left) * now
    if not merges:
        y_right = y[neighbour] + (v_right - new_right) * now
    else:
        joint[a] = joint[b] = share * w_right
        if at_wall:  # without rounding, because rods that rest at a wall are known by their place
            y_left = y_right = law.low if w == 0.0 else law.high
    v[a] = v[contact] = new_left
    v[b] = v[neighbour] = new_right
    y[a] = y[contact] = y_left
    y[b] = y[neighbour] = y_right
    return merges


@kernel
def _record(contact, a, b, true, change, v_left, v_right, scratch, tally):  # type: ignore[no-untyped-def]
    """Count a collision at its contact or wall, and add up what it exchanges and takes.

    A wall receives all that the ``change`` of the relative velocity takes from the rods. It is not
    that of the ``true`` one where springs press a rod that stays there.
    """
    closing, separating = true
    single, joint, neighbour = scratch.inverse, scratch.joint, contact + _1
    w, w_right = joint[contact], joint[neighbour]
    at_wall = single[contact] == 0.0 or single[neighbour] == 0.0
    mass = 1.0 / (w + w_right)
    if tally.struck.size > 0 and w * w_right == 0.0:
        side = 0 if w == 0.0 else 1
        tally.struck[0, side] += mass * change
        tally.struck[1, side] += 1.0 if at_wall else 0.0
    before = INDEX(1) if single[_0] == 0.0 else _0  # contacts with the left wall
    if tally.contacts.size > 0 and not at_wall:
        own = np.int64(contact - before)
        record_collision(own, np.int64(a - before), np.int64(b - before), v_left, v_right, tally)
        if tally.speeds.counts.size > 0:
            rows.record_speed(own, closing, tally.speeds)
    if tally.impacts.size > 0:
        _record_impact(contact, a, b, mass, closing, separating, before, scratch, tally.impacts)


@kernel
def _record_impact(contact, a, b, mass, closing, separating, before, scratch, impacts):  # type: ignore[no-untyped-def]
    """Add what a collision exchanges at every contact of its two clusters; see ``impacts.py``.

    Rods beyond a contact get their share of the mass of the cluster of the impulse, and all of it
    if a wall is among them.
    """
    single, joint = scratch.inverse, scratch.joint
    beyond = 0.0
    for other in range(np.int64(a), np.int64(b)):
        beyond += 1.0 / single[other] if single[other] > 0.0 else 0.0
        if other == contact:
            share, beyond = 1.0, 0.0
        elif other < contact:
            share = beyond * joint[contact] if joint[contact] > 0.0 else 1.0
        else:
            share = 1.0 - beyond * joint[contact + _1]
        own = other - np.int64(before)
        if 0 <= own < impacts.shape[1]:
            impacts[rows.MOMENTUM_BEFORE, own] += share * mass * closing
            impacts[rows.MOMENTUM_AFTER, own] += share * mass * separating
    if single[contact] > 0.0 and single[contact + _1] > 0.0:
        own = np.int64(contact - before)
        impacts[rows.ENERGY_BEFORE, own] += mass * closing * closing / 2
        impacts[rows.ENERGY_AFTER, own] += mass * separating * separating / 2


@kernel
def strengthen(kicks, y, strength, law, scratch):  # type: ignore[no-untyped-def]
    """Do as ``closed_contacts.strengthen`` with unequal masses; at a wall the mean is 0."""
    clusters, before = scratch.clusters, 1 if law.high < np.inf else 0
    for k in range(clusters.number[0]):
        first, last = clusters.firsts[k], clusters.lasts[k]
        rests = y[first] == law.low or y[first] == law.high
        if not rests and law.restitution >= CRITICAL_RESTITUTION:
            continue
        total = mass = 0.0
        for i in range(first, last):
            total += kicks[i]
            mass += 1.0 / scratch.inverse[i + before]
        mean = 0.0 if rests else total / mass
        for i in range(first, last):
            own = mean / scratch.inverse[i + before]
            kicks[i] = own + strength * (kicks[i] - own)


def row_restitution(e: float, e_wall: float) -> float:
    """Return the restitution of a rod that hits one at rest at a wall.

    The two collide with e, the other one meets the wall with e_wall, and so on until they separate.
    Where neither is 1 the rod at the wall keeps a small velocity, which is left out.
    """
    rod, other = 1.0, 0.0  # velocities towards the wall
    while rod - other > 1e-9:
        common, change = (rod + other) / 2, e * (rod - other) / 2
        rod, other = common - change, common + change
        other = -e_wall * other if other > 0 else other
    return max(-rod, 0.0)
