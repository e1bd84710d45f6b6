r"""Drift with collisions one at a time, in order: any restitution e >= 0.

Within a step points fly freely, y(t) = y + v t, so neighbours meet at t = (y' - y)/(v - v'). The
velocities of the two rods that meet first change by

    v - v' -> -e (v - v')      at constant momentum (eq. ``eq:rest`` of the paper),

and at most three contacts get a new time. If contacts close at the same time, the one with the
larger closing speed is taken first, and of equal speeds the left one.

**A calendar** (``next_contact.py``) finds the contact that closes first. **Rods that touch** at the
beginning collide at time 0, row by row, because rows do not know of each other. Where a row or a
list of the calendar is long, **a tournament** takes over until the end of the
step.

**Inelastic collapse.** For e < 1 neighbours may collide infinitely often in a finite time. If the
speed of separation e |v - v'| would be below ``merge_speed``, or less than what springs are about
to give the two towards each other, they become a *cluster* that moves as one until the end of the
drift, with the mean velocity of its members and as many masses. Its state is stored at its
outermost members. docs/physics/collisions.md has the consequences.

**Positions at the beginning of the step.** y holds the position that a point with its present
velocity would have had at t = 0. A collision at t changes y by (v_before - v_after) t.

With a gap the velocities of two rods that meet, but not of clusters, are corrected for what their
springs have not given them yet (``spring_correction.py``). Unequal masses and walls have a
collision of their own (``unequal.py``): a branch would make the one of equal rods slower.
"""

import numpy as np

from crazybilliards.model.kernels import INDEX, inlined, kernel
from crazybilliards.particles.laws import unequal
from crazybilliards.particles.laws.avalanche import record_collision
from crazybilliards.particles.laws.impacts import record_impact, record_speed
from crazybilliards.particles.laws.next_contact import (
    climb,
    earliest,
    list_due,
    list_of,
    move,
    open_calendar,
    plant,
)
from crazybilliards.particles.laws.spring_correction import springs_ahead

_0, _1 = INDEX(0), INDEX(1)

LONG = 128  # contacts in a row or a list from which on a tournament is quicker
_TOUCHING = 1e-290  # distance from which on a meeting may be at time 0, by underflow


@inlined
def _meeting(closing, gap, now, dt):  # type: ignore[no-untyped-def]
    """Time at which two points meet, at least ``now``; infinity if not within the step.

    The division is always done, because a branch with a random outcome would cost more.
    """
    time = gap / closing
    # Rounding can put a meeting just before the event that caused it.
    time = time if time > now else now
    # Multiplying instead of dividing: no overflow, and false where either is NaN.
    return time if (closing > 0) & (gap < dt * closing) else np.inf


@inlined
def _fastest(begin, end, due, v):  # type: ignore[no-untyped-def]
    """Return the contact of a row that closes fastest among those due at time 0; ``end``: none."""
    fastest, speed = INDEX(end), 0.0
    for contact in range(begin, end):
        closing = v[contact] - v[contact + _1] if due[contact] == 0.0 else 0.0
        fastest = INDEX(contact) if closing > speed else fastest
        speed = closing if closing > speed else speed
    return fastest


@inlined
def _finish(y, v, dt, merged, scratch):  # type: ignore[no-untyped-def]
    """Move the rods to the end of the step, and undo the clusters, if any have merged."""
    first, last = scratch.first, scratch.last
    a = 0
    if not merged:
        for i in range(y.size):
            y[i] += dt * v[i]
        for i in range(1, y.size):
            y[i] = y[i - 1] if y[i] < y[i - 1] else y[i]
        a = y.size
    while a < y.size:
        b = last[a]
        position = y[a] + dt * v[a]
        if a > 0 and position < y[a - 1]:
            position = y[a - 1]
        y[a] = position
        if b > a:
            if scratch.joint.size > 0:
                for i in range(a, b + 1):
                    scratch.joint[i] = scratch.inverse[i]
            for i in range(a + 1, b + 1):
                y[i] = position
                v[i] = v[a]
                first[i] = last[i] = i
            last[a] = a
        a = b + 1


@inlined
def _row_of(contact, y):  # type: ignore[no-untyped-def]
    """Return the first contact of a row of touching rods, and the one after its last."""
    begin, end = contact, contact + _1
    while begin > _0 and y[begin] - y[begin - _1] <= _TOUCHING:
        begin -= _1
    while end < INDEX(y.size - 1) and y[end + _1] - y[end] <= _TOUCHING:
        end += _1
    return begin, end


@inlined
def _part(change, share, other, single):  # type: ignore[no-untyped-def]
    """Return the part of a change with this share. Between single rods no division is needed."""
    return 0.5 * change if single else change * share / (share + other)


@inlined
def _collide(contact, now, y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Let the two rods or clusters at a contact collide at the time ``now``.

    Return the outermost rods of the two, and whether they have become one.
    """
    first, last, neighbour = scratch.first, scratch.last, contact + _1
    a, b = INDEX(first[contact]), INDEX(last[neighbour])
    if law.unequal:
        merges = unequal.collide(contact, a, b, now, y, v, anchors, dt, law, scratch, tally)
        if merges:
            first[b], last[a] = a, b
        return a, b, merges
    left, right = float(neighbour - a), float(b - contact)
    single = (a == contact) & (b == neighbour)
    v_left, v_right = v[contact], v[neighbour]
    # The common velocity of the two, computed as a change of v_left.
    common = v_left + _part(v_right - v_left, right, left, single)
    ahead = 0.0
    if law.pull > 0.0 and single:
        place = y[contact] + v_left * now
        displacements = place - anchors[contact], place - anchors[neighbour]
        ahead = springs_ahead(*displacements, law.pull, law.exponent, now - dt / 2)
    # Flippers act when rods meet. Otherwise rods at rest in contact, such as those at the start,
    # would exchange one kick again and again at the same time and gain energy without bound.
    e = min(law.restitution, 1.0) if now == 0.0 else law.restitution
    closing = v_left - v_right - ahead
    rebound = e * closing
    merges = rebound <= law.merge_speed or (rebound <= ahead and e < 1.0)
    indices = np.int64(contact), np.int64(a), np.int64(b)
    if tally.contacts.size + tally.pushes.heads.size + tally.triggered.heads.size > 0:
        record_collision(*indices, v_left, v_right, tally)
    if tally.impacts.size > 0:
        separating = 0.0 if merges else rebound
        record_impact(*indices, closing, separating, tally.impacts)
    if tally.speeds.counts.size > 0:
        record_speed(contact, closing, tally.speeds)
    if merges:
        first[b], last[a] = a, b
        new_left = new_right = common
        y_left = y_right = y[contact] + (v_left - common) * now
    else:
        rebound = max(rebound - ahead, 0.0)  # no rod passes another
        new_left = common - _part(rebound, right, left, single)
        new_right = common + _part(rebound, left, right, single)
        y_left = y[contact] + (v_left - new_left) * now
        y_right = y[neighbour] + (v_right - new_right) * now
    # Of the inner members of a cluster y and v are outdated: their contacts never close again.
    v[a] = v[contact] = new_left
    v[b] = v[neighbour] = new_right
    y[a] = y[contact] = y_left
    y[b] = y[neighbour] = y_right
    return a, b, merges


@inlined
def _meet_again(contact, a, b, now, y, v, dt, due):  # type: ignore[no-untyped-def]
    """Set when the contacts beside the rods ``a`` to ``b`` close, who have met; return them."""
    low = high = contact
    due[contact] = np.inf  # the two now separate or form one cluster
    if a > _0:
        low = a - _1
        due[low] = _meeting(v[low] - v[a], y[a] - y[low], now, dt)
    if b < INDEX(y.size - 1):
        high = b
        due[high] = _meeting(v[b] - v[b + _1], y[b + _1] - y[b], now, dt)
    return low, high


@inlined
def _collide_touching(y, v, anchors, dt, law, scratch, tally, count):  # type: ignore[no-untyped-def]
    """Let the rods that touch collide at time 0, row by row.

    Return the collisions, whether any rods merged, and whether a row is too long to do so.
    """
    waiting, due, end = scratch.integers[0], scratch.due, _0
    collisions, merged = 0, False
    for k in range(count):
        contact = INDEX(waiting[k])
        if due[contact] != 0.0 or contact < end:
            continue
        begin, end = _row_of(contact, y)
        if end - begin > INDEX(LONG):
            return collisions, merged, True
        contact = _fastest(begin, end, due, v)
        while contact < end and collisions <= min(law.most, scratch.patience[0]):
            rods = _collide(contact, 0.0, y, v, anchors, dt, law, scratch, tally)
            merged |= rods[2]
            collisions += 1
            _meet_again(contact, rods[0], rods[1], 0.0, y, v, dt, due)
            contact = _fastest(begin, end, due, v)
    return collisions, merged, False


@kernel
def drift(y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt``; return the collisions, or -1 if too many.

    ``tally`` (an ``avalanche.Tally``) records every collision. After ``law.most`` of them, or as
    many as ``scratch.patience``, the drift stops, and the state must not be used.
    """
    size, contacts = y.size, INDEX(y.size - 1)
    due, winner = scratch.due, scratch.winner
    following, preceding = scratch.following, scratch.preceding
    leaves = due[contacts:]
    waiting = scratch.integers[0]
    collisions, merged, tree, at_once = 0, False, False, 0
    for i in range(size - 1):
        due[i] = _meeting(v[i] - v[i + 1], y[i + 1] - y[i], 0.0, dt)
        at_once += due[i] == 0.0
    count = list_due(due, size, waiting)
    if at_once > 0:
        collisions, merged, tree = _collide_touching(y, v, anchors, dt, law, scratch, tally, count)
        count = list_due(due, size, waiting)
    if tree:
        plant(size - 1, due, winner, v)
    node, end = INDEX(size), INDEX(size) + count + _1
    scale, parts = open_calendar(dt, due, waiting, count, size, following, preceding)
    while collisions <= min(law.most, scratch.patience[0]):
        if tree:
            contact, now = winner[_1], due[_1]
            if now == np.inf or size == 1:
                break
        else:
            while node < end and following[node] == node:
                node += _1
            if node == end:
                break
            contact, length = earliest(node, following, due, v)
            now = due[contact]
            if length > LONG:
                tree = True
                plant(size - 1, due, winner, v)
                continue
        collisions += 1
        a, b, merges = _collide(contact, now, y, v, anchors, dt, law, scratch, tally)
        merged |= merges
        if tree:
            low, high = _meet_again(contact, a, b, now, y, v, dt, leaves)
            climb(contacts + low, contacts + contact, due, winner, v)
            climb(contacts + contact, contacts + high, due, winner, v)
            climb(contacts + high, _0, due, winner, v)
            continue
        low, high = _meet_again(contact, a, b, now, y, v, dt, due)
        move(contact, contact, following, preceding)
        if low != contact:
            move(low, list_of(low, due[low], scale, size, parts), following, preceding)
        if high != contact:
            move(high, list_of(high, due[high], scale, size, parts), following, preceding)
    too_many = collisions > min(law.most, scratch.patience[0])
    if tree or too_many:
        for node in range(following.size):
            following[node] = preceding[node] = node
    _finish(y, v, dt, merged, scratch)
    return -1 if too_many else collisions
