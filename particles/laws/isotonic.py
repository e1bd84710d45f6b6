"""Drift with perfectly inelastic collisions (e = 0): isotonic regression.

Points that stick end at the projection of their free positions y + dt v onto the ordered positions,
y_1 <= ... <= y_L (L. Natile and G. Savaré, SIAM J. Math. Anal. 41, 1340, 2009; the reason stands in
docs/physics/collisions.md). The pool-adjacent-violators algorithm (M. Ayer and others, Ann. Math.
Statist. 26, 641, 1955) computes it exactly in O(L).

Most rods meet no other rod within a step, at random, and a mispredicted branch costs a processor
more than the arithmetic of a rod. The violations (rods that have overtaken their left neighbour)
are therefore listed first, without a branch. Only their blocks are then processed.

Rods of unequal masses make the regression one with the masses as weights, because blocks conserve
the momentum. Two walls bound the ordered values. The nearest ordered values between two bounds are
the nearest ordered ones, cut at the bounds, so the walls need no regression of their own.
"""

import numpy as np

from crazybilliards.model.kernels import INDEX, kernel
from crazybilliards.particles.laws.closed_contacts import find_clusters

_0, _1, _2 = INDEX(0), INDEX(1), INDEX(2)


@kernel
def pool(values, carried, violations, count, firsts, lasts, sums, carried_sums):  # type: ignore[no-untyped-def]
    """Isotonic regression of ``values`` with equal weights, in place.

    Return the number of blocks of more than one rod, and the number of pairs merged in them.
    ``firsts`` and ``lasts`` receive the blocks in order; a block ends before its last.

    ``carried`` (it may be ``values``) are averaged over the same blocks. ``violations``: the first
    ``count`` entries are the indices i with values[i] < values[i - 1], in order. The last four,
    two of integers and two of floats, are scratch space of the values' size.
    """
    size = INDEX(values.size)
    # Blocks of more than one rod lie on a stack; the last one ends before ``end``.
    blocks, end = _0, _0
    k = _0
    while k < count:
        violation = INDEX(violations[k])
        k += _1
        last = violation + _1
        if violation == end:
            blocks -= _1
            first = INDEX(firsts[blocks])
            members = float(violation - first) + 1.0
            total, carried_total = sums[blocks], carried_sums[blocks]
            end = INDEX(lasts[blocks - _1]) if blocks > _0 else _0
        else:
            first = violation - _1
            members, total, carried_total = 2.0, values[first], carried[first]
        total += values[violation]
        carried_total += carried[violation]
        while True:
            while first > _0:
                if first == end:
                    left = blocks - _1
                    weight = float(end - INDEX(firsts[left]))
                    if sums[left] * members <= total * weight:
                        break
                    first = INDEX(firsts[left])
                    total += sums[left]
                    carried_total += carried_sums[left]
                    members += weight
                    blocks = left
                    end = INDEX(lasts[left - _1]) if left > _0 else _0
                else:
                    if values[first - _1] * members <= total:
                        break
                    first -= _1
                    total += values[first]
                    carried_total += carried[first]
                    members += 1.0
            if last == size or values[last] * members >= total:
                break
            total += values[last]
            carried_total += carried[last]
            members += 1.0
            k += INDEX(violations[k] == last)
            last += _1
        firsts[blocks], lasts[blocks] = first, last
        sums[blocks], carried_sums[blocks] = total, carried_total
        blocks += _1
        end = last
    # Blocks are written only at the end: writing a growing block each time would cost its size.
    merged = _0
    for block in range(blocks):
        first, last = INDEX(firsts[block]), INDEX(lasts[block])
        share = 1.0 / float(last - first)
        mean, carried_mean = sums[block] * share, carried_sums[block] * share
        # Rounding may put the means of neighbouring blocks that touch out of order.
        if first > _0:
            mean = max(mean, values[first - _1])
        values[first] = values[first + _1] = mean
        carried[first] = carried[first + _1] = carried_mean
        for i in range(first + _2, last):
            values[i] = mean
            carried[i] = carried_mean
        merged += last - first - _1
    return blocks, merged


@kernel
def drift(y, v, dt, violations, floats, clusters):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt``; return the contacts that ended up closed.

    The others are scratch space, and ``clusters`` records the rods that have merged.
    """
    count = _0
    before = -np.inf
    for i in range(y.size):
        position = y[i] = y[i] + dt * v[i]
        violations[count] = i
        count += INDEX(position < before)
        before = position
    firsts, lasts = clusters.firsts, clusters.lasts
    blocks, merged = pool(y, v, violations, count, firsts, lasts, floats[0], floats[1])
    clusters.number[0] = blocks
    return np.int64(merged)


@kernel
def pool_weighted(values, carried, inverse, firsts, totals, carried_totals, weights):  # type: ignore[no-untyped-def]
    """Isotonic regression of ``values`` with the weights 1/``inverse``, in place.

    Return the number of pairs merged. ``carried`` are averaged over the same blocks. The last four
    are scratch space of the values' size.
    """
    blocks = 0
    for i in range(values.size):
        firsts[blocks], weights[blocks] = i, 1.0 / inverse[i]
        totals[blocks], carried_totals[blocks] = values[i] / inverse[i], carried[i] / inverse[i]
        left = blocks - 1
        while left >= 0 and totals[left] * weights[left + 1] > totals[left + 1] * weights[left]:
            weights[left] += weights[left + 1]
            totals[left] += totals[left + 1]
            carried_totals[left] += carried_totals[left + 1]
            left -= 1
        blocks = left + 2
    before = -np.inf
    for block in range(blocks):
        first = firsts[block]
        end = firsts[block + 1] if block + 1 < blocks else values.size
        if end - first > 1:
            values[first] = totals[block] / weights[block]
            carried[first] = carried_totals[block] / weights[block]
        # Rounding may put the means of neighbouring blocks that touch out of order.
        before = values[first] = max(values[first], before)
        for i in range(first + 1, end):
            values[i], carried[i] = values[first], carried[first]
    return values.size - blocks


@kernel
def stick(y, v, dt, law, scratch):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` at e = 0, also of the walls; return the contacts that closed."""
    n = y.size
    for i in range(n):
        y[i] += dt * v[i]
    inverse = scratch.inverse[1:-1] if law.high < np.inf else scratch.inverse
    closed = pool_weighted(
        y, v, inverse, scratch.integers[0], scratch.floats[0], scratch.floats[1], scratch.floats[2]
    )
    for i in range(n):
        if y[i] < law.low or y[i] > law.high:
            y[i], v[i] = min(max(y[i], law.low), law.high), 0.0
            closed += 1
    find_clusters(y, scratch.clusters, law.low, law.high)
    return np.int64(closed)
