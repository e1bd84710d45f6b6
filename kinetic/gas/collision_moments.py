r"""What one collision does to the moments of two rods, averaged over Gaussian velocities.

In the picture of points two of them, with velocities v and u, pass each other and keep

    v* = v - lambda (v - u),      u* = u + lambda (v - u),      lambda = (1 - e)/2.

Points pass each other at a rate proportional to |v - u|. For functions psi and phi a collision of
two points, independent before it, makes the covariance

    [psi, phi] = < |v - u| ( psi(v*) phi(u*) - psi(v) phi(u) ) >,

the average being over two Gaussians of variance 1. With the Hermite polynomials H2(v) = v^2 - 1 and
H3(v) = v^3 - 3v these numbers are the noise of the pair correlations:

    energy          -< |v-u| (v*^2 + u*^2 - v^2 - u^2)/2 > = [v, u] = (2/sqrt(pi)) (1 - e^2),
    temperature     [H2, H2],         heat      [H3, H3],       velocity_heat   [v, H3].

The first two expressions are equal because a collision conserves momentum. The decay of the third
moment is the linear response of <H3> to a distribution with the weight 1 + <H3> H3/6:

    decay = -< |v-u| (H3(v*) - H3(v)) (H3(v) + H3(u))/6 >.

All of this holds for e > 1 too, where energy and decay are negative.

**Two masses.** Equal elastic rods only exchange their velocities, and decay = 0. If their masses
are m and M, an elastic collision rotates v and u, the velocities times the roots of the masses,

    v* = d v + r u,      u* = r v - d u,      d = (m - M)/(m + M),      r^2 = 1 - d^2,

and the mean third moment of both sorts decays. At equal temperatures, in units of the mean mass,

    decay = -< |v/sqrt(m) - u/sqrt(M)| (H3(v*) + H3(u*) - H3(v) - H3(u)) (H3(v) + H3(u)) >/12.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from crazybilliards.model import Array

_MOST = 1e6
_NODES = 24  # exact for polynomials up to this degree in w^2 and in v + u; 6 is needed


class CollisionMoments(NamedTuple):
    """Numbers of one collision at variance 1; see the module."""

    energy: float
    temperature: float
    heat: float
    velocity_heat: float
    decay: float


def moments_of_collisions(restitution: float) -> CollisionMoments:
    """Return the moments for a restitution from 0 to a million; all vanish at 1."""
    if restitution > _MOST:  # to the sixth power it would be beyond doubles
        raise ValueError(f"the gas needs a restitution of at most {_MOST:g}, got {restitution:g}")
    v, u, average = _colliding()
    share = (1 - restitution) / 2
    after, partner = v - share * (v - u), u + share * (v - u)
    return CollisionMoments(
        energy=2 / math.sqrt(math.pi) * (1 - restitution**2),
        temperature=average(_second(after) * _second(partner) - _second(v) * _second(u)),
        heat=average(_third(after) * _third(partner) - _third(v) * _third(u)),
        velocity_heat=average(after * _third(partner) - v * _third(u)),
        decay=average(-(_third(after) - _third(v)) * (_third(v) + _third(u)) / 6),
    )


def decay_of_two_masses(mass_ratio: float) -> float:
    """Return the decay of the third moment in elastic collisions of rods with this ratio M/m."""
    light = 2 / (1 + mass_ratio)
    heavy = mass_ratio * light
    d = (light - heavy) / (light + heavy)
    r = math.sqrt(1 - d**2)
    v, u, average = _colliding(1 / math.sqrt(light), 1 / math.sqrt(heavy))
    before = _third(v) + _third(u)
    lost = before - _third(d * v + r * u) - _third(r * v - d * u)
    return average(lost * before / 12)


def _second(v: Array) -> Array:
    return v**2 - 1


def _third(v: Array) -> Array:
    return v**3 - 3 * v


def _colliding(a: float = 1.0, b: float = 1.0) -> tuple[Array, Array, Callable[[Array], float]]:
    """Return velocities v and u, and < |a v - b u| f(v, u) > as a function of f there.

    It is exact for polynomials. (a v - b u)/g = R and (b v + a u)/g = S, with g^2 = a^2 + b^2, are
    independent Gaussians; int over R > 0 of R exp(-R^2/2) is that of exp(-t) over t = R^2/2.
    """
    S, S_weights = np.polynomial.hermite_e.hermegauss(_NODES)
    t, t_weights = np.polynomial.laguerre.laggauss(_NODES)
    g = math.hypot(a, b)
    weights = S_weights[:, None] * t_weights / (2 * math.pi) * g
    S, R = S[:, None], np.stack([np.sqrt(2 * t), -np.sqrt(2 * t)])[:, None]

    def average(values: Array) -> float:
        return float((weights * values).reshape(2, -1).sum(axis=1).sum())

    return (b * S + a * R) / g, (a * S - b * R) / g, average
