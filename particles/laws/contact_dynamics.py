"""Contact Dynamics, the paper's method: all contacts of a step solved at once, exactly in O(L).

Per step the velocities u after contact satisfy, for every contact between i and i+1,

    u_{i+1} - u_i >= b_i,     impulse_i >= 0,     one of the two an equality,

with b_i = e (v_i - v_{i+1}) for a contact that would close within the step and bounces (e > 0), and
b_i = -gap_i/dt for every other contact, which then does not overlap. This linear complementarity
problem is the optimality condition of "u as close to v as the constraints allow". With B_i the sum
of the b_j left of i, the constraints say that u_i - B_i ascends. The solution is the isotonic
regression of v_i - B_i. Other programs usually iterate to it (M. Jean, Comput. Methods Appl. Mech.
Engrg. 177, 235, 1999). The paper quotes a cost of O(L^2) for its program.

The law is the position form, in which rods never overlap beyond rounding. Simultaneous contacts
share an impulse, so Newton's cradle of three rods in contact gives (-1/3, 2/3, 2/3) at e = 1 and
not (0, 0, 1). Every law that solves contacts simultaneously has this property. It is the reason why
event-driven collisions are the default.
"""

import numpy as np

from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws.isotonic import INDEX, pool


@kernel
def bound(gap, closing, restitution, dt):  # type: ignore[no-untyped-def]
    """Least relative velocity u_{i+1} - u_i of a contact; ``closing`` is v_i - v_{i+1}."""
    if restitution > 0 and gap < dt * closing:
        return restitution * closing
    return -gap / dt


@kernel
def drift(y, v, dt, restitution, integers, floats):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt``; return the contacts that carried an impulse.

    ``integers`` and ``floats``, at least three rows of L each, are scratch space.
    """
    violations, firsts, lasts = integers[0], integers[1], integers[2]
    shifted, sums, unused = floats[0], floats[1], floats[2]
    count, total, before = INDEX(0), 0.0, v[0]
    shifted[0] = before
    for i in range(y.size - 1):
        total += bound(y[i + 1] - y[i], v[i] - v[i + 1], restitution, dt)
        free = v[i + 1] - total
        shifted[i + 1] = free
        violations[count] = i + 1
        count += INDEX(free < before)
        before = free
    _, merged = pool(shifted, shifted, violations, count, firsts, lasts, sums, unused)
    total, before = 0.0, -np.inf
    for i in range(y.size):
        # The bound of the next contact needs this rod's state before it is overwritten.
        here = total
        if i < y.size - 1:
            total += bound(y[i + 1] - y[i], v[i] - v[i + 1], restitution, dt)
        v[i] = shifted[i] + here
        # Bounds of touching rods agree up to rounding errors: keep the order exact.
        before = max(y[i] + dt * v[i], before)
        y[i] = before
    return np.int64(merged)
