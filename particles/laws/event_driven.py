r"""Drift with collisions one at a time, in order: any restitution e >= 0.

Within a step points fly freely, y(t) = y + v t, so neighbours meet at t = (y' - y)/(v - v'). The
drift finds the contact that closes first. The velocities of its two rods change by

    v - v' -> -e (v - v')      at constant momentum (eq. ``eq:rest`` of the paper),

and at most three contacts get a new time. A collision costs O(log L). If contacts close at the same
time, the one with the larger closing speed is taken first, which makes the operator symmetric under
reflection. If the speeds are equal too, the left one is taken first.

**A knockout tournament** finds the contact that closes first. The contacts are the leaves of a
binary tree, and every node above them holds the earlier one of its two children, so that the root
holds the next collision. Node k has the children 2k and 2k + 1, the root is node 1, and contact c
is leaf L - 1 + c. A collision changes three leaves, which climb to the root together: the first
one until it meets the path of the second one, and so on. A heap needs as many comparisons, but its
next step depends on their outcomes, which a processor cannot predict. In the tournament the
comparisons only select numbers.

**Inelastic collapse.** For e < 1 neighbours may collide infinitely often in a finite time. If the
speed of separation e |v - v'| would be below ``merge_speed``, the two become a *cluster* that
moves as one until the end of the drift, with the mean velocity of its members and as many masses.
Every collision that does not merge then costs at least (1 - e^2)/(4 e^2) m merge_speed^2 of
energy, so the number of events is finite. ``merge_speed`` is a small fraction of the
velocity kick that the noise gives in one step; results do not depend on it.

**Resting contacts.** For e > 1 rods that touch at the beginning of a step collide as at e = 1.

**Positions at the beginning of the step.** y holds the position that a point with its present
velocity would have had at t = 0. A collision at t changes y by (v_before - v_after) t, and no point
has to be moved before the end of the step.

The state of a cluster is stored at its outermost members, the only ones with contacts to others.

**Springs that differ.** With a gap the velocities of two rods that meet are corrected for what
their springs have not given them yet (``springs_ahead.py``). Clusters are left out, because they
dissipate much more than the correction is worth.
"""

import numpy as np

from crazybilliards.model.kernels import inlined, kernel
from crazybilliards.particles.laws.avalanche import record_collision
from crazybilliards.particles.laws.impacts import record_impact
from crazybilliards.particles.laws.springs_ahead import springs_ahead

# With unsigned indices compiled code need not check for indices from the end of an array.
INDEX = np.uint64
_0, _1 = INDEX(0), INDEX(1)


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


@kernel
def _climb(node, until, due, winner, v):  # type: ignore[no-untyped-def]
    """Decide the nodes above ``node`` again, until its path meets the path of node ``until``.

    0 stands for the root. The path of ``until`` finds the last node decided here as an opponent.
    """
    # Compiled code counts references to the arrays that a helper receives, which would take most of
    # the time. It does not do so for a helper as simple as this one, a loop that calls nothing.
    time = due[node]
    while node > _1 and node ^ until > _1:
        opponent = node ^ _1
        other_time = due[opponent]
        first = node ^ INDEX(other_time < time)
        # True for equal times (or nearly equal ones, by underflow). Two infinities are not equal
        # here, because their difference is NaN. A comparison that is rarely true costs nothing.
        difference = other_time - time
        if difference * difference <= 0.0:
            a, b = INDEX(winner[node]), INDEX(winner[opponent])
            speed_a, speed_b = v[a] - v[a + _1], v[b] - v[b + _1]
            faster = speed_b > speed_a or (speed_b == speed_a and b < a)
            first = node ^ INDEX(other_time < time or (other_time == time and faster))
        time = other_time if other_time < time else time
        node, until = node >> _1, until >> _1
        due[node], winner[node] = time, winner[first]


@kernel
def _finish(y, v, dt, last, clusters):  # type: ignore[no-untyped-def]
    """Move the rods to the end of the step, and record those that are in contact."""
    a = number = 0
    while a < y.size:
        b = last[a]
        position = y[a] + dt * v[a]
        if a > 0 and position < y[a - 1]:
            position = y[a - 1]
        y[a] = position
        if b > a:
            clusters.firsts[number], clusters.lasts[number] = a, b + 1
            number += 1
            for i in range(a + 1, b + 1):
                y[i] = position
                v[i] = v[a]
        a = b + 1
    clusters.number[0] = number


@kernel
def drift(  # type: ignore[no-untyped-def]
    y,
    v,
    dt,
    restitution,
    merge_speed,
    most,
    anchors,
    pull,
    exponent,
    scratch,
    tally,
):
    """Advance ``y`` and ``v`` in place by ``dt``; return the collisions, or -1 if too many.

    ``pull`` is k/m if the springs of rods that meet may differ and are kicked in halves, else 0.
    ``scratch.clusters`` records the rods that are in contact at the end, and ``tally`` (an
    ``avalanche.Tally``) every collision. The drift stops after ``most`` collisions. The chain then
    counts as diverged, and its state must not be used.
    """
    contacts = INDEX(y.size - 1)
    first, last = scratch.integers[0], scratch.integers[1]
    # The tournament: the winner at each node, and the time at which its contact closes.
    winner, due = scratch.winner, scratch.due
    tallied = tally.contacts.size + tally.pushes.heads.size + tally.triggered.heads.size > 0
    summed = tally.impacts.size > 0
    for i in range(y.size):
        first[i] = i
        last[i] = i
    # A single rod has no contact for the root. If the leaves have two depths, the first ones climb
    # past nodes that are decided only later.
    for node in range(2 * y.size):
        due[node] = np.inf
    for contact in range(contacts):
        closing, gap = v[contact] - v[contact + _1], y[contact + _1] - y[contact]
        due[contacts + contact] = _meeting(closing, gap, 0.0, dt)
        winner[contacts + contact] = contact
    leaves = contacts + contacts
    for leaf in range(contacts, leaves):
        _climb(leaf, leaf + _1 if leaf + _1 < leaves else _0, due, winner, v)
    collisions = 0
    while due[1] < np.inf:
        now, contact = due[1], INDEX(winner[1])
        collisions += 1
        if collisions > most:
            return -1
        neighbour = contact + _1
        a, b = INDEX(first[contact]), INDEX(last[neighbour])
        left, right = float(neighbour - a), float(b - contact)
        v_left, v_right = v[contact], v[neighbour]
        if tallied:
            record_collision(np.int64(contact), np.int64(a), np.int64(b), v_left, v_right, tally)
        # The common velocity of the cluster or pair, computed as a change of v_left.
        common = v_left + (v_right - v_left) * right / (left + right)
        # Flippers act when rods meet. Otherwise rods at rest in contact, such as those at the
        # start, would exchange one kick again and again at the same time and gain energy without
        # bound.
        ahead = 0.0
        if pull > 0.0 and a == contact and b == neighbour:
            here = y[contact] + v_left * now
            displacements = here - anchors[contact], here - anchors[neighbour]
            ahead = springs_ahead(*displacements, pull, exponent, now - dt / 2)
        closing = v_left - v_right - ahead
        rebound = (min(restitution, 1.0) if now == 0.0 else restitution) * closing
        if summed:
            separating = rebound if rebound > merge_speed else 0.0
            indices = np.int64(contact), np.int64(a), np.int64(b)
            record_impact(*indices, closing, separating, tally.impacts)
        if rebound <= merge_speed:
            y_common = y[contact] + (v_left - common) * now
            first[b] = a
            last[a] = b
            v[a] = v[b] = common
            y[a] = y[b] = y_common
            # From here on v of the inner members is outdated; their contact never closes again.
            v[contact] = v[neighbour] = common
            y[contact] = y[neighbour] = y_common
        else:
            rebound = max(rebound - ahead, 0.0)  # no rod passes another
            new_left = common - rebound * right / (left + right)
            new_right = common + rebound * left / (left + right)
            y_left = y[contact] + (v_left - new_left) * now
            y_right = y[neighbour] + (v_right - new_right) * now
            v[a] = v[contact] = new_left
            y[a] = y[contact] = y_left
            v[b] = v[neighbour] = new_right
            y[b] = y[neighbour] = y_right
        # The two now separate or form one cluster.
        low = high = leaf = contacts + contact
        due[leaf] = np.inf
        if a > _0:
            low = contacts + a - _1
            due[low] = _meeting(v[a - _1] - v[a], y[a] - y[a - _1], now, dt)
        if b < contacts:
            high = contacts + b
            due[high] = _meeting(v[b] - v[b + _1], y[b + _1] - y[b], now, dt)
        _climb(low, leaf, due, winner, v)
        _climb(leaf, high, due, winner, v)
        _climb(high, _0, due, winner, v)
    _finish(y, v, dt, last, scratch.clusters)
    return collisions
