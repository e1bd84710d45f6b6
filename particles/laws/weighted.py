r"""All contacts of a step at once, for rods of unequal masses and between walls.

These are the problems of ``isotonic.py`` (e = 0) and ``contact_dynamics.py``. Rods of unequal
masses make the regression one with the masses as weights, because blocks conserve the momentum. Two
walls bound the ordered values. The nearest ordered values between two bounds are the nearest
ordered ones, cut at the bounds, so the walls need no regression of their own.
"""

import numpy as np

from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws.closed_contacts import find_clusters
from crazybilliards.particles.laws.contact_dynamics import bound
from crazybilliards.particles.laws.spring_correction import springs_ahead


@kernel
def pool(values, carried, inverse, firsts, totals, carried_totals, weights):  # type: ignore[no-untyped-def]
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
    spare = scratch.floats[0], scratch.floats[1], scratch.floats[2]
    closed = pool(y, v, inverse, scratch.integers[0], *spare)
    for i in range(n):
        if y[i] < law.low or y[i] > law.high:
            y[i], v[i] = min(max(y[i], law.low), law.high), 0.0
            closed += 1
    find_clusters(y, scratch.clusters, law.low, law.high)
    return np.int64(closed)


@kernel
def _ahead(i, y, anchors, inverse, dt, law):  # type: ignore[no-untyped-def]
    """Relative velocity that the spring of rod i, seen from its left, has yet to give it."""
    return springs_ahead(0.0, y[i] - anchors[i], law.pull * inverse[i], law.exponent, -dt / 2)


@kernel
def solve(y, v, anchors, dt, law, scratch):  # type: ignore[no-untyped-def]
    """Contact Dynamics: advance ``y`` and ``v`` by ``dt``; return the contacts with an impulse."""
    n = y.size
    inverse = scratch.inverse[1:-1] if law.high < np.inf else scratch.inverse
    shifted, totals = scratch.floats[0, :n], scratch.floats[1]
    sums, weights = scratch.floats[2], scratch.floats[3]
    total = 0.0
    shifted[0], totals[0] = v[0], 0.0
    for i in range(1, n):
        ahead = _ahead(i, y, anchors, inverse, dt, law)
        ahead -= _ahead(i - 1, y, anchors, inverse, dt, law)
        total += bound(y[i] - y[i - 1], v[i - 1] - v[i], law.restitution, ahead, dt)
        shifted[i], totals[i] = v[i] - total, total
    merged = pool(shifted, shifted, inverse, scratch.integers[0], sums, scratch.due, weights)
    if law.high < np.inf:
        left = _ahead(0, y, anchors, inverse, dt, law)
        right = -_ahead(n - 1, y, anchors, inverse, dt, law)
        least = bound(y[0] - law.low, -v[0], law.wall_restitution, left, dt)
        most = -bound(law.high - y[n - 1], v[n - 1], law.wall_restitution, right, dt) - total
        if most < least:  # all rebounds together need more room than there is
            least = most = (least + most) / 2
        for i in range(n):
            shifted[i] = min(max(shifted[i], least), most)
    before = law.low
    for i in range(n):
        v[i] = shifted[i] + totals[i]
        # Bounds of touching rods agree up to rounding errors: keep the order exact.
        before = y[i] = min(max(y[i] + dt * v[i], before), law.high)
    return np.int64(merged)
