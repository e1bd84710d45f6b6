"""Contact Dynamics, the paper's method: all contacts of a step solved at once, exactly in O(L).

Per step the velocities u after contact satisfy, for every contact between i and i+1,

    u_{i+1} - u_i >= b_i,     impulse_i >= 0,     one of the two an equality,

with b_i = e (v_i - v_{i+1}) for a contact that would close within the step and bounces (e > 0), and
b_i = -gap_i/dt for every other contact, which then does not overlap. (With the splitting the
velocities are corrected for what the springs have not given yet, see ``spring_correction.py``.)
With B_i the sum of the b_j left of i, u_i - B_i is the isotonic regression of v_i - B_i.
docs/physics/collisions.md derives this, compares the law with others, and says what energy it
takes whenever a rod touches both of its neighbours in one step at e > 0. Of unequal masses and
between walls ``isotonic.py`` says what the regression is.
"""

import numpy as np

from crazybilliards.model.kernels import INDEX, kernel
from crazybilliards.particles.laws.isotonic import pool, pool_weighted
from crazybilliards.particles.laws.spring_correction import springs_ahead


@kernel
def bound(gap, closing, restitution, ahead, dt):  # type: ignore[no-untyped-def]
    """Least relative velocity u_{i+1} - u_i of a contact; ``closing`` is v_i - v_{i+1}."""
    if restitution > 0 and gap < dt * closing:
        return max(restitution * (closing - ahead) - ahead, -gap / dt)
    return -gap / dt


@kernel
def drift(y, v, anchors, dt, restitution, pull, exponent, integers, floats):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt``; return the contacts that carried an impulse.

    ``pull`` is k/m if the springs are kicked in halves, else 0, ``exponent`` that of their
    potential. ``integers`` and ``floats`` are scratch space.
    """
    violations, firsts, lasts = integers[0], integers[1], integers[2]
    shifted, totals, sums, unused = floats[0], floats[1], floats[2], floats[3]
    count, total = INDEX(0), 0.0
    shifted[0], totals[0] = v[0], total
    for i in range(y.size - 1):
        gap, closing, ahead = y[i + 1] - y[i], v[i] - v[i + 1], 0.0
        if restitution > 0 and gap < dt * closing:
            displacements = y[i] - anchors[i], y[i + 1] - anchors[i + 1]
            ahead = springs_ahead(*displacements, pull, exponent, -dt / 2)
        total += bound(gap, closing, restitution, ahead, dt)
        shifted[i + 1], totals[i + 1] = v[i + 1] - total, total
    for i in range(y.size - 1):  # by themselves, which is faster
        violations[count] = i + 1
        count += INDEX(shifted[i + 1] < shifted[i])
    _, merged = pool(shifted, shifted, violations, count, firsts, lasts, sums, unused)
    before = -np.inf
    for i in range(y.size):
        v[i] = shifted[i] + totals[i]
        # Bounds of touching rods agree up to rounding errors: keep the order exact.
        before = y[i] = max(y[i] + dt * v[i], before)
    return np.int64(merged)


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
    merged = pool_weighted(
        shifted, shifted, inverse, scratch.integers[0], sums, scratch.due, weights
    )
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
