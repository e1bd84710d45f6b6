"""Drift with elastic collisions (e = 1): move freely, then sort.

Equal masses swap their velocities when they collide elastically, as if they passed through each
other and swapped names. In the reduced coordinate a drift over dt therefore lets every point fly
freely, y + dt v, and then sorts the pairs (y, v) by y. The result is exact for any number of
collisions (D. W. Jepsen, J. Math. Phys. 6, 405, 1965). Each inversion that the sort removes is one
collision.

The sort uses the existing order. It sorts short runs by insertion and then merges the runs,
touching only the parts that overlap. It costs O(L + collisions) if rods collide rarely, and never
more than O(L log L), even if each of a million rods meets thousands of others in a step.
"""

from crazybilliards.model.kernels import inlined, kernel

_RUN = 64


@inlined
def _merge(y, v, begin, middle, end, y_left, v_left):  # type: ignore[no-untyped-def]
    """Merge two sorted runs that meet at ``middle``; return the inversions between them."""
    first = middle
    while first > begin and y[first - 1] > y[middle]:
        first -= 1
    count = middle - first
    y_left[:count] = y[first:middle]
    v_left[:count] = v[first:middle]
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


@kernel
def drift(y, v, dt, y_left, v_left):  # type: ignore[no-untyped-def]
    """Advance reduced coordinates ``y`` and velocities ``v`` by ``dt``; return the collisions.

    Both are 1-d float arrays, ``y`` ascending; both are changed in place. ``y_left`` and
    ``v_left``, of the same length, are scratch space.
    """
    n = y.size
    collisions = 0
    for begin in range(0, n, _RUN):
        for i in range(begin, min(begin + _RUN, n)):
            y_i = y[i] + dt * v[i]
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
