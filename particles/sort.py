"""Drift with elastic collisions (e = 1): move freely, then sort.

Equal masses swap their velocities when they collide elastically, which is the same as passing
through one another and swapping names. In the reduced coordinate a drift over dt is therefore:
let every point fly freely, y + dt v, then sort the pairs (y, v) by y. Exact, whatever the number
of collisions; each inversion that the sort removes is one collision.

Insertion sort on a nearly sorted chain costs O(L + collisions).
"""

from crazybilliards.particles.kernel import kernel


@kernel
def drift(y, v, dt):  # type: ignore[no-untyped-def] # pragma: no cover
    """Advance reduced coordinates ``y`` and velocities ``v`` by ``dt``; return the collisions.

    Both are 1-d float arrays, ``y`` ascending; both are changed in place.
    """
    collisions = 0
    for i in range(y.size):
        y_i = y[i] + dt * v[i]
        v_i = v[i]
        j = i
        while j > 0 and y[j - 1] > y_i:
            y[j] = y[j - 1]
            v[j] = v[j - 1]
            j -= 1
        y[j] = y_i
        v[j] = v_i
        collisions += i - j
    return collisions
