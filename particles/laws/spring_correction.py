r"""What the springs of two rods are ahead of their kicks when the rods collide.

The true relative velocity of two rods at the time t of a step differs from that of the drift by
``ahead`` = (a' - a)(t - dt/2), see docs/physics/collisions.md. A collision has to reverse the true
one, and the second half kick of the springs adds ``ahead`` later:

    v' - v -> -e (v' - v + ahead) - ahead.

No rod passes another: v' - v becomes 0 where this is negative, as it may be for rods that hardly
touch. Without a gap rods that meet have the same displacement, and ``ahead`` is 0 in an
event-driven collision. Contact Dynamics reverses velocities at the beginning of the step, t = 0,
where the rods have not met yet, so it needs the correction always.
"""

from crazybilliards.model import spring
from crazybilliards.model.kernels import inlined

_force = inlined(spring.force)


@inlined
def springs_ahead(left, right, pull, exponent, since_middle):  # type: ignore[no-untyped-def]
    """Return (a' - a)(t - dt/2) of two rods with these displacements.

    ``pull`` is k/m, and ``since_middle`` is t - dt/2.
    """
    return pull * (_force(left, exponent) - _force(right, exponent)) * since_middle
