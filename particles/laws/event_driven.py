r"""Drift with collisions one at a time, in order: any restitution e >= 0.

Within a step points fly freely, y(t) = y + v t, so neighbours meet at t = (y' - y)/(v - v'). The
earliest meeting is taken from a heap of contacts, the two velocities change by

    v - v' -> -e (v - v')      at constant momentum (eq. ``eq:rest`` of the paper),

and at most three contacts get a new time: O(log L) a collision. Contacts due at the same time are
taken by closing speed, which makes the operator symmetric under reflection.

**Inelastic collapse.** For e < 1 neighbours may collide infinitely often in a finite time. Where
the speed of separation e |v - v'| would be below ``merge_speed``, the two become a *cluster* that
moves as one until the end of the drift, with the mean velocity of its members and as many masses.
Every collision that does not merge then costs at least (1 - e^2)/(4 e^2) m merge_speed^2 of
energy: the number of events is finite for certain. ``merge_speed`` is a small fraction of the
velocity kick that the noise gives in one step; results do not depend on it.

**Resting contacts.** For e > 1 rods that touch at the beginning of a step collide as at e = 1.

**Velocities referred to the step's beginning.** y holds where a point would have been at t = 0, so
that nothing has to be moved before the end: a collision at t changes it by (v_before - v_after) t.

A cluster's state stands at its outermost members, the only ones with contacts to others.
"""

from crazybilliards.model.kernels import inlined, kernel
from crazybilliards.particles.laws.avalanche import record_collision


@inlined
def _before(a, b, due, speed):  # type: ignore[no-untyped-def]
    """Whether contact a is to be taken before contact b."""
    return due[a] < due[b] or (due[a] == due[b] and speed[a] > speed[b])


@inlined
def _sift(place, heap, places, size, due, speed):  # type: ignore[no-untyped-def]
    """Move the contact at ``place`` of the heap up or down to where it belongs."""
    contact = heap[place]
    while place > 0:
        parent = (place - 1) // 2
        if not _before(contact, heap[parent], due, speed):
            break
        heap[place] = heap[parent]
        places[heap[place]] = place
        place = parent
    while True:
        child = 2 * place + 1
        if child >= size:
            break
        if child + 1 < size and _before(heap[child + 1], heap[child], due, speed):
            child += 1
        if not _before(heap[child], contact, due, speed):
            break
        heap[place] = heap[child]
        places[heap[place]] = place
        place = child
    heap[place] = contact
    places[contact] = place


@inlined
def _remove(contact, heap, places, size, due, speed):  # type: ignore[no-untyped-def]
    """Take a contact out of the heap; return the heap's new size."""
    place = places[contact]
    places[contact] = -1
    size -= 1
    if place < size:
        heap[place] = heap[size]
        places[heap[place]] = place
        _sift(place, heap, places, size, due, speed)
    return size


@inlined
def _schedule(contact, now, dt, y, v, heap, places, size, due, speed):  # type: ignore[no-untyped-def]
    """Work out when the contact closes next, if within the step; return the heap's size."""
    closing = v[contact] - v[contact + 1]
    gap = y[contact + 1] - y[contact]
    place = places[contact]
    # Multiplying instead of dividing: no overflow, and false where either is NaN.
    if closing > 0 and gap < dt * closing:
        # Rounding can put a meeting just before the event that caused it.
        due[contact] = max(gap / closing, now)
        speed[contact] = closing
        if place < 0:
            place = size
            heap[place] = contact
            size += 1
        _sift(place, heap, places, size, due, speed)
    elif place >= 0:
        size = _remove(contact, heap, places, size, due, speed)
    return size


@kernel
def drift(y, v, dt, restitution, merge_speed, most, integers, floats, tally):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt``; return the collisions, or -1 if too many.

    ``integers`` (4, L) and ``floats`` (2, L) are scratch space. ``tally`` (an
    ``avalanche.Tally``) takes down every collision. After ``most`` collisions the drift
    gives up: the state is then worthless, the chain has diverged.
    """
    n = y.size
    first, last, heap, places = integers[0], integers[1], integers[2], integers[3]
    due, speed = floats[0], floats[1]
    size = 0
    for i in range(n):
        first[i] = i
        last[i] = i
        places[i] = -1
    for contact in range(n - 1):
        # The test of _schedule once more: few contacts close in a step, most end here.
        closing = v[contact] - v[contact + 1]
        if closing > 0 and y[contact + 1] - y[contact] < dt * closing:
            size = _schedule(contact, 0.0, dt, y, v, heap, places, size, due, speed)
    collisions = 0
    while size > 0:
        contact = heap[0]
        now = due[contact]
        collisions += 1
        if collisions > most:
            return -1
        a, b = first[contact], last[contact + 1]
        left, right = contact - a + 1, b - contact
        v_left, v_right = v[contact], v[contact + 1]
        record_collision(contact, a, b, v_left, v_right, tally)
        # The cluster's or the pair's common velocity, by its smaller change.
        common = v_left + (v_right - v_left) * right / (left + right)
        # Flippers act when rods meet. Rods at rest against one another would otherwise pass one
        # kick back and forth at no time and ever more energy: the start at the anchors, say.
        rebound = (min(restitution, 1.0) if now == 0.0 else restitution) * (v_left - v_right)
        if rebound <= merge_speed:
            y_common = y[contact] + (v_left - common) * now
            first[b] = a
            last[a] = b
            v[a] = v[b] = common
            y[a] = y[b] = y_common
            # v of the inner members is stale from here on; their contact never closes again.
            v[contact] = v[contact + 1] = common
            y[contact] = y[contact + 1] = y_common
        else:
            new_left = common - rebound * right / (left + right)
            new_right = common + rebound * left / (left + right)
            y_left = y[contact] + (v_left - new_left) * now
            y_right = y[contact + 1] + (v_right - new_right) * now
            v[a] = v[contact] = new_left
            y[a] = y[contact] = y_left
            v[b] = v[contact + 1] = new_right
            y[b] = y[contact + 1] = y_right
        # The two now separate or are one.
        size = _remove(contact, heap, places, size, due, speed)
        if a > 0:
            size = _schedule(a - 1, now, dt, y, v, heap, places, size, due, speed)
        if b < n - 1:
            size = _schedule(b, now, dt, y, v, heap, places, size, due, speed)
    a = 0
    while a < n:
        b = last[a]
        position = y[a] + dt * v[a]
        if a > 0 and position < y[a - 1]:
            position = y[a - 1]
        velocity = v[a]
        for i in range(a, b + 1):
            y[i] = position
            v[i] = velocity
        a = b + 1
    return collisions
