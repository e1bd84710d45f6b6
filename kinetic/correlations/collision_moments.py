r"""What one collision does to the moments of two rods, averaged over Gaussian velocities.

In the picture of :mod:`..kinetic_equation.weak_form` two points with velocities v and u pass each
other and keep

    v* = v - lambda (v - u),      u* = u + lambda (v - u),      lambda = (1 - e)/2.

Points pass each other at a rate proportional to |v - u|. For functions psi and phi a collision of
two points, independent before it, makes the covariance

    [psi, phi] = < |v - u| ( psi(v*) phi(u*) - psi(v) phi(u) ) >,

the average being over two Gaussians of variance 1. With the Hermite polynomials H2(v) = v^2 - 1 and
H3(v) = v^3 - 3v these numbers are the noise of the pair correlations:

    energy          -< |v-u| (v*^2 + u*^2 - v^2 - u^2)/2 > = [v, u] = (2/sqrt(pi)) (1 - e^2),
    temperature     [H2, H2],         heat      [H3, H3],       velocity_heat   [v, H3].

That the first two expressions are equal is conservation of momentum: the energy that a collision
takes from the two points goes into their covariance. The decay of the third moment is the linear
response of <H3> to a distribution with the weight 1 + <H3> H3/6:

    decay = -< |v-u| (H3(v*) - H3(v)) (H3(v) + H3(u))/6 >.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from crazybilliards.model.arrays import Array

_NODES = 24  # exact for polynomials up to this degree in w^2 and in v + u; 6 is needed


class CollisionMoments(NamedTuple):
    """Numbers of one collision at variance 1; see the module."""

    energy: float
    temperature: float
    heat: float
    velocity_heat: float
    decay: float


def moments_of_collisions(restitution: float) -> CollisionMoments:
    """Return the moments for a restitution between 0 and 1; all vanish at 1."""
    share = (1 - restitution) / 2

    def exchanged(v: Array, u: Array) -> tuple[Array, Array]:
        return v - share * (v - u), u + share * (v - u)

    def covariance(psi: Callable[[Array], Array], phi: Callable[[Array], Array]) -> float:
        def made(v: Array, u: Array) -> Array:
            after, partner = exchanged(v, u)
            return psi(after) * phi(partner) - psi(v) * phi(u)

        return _average(made)

    def lost(v: Array, u: Array) -> Array:
        return -(_third(exchanged(v, u)[0]) - _third(v)) * (_third(v) + _third(u)) / 6

    return CollisionMoments(
        energy=2 / math.sqrt(math.pi) * (1 - restitution**2),
        temperature=covariance(_second, _second),
        heat=covariance(_third, _third),
        velocity_heat=covariance(lambda v: v, _third),
        decay=_average(lost),
    )


def _second(v: Array) -> Array:
    return v**2 - 1


def _third(v: Array) -> Array:
    return v**3 - 3 * v


def _average(function: Callable[[Array, Array], Array]) -> float:
    """Return < |v - u| function(v, u) > over two Gaussians of variance 1, exactly for polynomials.

    The sum and the difference, (v +- u)/sqrt(2) = S and R, are independent Gaussians; int over
    R > 0 of R exp(-R^2/2) is that of exp(-t) over t = R^2/2.
    """
    S, S_weights = np.polynomial.hermite_e.hermegauss(_NODES)
    t, t_weights = np.polynomial.laguerre.laggauss(_NODES)
    R = np.sqrt(2 * t)
    weights = S_weights[:, None] * t_weights / (2 * math.pi) * math.sqrt(2)
    total = 0.0
    for sign in (1, -1):
        v, u = (S[:, None] + sign * R) / math.sqrt(2), (S[:, None] - sign * R) / math.sqrt(2)
        total += float((weights * function(v, u)).sum())
    return total
