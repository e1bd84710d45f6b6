r"""How fast neighbours are when they meet, next to how fast they are on average.

If the relative velocities of rods that meet were Gaussian, with the variance 2 Theta of all
neighbours, then <w^2>/<w> over the collisions of a contact would be (4/sqrt(pi)) sqrt(Theta).
Inelastic neighbours meet more slowly, because a collision takes their relative velocity. The ratio
follows from the motion of one pair with the distance r > 0 and the relative velocity w,

    r' = w,      w' = -Gamma_e w - 2P + noise,      w -> -e w where r = 0.

Each rod is pressed on its neighbour by the one on its other side, with the mean force P per mass.
That force falls with the velocity v of the rod: with the velocities u of that neighbour it is
proportional to <(u - v)^2> over u > v, whose mean derivative is

    dP/dv = -2P/sqrt(pi Theta)      (Gaussians; <dP/dv> = <v P>/<v^2> by Stein's identity).

The pair therefore has the damping Gamma_e = Gamma + 2P/sqrt(pi Theta). With the units of P and the
noise one number is left beside e,

    Gamma_e sqrt(2 Theta)/(2P) = sqrt(2/pi) + Gamma sqrt(Theta/2)/P,

and inside a chain, where rods collide far more often than they are damped, that is sqrt(2/pi). The
stationary density of (r, w) then gives

    K(e)^2 = Theta_c/Theta,      sqrt(Theta_c) = (sqrt(pi)/4) <w^2>/<w>.

studies/contact_speeds.py solves for it by finite volumes. K(1) = 1 is exact.
"""

import math

from scipy.interpolate import PchipInterpolator

_RESTITUTIONS = 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1
_THOUSANDTHS = 482, 580, 678, 771, 853, 920, 970, 1002, 1011, 1016, 1017, 1015, 1010, 1000
SQUARES = {e: K / 1000 for e, K in zip(_RESTITUTIONS, _THOUSANDTHS, strict=True)}  # K^2
_SQUARE = PchipInterpolator(list(SQUARES), list(SQUARES.values()))


def contact_speed(restitution: float) -> float:
    """Return K for a restitution from 0 to 1: the root of Theta_c/Theta, to 0.001."""
    return math.sqrt(float(_SQUARE(restitution)))
