"""Drift with elastic collisions (e = 1): move freely, then sort.

Equal masses swap their velocities when they collide elastically, as if they passed through each
other and swapped names. In the reduced coordinate a drift over dt therefore lets every point fly
freely, y + dt v, and then sorts the pairs (y, v) by y. The result is exact for any number of
collisions (D. W. Jepsen, J. Math. Phys. 6, 405, 1965). Each inversion that the sort removes is one
collision.

The sort uses the existing order. In a round of odd-even transposition all even neighbours that are
in the wrong order swap places at once, then all odd ones, in vector registers and without a branch.
A few rounds are enough if rods collide rarely. Otherwise the rest is sorted in short runs by
insertion, and the runs are merged, touching only the parts that overlap. It costs
O(L + collisions) if rods collide rarely, and never more than O(L log L), even if each of a million
rods meets thousands of others in a step. Every sort by swaps of neighbours in the wrong order makes
the same number of swaps and keeps the order of equal positions, so the result does not depend on
the number of rounds.
"""

import numpy as np

from crazybilliards.model.kernels import inlined, kernel

_RUN = 64
_ROUNDS = 16
_FEW = 30  # rods that are sorted by insertion as fast


@inlined
def _merge(y, v, begin, middle, end, y_left, v_left):  # type: ignore[no-untyped-def]
    """Merge two sorted runs that meet at ``middle``; return the inversions between them."""
    first = middle
    while first > begin and y[first - 1] > y[middle]:
        first -= 1
    count = middle - first
    for i in range(count):
        y_left[i] = y[first + i]
        v_left[i] = v[first + i]
    inversions, taken, right, place = 0, 0, middle, first
    while taken < count:
        if right < end and y[right] < y_left[taken]:
            y[place], v[place] = y[right], v[right]
            right += 1
            inversions += count - taken
        else:
            y[place], v[place] = y_left[taken], v_left[taken]
            taken += 1
        place += 1
    return inversions


@inlined
def _insert_and_merge(y, v, y_left, v_left):  # type: ignore[no-untyped-def]
    """Sort the pairs (y, v) by y; return the inversions."""
    n = y.size
    collisions = 0
    for begin in range(0, n, _RUN):
        for i in range(begin, min(begin + _RUN, n)):
            y_i = y[i]
            v_i = v[i]
            j = i
            while j > begin and y[j - 1] > y_i:
                y[j] = y[j - 1]
                v[j] = v[j - 1]
                j -= 1
            y[j] = y_i
            v[j] = v_i
            collisions += i - j
    width = _RUN
    while width < n:
        for middle in range(width, n, 2 * width):
            if y[middle - 1] > y[middle]:
                end = min(middle + width, n)
                collisions += _merge(y, v, middle - width, middle, end, y_left, v_left)
        width *= 2
    return collisions


@inlined
def _exchange(y_left, y_right, v_left, v_right):  # type: ignore[no-untyped-def]
    """Put all pairs of neighbours in order at once, without a branch; return the swaps."""
    swaps = 0
    for i in range(y_left.size):
        a, b, p, q = y_left[i], y_right[i], v_left[i], v_right[i]
        swap = a > b
        y_left[i], y_right[i] = (b if swap else a), (a if swap else b)
        v_left[i], v_right[i] = (q if swap else p), (p if swap else q)
        swaps += np.int64(swap)
    return swaps


@inlined
def _fly_and_exchange(y, v, dt, y_halves, v_halves):  # type: ignore[no-untyped-def]
    """Advance the pairs and exchange neighbours; return the swaps and whether y is in order."""
    n = y.size
    odd = n // 2
    even = n - odd
    y_even, y_odd, v_even, v_odd = (
        y_halves[:even],
        y_halves[even:],
        v_halves[:even],
        v_halves[even:],
    )
    for i in range(odd):
        y_even[i], y_odd[i] = y[2 * i] + dt * v[2 * i], y[2 * i + 1] + dt * v[2 * i + 1]
        v_even[i], v_odd[i] = v[2 * i], v[2 * i + 1]
    if even > odd:
        y_even[odd], v_even[odd] = y[n - 1] + dt * v[n - 1], v[n - 1]
    collisions, quiet, half_round = 0, 0, 0
    while quiet < 2 and half_round < 2 * _ROUNDS:
        if half_round % 2 == 0:
            swaps = _exchange(y_even[:odd], y_odd, v_even[:odd], v_odd)
        else:
            swaps = _exchange(y_odd[: even - 1], y_even[1:], v_odd[: even - 1], v_even[1:])
        collisions += swaps
        quiet = 0 if swaps > 0 else quiet + 1
        half_round += 1
    for i in range(odd):
        y[2 * i], y[2 * i + 1] = y_even[i], y_odd[i]
        v[2 * i], v[2 * i + 1] = v_even[i], v_odd[i]
    if even > odd:
        y[n - 1], v[n - 1] = y_even[odd], v_even[odd]
    return collisions, quiet == 2


@kernel
def drift(y, v, dt, y_halves, v_halves):  # type: ignore[no-untyped-def]
    """Advance reduced coordinates ``y`` and velocities ``v`` by ``dt``; return the collisions.

    Both are 1-d float arrays, ``y`` ascending; both are changed in place. ``y_halves`` and
    ``v_halves``, of the same length, are scratch space.
    """
    collisions, in_order = 0, False
    if y.size < _FEW:
        for i in range(y.size):
            y[i] += dt * v[i]
    else:
        collisions, in_order = _fly_and_exchange(y, v, dt, y_halves, v_halves)
    if not in_order:
        collisions += _insert_and_merge(y, v, y_halves, v_halves)
    return collisions
