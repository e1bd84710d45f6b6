"""Contact Dynamics, the paper's method: all contacts of a step solved at once, exactly in O(L).

Per step the velocities u after contact satisfy, for every contact between i and i+1,

    u_{i+1} - u_i >= b_i,     impulse_i >= 0,     one of the two an equality,

with b_i = e (v_i - v_{i+1}) for a contact that would close within the step and bounces (e > 0), and
b_i = -gap_i/dt for every other contact, which then does not overlap. (With the splitting the
velocities are corrected for what the springs have not given yet, see ``spring_correction.py``.)
With B_i the sum of the b_j left of i, u_i - B_i is the isotonic regression of v_i - B_i.
docs/physics/collisions.md derives this, compares the law with others, and says what energy it
takes whenever a rod touches both of its neighbours in one step at e > 0.
"""

import numpy as np

from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws.isotonic import pool
from crazybilliards.particles.laws.spring_correction import springs_ahead
from crazybilliards.particles.laws.tournament import INDEX


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
