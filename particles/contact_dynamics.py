"""Contact Dynamics, the paper's method: all contacts of a step solved at once, exactly in O(L).

Per step the velocities u after contact satisfy, for every contact between i and i+1,

    u_{i+1} - u_i >= b_i,     impulse_i >= 0,     one of the two an equality,

with b_i = -gap_i/dt for a contact that must only not overlap, and b_i = e (v_i - v_{i+1}) for
one that would close within the step and is to bounce (e > 0). This linear complementarity problem
is the optimality condition of "u as close to v as the constraints allow". With B_i the sum of the
b_j left of i, the constraints say that u_i - B_i ascends: an isotonic regression of v_i - B_i. The
paper iterates to the same solution at a cost of O(L^2).

The law is the position form: rods never overlap beyond rounding. Simultaneous contacts share an
impulse, so Newton's cradle of three rods in contact gives (-1/3, 2/3, 2/3) at e = 1 instead of
sending the last rod off: a property of every such law, and the reason why event-driven collisions
are the default.
"""

from crazybilliards.model.kernel import kernel
from crazybilliards.particles.isotonic import pool


@kernel
def bound(gap, closing, restitution, dt):  # type: ignore[no-untyped-def] # pragma: no cover
    """Least relative velocity u_{i+1} - u_i of a contact; ``closing`` is v_i - v_{i+1}."""
    if restitution > 0 and gap < dt * closing:
        return restitution * closing
    return -gap / dt


@kernel
def drift(y, v, dt, restitution, starts, totals, shifted):  # type: ignore[no-untyped-def] # pragma: no cover
    """Advance ``y`` and ``v`` in place by ``dt``; return the contacts that carried an impulse.

    ``starts`` (integers, one longer than y), ``totals`` and ``shifted`` (floats) are scratch.
    """
    total = 0.0
    shifted[0] = v[0]
    for i in range(y.size - 1):
        total += bound(y[i + 1] - y[i], v[i] - v[i + 1], restitution, dt)
        shifted[i + 1] = v[i + 1] - total
    blocks = pool(shifted, starts, totals)
    block, total, mean = -1, 0.0, 0.0
    for i in range(y.size):
        if i == starts[block + 1]:
            block += 1
            mean = totals[block] / (starts[block + 1] - starts[block])
        # The bound of the next contact needs this rod's state before it is overwritten.
        here = total
        if i < y.size - 1:
            total += bound(y[i + 1] - y[i], v[i] - v[i + 1], restitution, dt)
        v[i] = mean + here
        y[i] += dt * v[i]
        # Bounds sum to rounding errors only: keep the order exact.
        if i > 0 and y[i] < y[i - 1]:
            y[i] = y[i - 1]
    return y.size - blocks
