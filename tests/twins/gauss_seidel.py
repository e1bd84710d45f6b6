"""Contact Dynamics as it is usually solved: sweep over the contacts until nothing changes.

The independent twin of the exact solve: projected Gauss-Seidel on the impulses of all contacts,
which converges to the same velocities at a cost that grows with the square of the chain.
"""

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def solve(y, v, given, dt, restitution, tolerance, impulses, bounds, inverse=None, wall=1.0):  # type: ignore[no-untyped-def]
    """Velocities after contact, in place; return the number of sweeps.

    ``given`` (L) is the velocity that each rod has got from its spring in the half kick before: the
    true one, without it, rebounds, and it is given once more. ``impulses`` (L - 1) is the starting
    guess and the result; ``bounds`` is scratch. ``inverse`` (L) are the inverse masses, 1 unless
    given. A rod of inverse mass 0 is a wall, with the restitution ``wall``.
    """
    n = y.size
    w = np.ones(n) if inverse is None else inverse
    reduced = 1 / (w[:-1] + w[1:])  # masses; a division in every sweep would take twice as long
    for i in range(n - 1):
        closing = v[i] - v[i + 1]
        gap = y[i + 1] - y[i]
        e = restitution if w[i] * w[i + 1] > 0 else wall
        bounds[i] = -gap / dt
        if e > 0 and gap < dt * closing:
            change = given[i + 1] - given[i]
            bounds[i] = max(e * (closing + change) + change, bounds[i])
    for i in range(n - 1):
        v[i] -= w[i] * impulses[i]
        v[i + 1] += w[i + 1] * impulses[i]
    sweeps, largest = 0, tolerance + 1.0
    while largest > tolerance:
        largest = 0.0
        for i in range(n - 1):
            missing = (bounds[i] - (v[i + 1] - v[i])) * reduced[i]
            new = max(impulses[i] + missing, 0.0)
            change = new - impulses[i]
            impulses[i] = new
            v[i] -= w[i] * change
            v[i + 1] += w[i + 1] * change
            largest = max(largest, abs(change))
        sweeps += 1
    return sweeps
