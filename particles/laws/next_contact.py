"""Which of the contacts that are due closes next: a calendar, or a tournament.

**A calendar** is the time of a step in equal parts, with a list for each part. The contact that
closes first is in the first list that is not empty. There are as many lists as contacts that are
due, so a list holds about one, and a collision costs O(1).

The lists are doubly linked. Of L rods, contact c is node c, and the list of part k has its head at
node L + k. A node that is linked to itself is an empty list, or a contact in no list.

**A tournament** is a knockout of the contacts: the one that closes first stands at the root. The
contacts are the leaves of a binary tree, and every node above them holds the earlier one of its two
children. Node k has the children 2k and 2k + 1, the root is node 1, and of n contacts the contact c
is leaf n + c. A collision changes three leaves, which climb to the root together: the first one
until it meets the path of the second one, and so on. It costs O(log L). Unlike those of a heap, the
comparisons only select numbers: no step depends on what a processor cannot predict.
"""

import numpy as np

from crazybilliards.model.kernels import INDEX, inlined, kernel

_0, _1 = INDEX(0), INDEX(1)


@inlined
def beats(contact, other, v):  # type: ignore[no-untyped-def]
    """Return whether ``contact`` comes before ``other`` if both close at the same time."""
    speed, other_speed = v[contact] - v[contact + _1], v[other] - v[other + _1]
    return speed > other_speed or (speed == other_speed and contact < other)


@inlined
def list_due(due, size, waiting):  # type: ignore[no-untyped-def]
    """List the contacts that are due, without a branch; return how many."""
    count = _0
    for contact in range(size - 1):
        waiting[count] = contact
        count += INDEX(due[contact] < np.inf)
    return count


@inlined
def move(contact, node, following, preceding):  # type: ignore[no-untyped-def]
    """Take a contact out of its list and put it at the head of another; its own node: in none."""
    before, after = preceding[contact], following[contact]
    following[before], preceding[after] = after, before
    following[contact] = contact
    head = following[node]
    following[node], preceding[head] = contact, contact
    following[contact], preceding[contact] = head, node


@inlined
def list_of(contact, time, scale, begin, parts):  # type: ignore[no-untyped-def]
    """Return the node of the list of a contact that is due at ``time``; its own node: not due."""
    part = time * scale
    part = part if part < parts else parts
    return INDEX(begin) + INDEX(np.int64(part)) if time < np.inf else INDEX(contact)


@inlined
def open_calendar(dt, due, waiting, count, size, following, preceding):  # type: ignore[no-untyped-def]
    """Put the contacts that are due into lists; return lists per time, and the last list."""
    # A little less than one list more, so that none is needed for the end of the step.
    scale, parts = (float(count) + 1) * (1 - 1e-9) / dt, float(count)
    for k in range(count):
        contact = INDEX(waiting[k])
        move(contact, list_of(contact, due[contact], scale, size, parts), following, preceding)
    return scale, parts


@inlined
def earliest(node, following, due, v):  # type: ignore[no-untyped-def]
    """Return the first contact of a list that is not empty, and the length of the list."""
    contact = following[node]
    time, other, length = due[contact], following[contact], 1
    while other != node:
        other_time = due[other]
        if other_time == time and beats(other, contact, v):
            contact = other
        contact = other if other_time < time else contact
        time = other_time if other_time < time else time
        other = following[other]
        length += 1
    return contact, length


@kernel
def climb(node, until, due, winner, v):  # type: ignore[no-untyped-def]
    """Decide the nodes above ``node`` again, until its path meets the path of node ``until``.

    0 stands for the root. The path of ``until`` finds the last node decided here as an opponent.
    """
    time = due[node]
    while node > _1 and node ^ until > _1:
        opponent = node ^ _1
        other_time = due[opponent]
        first = node ^ INDEX(other_time < time)
        # True for equal times (or nearly equal ones, by underflow). Two infinities are not equal
        # here, because their difference is NaN. A comparison that is rarely true costs nothing.
        difference = other_time - time
        if difference * difference <= 0.0:
            later = other_time == time and beats(winner[opponent], winner[node], v)
            first = node ^ INDEX(other_time < time or later)
        time = other_time if other_time < time else time
        node, until = node >> _1, until >> _1
        due[node], winner[node] = time, winner[first]


@kernel
def plant(contacts, due, winner, v):  # type: ignore[no-untyped-def]
    """Hold the tournament of all contacts. Contact c is leaf ``contacts`` + c, the root node 1."""
    for contact in range(contacts - 1, -1, -1):
        due[contacts + contact], winner[contacts + contact] = due[contact], contact
    for node in range(contacts):
        due[node] = np.inf
    leaves = INDEX(2 * contacts)
    for leaf in range(INDEX(contacts), leaves):
        climb(leaf, leaf + _1 if leaf + _1 < leaves else _0, due, winner, v)
