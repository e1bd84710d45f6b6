"""Drift with perfectly inelastic collisions (e = 0): isotonic regression.

Sticky points that fly freely over dt end at the projection of their free positions y + dt v onto
the ordered ones, y_1 <= ... <= y_L: the pool-adjacent-violators algorithm, exact in O(L). Points
of one block have met; by conservation of momentum a block moves with the mean velocity of its
members, and lies at the mean of their free positions.
"""

from crazybilliards.particles.kernel import kernel


@kernel
def pool(values, starts, means):  # type: ignore[no-untyped-def] # pragma: no cover
    """Isotonic regression of ``values`` with equal weights; return the number of blocks.

    Block b reaches from ``starts[b]`` to ``starts[b + 1]``, at its ``means[b]``; the means
    ascend. ``starts`` needs one place more than there are values.
    """
    blocks = 0
    for i in range(values.size):
        start, mean = i, values[i]
        while blocks > 0 and means[blocks - 1] > mean:
            blocks -= 1
            left = start - starts[blocks]
            right = i + 1 - start
            mean += (means[blocks] - mean) * left / (left + right)
            start = starts[blocks]
        starts[blocks] = start
        means[blocks] = mean
        blocks += 1
    starts[blocks] = values.size
    return blocks


@kernel
def drift(y, v, dt, starts, means):  # type: ignore[no-untyped-def] # pragma: no cover
    """Advance ``y`` and ``v`` in place by ``dt``; return the contacts that ended up closed.

    ``starts`` (integers, one longer than y) and ``means`` (floats) are scratch space.
    """
    for i in range(y.size):
        y[i] += dt * v[i]
    blocks = pool(y, starts, means)
    for b in range(blocks):
        first, last = starts[b], starts[b + 1]
        if last == first + 1:
            continue
        total = 0.0
        for i in range(first, last):
            total += v[i]
        for i in range(first, last):
            y[i] = means[b]
            v[i] = total / (last - first)
    return y.size - blocks
