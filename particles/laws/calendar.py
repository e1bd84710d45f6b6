"""A calendar of the contacts that are due: the time of a step in equal parts, a list for each part.

The contact that closes first is in the first list that is not empty. There are as many lists as
contacts that are due, so a list holds about one, and a collision costs O(1).

The lists are doubly linked. Of L rods, contact c is node c, and the list of part k has its head at
node L + k. A node that is linked to itself is an empty list, or a contact in no list.
"""

import numpy as np

from crazybilliards.model.kernels import inlined
from crazybilliards.particles.laws.tournament import INDEX, beats

_0, _1 = INDEX(0), INDEX(1)


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
