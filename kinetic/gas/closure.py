r"""From the fluctuations of the gas to its mean state: the strength of collisions, shared motion.

**Collective motion.** Whole neighbourhoods move together: the displacement u of a place has the
variance h_uu, and its velocity has K times it, as the waves that displace rods far are hardly
faster than the spring of stiffness K. The mean state describes rods within their neighbourhood, so

    W_v^2 = T + K h_uu,      noise of the mean state:  2 Gamma (1 - K h_uu) in place of 2 Gamma.

For the centre of mass alone, K h_uu = 1/L. Without springs nothing pulls a neighbourhood back, and
it shares no motion of this kind.

**What collisions take.** At the relative speed w a collision has the impulse (1 + e) w/2 and takes
(1 - e^2) w^2/2 from the sum of v^2. So with the means over the collisions of a contact

    Lambda = (1 - e) P <w^2>/<w> = (4/sqrt(pi)) (1 - e) P K F sqrt(Theta),

where Theta = W_v^2 - h_c is the relative temperature of all neighbours and h_c their covariance.
K(e), see below, says how much slower they are when they meet. h_c is the mean of two values: with
what the last collision of the two left, as half of all neighbours leave one another, and without
it, continued from pairs of rods further apart.

**Clustering.** P goes like Theta/g and Lambda like Theta^(3/2)/g, with g and Theta of the
neighbourhood, which fluctuate. To second order in the relative deviations their ratio has the mean

    F = 1 + 3/8 h_ThetaTheta - 1/2 h_gTheta,

the covariances being those of contacts next to each other. How much gaps fluctuate does not enter.

In the equations of the gas that is Lambda = a zeta n T^(3/2), with P = n T and

    a = 2/(1 + e) K F sqrt(Theta/T),

and 1 - 1/L times it for points at a label, which meet L - 1 others.

**How fast neighbours are when they meet.** If the relative velocities of rods that meet were
Gaussian, with the variance 2 Theta of all neighbours, then <w^2>/<w> over the collisions of a
contact would be (4/sqrt(pi)) sqrt(Theta). Inelastic neighbours meet more slowly, because a
collision takes their relative velocity. The ratio follows from the motion of one pair with the
distance r > 0 and the relative velocity w,

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
from typing import NamedTuple, Self

import numpy as np
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.gas.cells import at_distance
from crazybilliards.kinetic.gas.fluctuations import Background, PairCovariance
from crazybilliards.model import Array

_NEIGHBOUR = 1.0  # rod
_BEYOND = 2  # cells between two rods that have not hit one another
_LEAST = 0.02  # bound of Theta/T, b and 1 - K h_uu on the way; at the end they must be far from it

# K^2 of restitutions.
SQUARES = {
    0: 0.482,
    0.1: 0.580,
    0.2: 0.678,
    0.3: 0.771,
    0.4: 0.853,
    0.5: 0.920,
    0.6: 0.970,
    0.7: 1.002,
    0.75: 1.011,
    0.8: 1.016,
    0.85: 1.017,
    0.9: 1.015,
    0.95: 1.010,
    1: 1.000,
}
_SQUARE = PchipInterpolator(list(SQUARES), list(SQUARES.values()))


class Closure(NamedTuple):
    """The unknowns to agree on, at the M - 1 contacts, which are 0 in the mean field."""

    shared: Array  # h_c/W_v^2
    collective: Array  # K h_uu
    log_strength: Array  # ln b, b = 2 K F/(1 + e), the strength of collisions of rods with Theta

    @classmethod
    def of_mean_field(cls, contacts: Array) -> Self:
        """Return that of independent rods."""
        return cls(*np.zeros((3, contacts.size)))

    @classmethod
    def unpacked(cls, vector: Array) -> Self:
        """Return the unknowns of a vector, within their bounds."""
        shared, collective, strength = np.split(vector, 3)
        most = 1 - _LEAST
        return cls(np.minimum(shared, most), np.minimum(collective, most), strength)

    @property
    def is_possible(self) -> bool:
        """True if no unknown lies on one of the bounds to which ``implied`` keeps an iteration."""
        bounded = 1 - self.shared, 1 - self.collective, np.exp(self.log_strength)
        return min(float(values.min()) for values in bounded) > 2 * _LEAST

    def at(self, contacts: Array, labels: Array) -> Self:
        """Return those at other labels; a rod alone has none."""
        if contacts.size == 0:
            return self.of_mean_field(labels)
        return type(self)(*(np.interp(labels, contacts, values) for values in self))

    def relative_temperature(self, T: Array) -> Array:
        """Return Theta of contacts where the mean state has T."""
        return (T + self.collective) * (1 - self.shared)

    def strength(self, T: Array) -> Array:
        """Return a at the contacts, for rods."""
        return np.exp(self.log_strength) * np.sqrt(self.relative_temperature(T) / T)


def implied(state: Background, pairs: PairCovariance) -> Closure:
    """Return the unknowns that follow from the fluctuations about a state."""
    cells, e = state.cells, state.medium.restitution
    leaving, approaching = (
        at_distance(pairs.velocity, cells.centres, cells.contacts, _NEIGHBOUR, nearest)
        for nearest in (1, _BEYOND)
    )
    variance = (state.temperature + state.shared)[cells.inner]
    stiffness = np.interp(cells.contacts, cells.centres, state.stiffness)
    displaced = at_distance(pairs.displacement, cells.centres, cells.contacts, 0.0)
    mixed, temperature = (
        at_distance(field, cells.contacts, cells.contacts, _NEIGHBOUR)
        for field in (pairs.gap_temperature, pairs.temperature)
    )
    clustering = np.maximum(_even(1 + 0.375 * temperature - 0.5 * mixed), _LEAST)
    return Closure(
        np.minimum(_even((leaving + approaching) / 2 / variance), 1 - _LEAST),
        np.minimum(_even(stiffness * displaced), 1 - _LEAST),
        np.log(2 / (1 + e) * contact_speed(e) * clustering),
    )


def _even(values: Array) -> Array:
    """Average over a contact and its mirror image: rounding must not break the symmetry."""
    return (values + values[::-1]) / 2


def contact_speed(restitution: float) -> float:
    """Return K for a restitution from 0 to 1: the root of Theta_c/Theta, to 0.001."""
    return math.sqrt(float(_SQUARE(restitution)))
