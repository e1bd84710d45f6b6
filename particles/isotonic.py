"""Drift with perfectly inelastic collisions (e = 0): isotonic regression.

Sticky points that fly freely over dt end at the projection of their free positions y + dt v onto
the ordered ones, y_1 <= ... <= y_L: the pool-adjacent-violators algorithm, exact in O(L). Points
of one block have met; by conservation of momentum a block moves with the mean velocity of its
members, and lies at the mean of their free positions.
"""

from crazybilliards.model.kernel import kernel


@kernel
def pool(values, starts, totals):  # type: ignore[no-untyped-def] # pragma: no cover
    """Isotonic regression of ``values`` with equal weights; return the number of blocks.

    Block b reaches from ``starts[b]`` to ``starts[b + 1]``; its values add up to ``totals[b]``.
    The blocks' means ascend. ``starts`` needs one place more than there are values.
    """
    blocks = 0
    # The last block is kept in registers: most values begin a block of their own.
    start, count, total, mean = 0, 1.0, values[0], values[0]
    for i in range(1, values.size):
        value = values[i]
        if value >= mean:
            starts[blocks] = start
            totals[blocks] = total
            blocks += 1
            start, count, total, mean = i, 1.0, value, value
            continue
        total += value
        count += 1.0
        while blocks > 0:
            before = float(start - starts[blocks - 1])
            if totals[blocks - 1] * count <= total * before:
                break
            blocks -= 1
            start = starts[blocks]
            total += totals[blocks]
            count += before
        mean = total / count
    starts[blocks] = start
    totals[blocks] = total
    starts[blocks + 1] = values.size
    return blocks + 1


@kernel
def drift(y, v, dt, starts, totals):  # type: ignore[no-untyped-def] # pragma: no cover
    """Advance ``y`` and ``v`` in place by ``dt``; return the contacts that ended up closed.

    ``starts`` (integers, one longer than y) and ``totals`` (floats) are scratch space.
    """
    for i in range(y.size):
        y[i] += dt * v[i]
    blocks = pool(y, starts, totals)
    for b in range(blocks):
        first, last = starts[b], starts[b + 1]
        if last == first + 1:
            continue
        momentum = 0.0
        for i in range(first, last):
            momentum += v[i]
        share = 1.0 / (last - first)
        position, velocity = totals[b] * share, momentum * share
        # Means of neighbouring blocks that touch may come out of order by rounding.
        if first > 0 and position < y[first - 1]:
            position = y[first - 1]
        for i in range(first, last):
            y[i] = position
            v[i] = velocity
    return y.size - blocks
