"""Elastic collisions (e = 1) by sorting: rods pass through each other, then swap names.

A drift over dt lets every point fly freely, y + dt v, and then sorts the pairs (y, v) by y. The
result is exact for any number of collisions (D. W. Jepsen, J. Math. Phys. 6, 405, 1965), which it
does not count.

**The sort** distributes the pairs over two buckets a rod, equally wide. They are then nearly in
order, and insertion in short runs, which are merged, does the rest. The cost of a rod hardly
depends on the length of the chain. Where many lie in one bucket the runs bound the work by
O(L log L). Equal positions keep their order, so the result does not depend on how it is sorted.
"""

import numpy as np

from crazybilliards.model.kernels import inlined, kernel

BUCKETS = 2  # a rod
_RUN = 64
_FEW = 16  # rods that are sorted by insertion as fast


@inlined
def _merge(y, v, begin, middle, end, y_left, v_left):  # type: ignore[no-untyped-def]
    """Merge two sorted runs that meet at ``middle``."""
    first = middle
    while first > begin and y[first - 1] > y[middle]:
        first -= 1
    count = middle - first
    for i in range(count):
        y_left[i], v_left[i] = y[first + i], v[first + i]
    taken, right, place = 0, middle, first
    while taken < count:
        if right < end and y[right] < y_left[taken]:
            y[place], v[place] = y[right], v[right]
            right += 1
        else:
            y[place], v[place] = y_left[taken], v_left[taken]
            taken += 1
        place += 1


@inlined
def _insert_and_merge(y, v, y_left, v_left):  # type: ignore[no-untyped-def]
    """Sort the pairs (y, v) by y, which are nearly in order."""
    n = y.size
    for begin in range(0, n, _RUN):
        for i in range(begin + 1, min(begin + _RUN, n)):
            y_i, v_i, j = y[i], v[i], i
            while j > begin and y[j - 1] > y_i:
                y[j], v[j] = y[j - 1], v[j - 1]
                j -= 1
            y[j], v[j] = y_i, v_i
    width = _RUN
    while width < n:
        for middle in range(width, n, 2 * width):
            if y[middle - 1] > y[middle]:
                end = min(middle + width, n)
                _merge(y, v, middle - width, middle, end, y_left, v_left)
        width *= 2


@kernel
def _distribute(y, v, buckets, counts, y_other, v_other):  # type: ignore[no-untyped-def]
    """Order the pairs by their buckets, in place."""
    n = y.size
    low = high = y[0]
    for i in range(n):
        low, high = min(low, y[i]), max(high, y[i])
    last = float(BUCKETS * n - 1)
    scale = last / (high - low)
    if not (high > low and scale < np.inf):
        return
    for i in range(n):
        place = (y[i] - low) * scale
        # Written so that a chain that diverges, with positions that are no numbers, does no harm.
        place = place if place > 0.0 else 0.0
        buckets[i] = np.int32(place if place < last else last)
    for k in range(BUCKETS * n):
        counts[k] = 0
    for i in range(n):
        counts[np.uint64(buckets[i])] += 1
    total = 0
    for k in range(BUCKETS * n):
        count = counts[k]
        counts[k] = total
        total += count
    for i in range(n):
        bucket = np.uint64(buckets[i])
        place = np.uint64(counts[bucket])
        counts[bucket] += 1
        y_other[place], v_other[place] = y[i], v[i]
    for i in range(n):
        y[i], v[i] = y_other[i], v_other[i]


@inlined
def sort_pairs(y, v, scratch):  # type: ignore[no-untyped-def]
    """Sort the pairs (y, v) by y in place."""
    y_other, v_other = scratch.floats[0], scratch.floats[1]
    if y.size >= _FEW:
        _distribute(y, v, scratch.buckets, scratch.counts, y_other, v_other)
    _insert_and_merge(y, v, y_other, v_other)


@inlined
def drift(y, v, dt, scratch):  # type: ignore[no-untyped-def]
    """Advance reduced coordinates ``y``, ascending, and velocities ``v`` by ``dt`` in place."""
    for i in range(y.size):
        y[i] += dt * v[i]
    sort_pairs(y, v, scratch)
