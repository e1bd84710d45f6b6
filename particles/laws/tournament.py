"""A knockout tournament of the contacts: the one that closes first stands at the root.

The contacts are the leaves of a binary tree, and every node above them holds the earlier one of its
two children. Node k has the children 2k and 2k + 1, the root is node 1, and of n contacts the
contact c is leaf n + c. A collision changes three leaves, which climb to the root together: the
first one until it meets the path of the second one, and so on. It costs O(log L). Unlike those of a
heap, the comparisons only select numbers: no step depends on what a processor cannot predict.
"""

import numpy as np

from crazybilliards.model.kernels import inlined, kernel

# With unsigned indices compiled code need not check for indices from the end of an array.
INDEX = np.uint64
_0, _1 = INDEX(0), INDEX(1)


@inlined
def beats(contact, other, v):  # type: ignore[no-untyped-def]
    """Return whether ``contact`` comes before ``other`` if both close at the same time."""
    speed, other_speed = v[contact] - v[contact + _1], v[other] - v[other + _1]
    return speed > other_speed or (speed == other_speed and contact < other)


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
