r"""Displacement widths for e != 1: long waves of the chain are warmer than the rods within them.

Noise feeds every wave of the chain alike, and collisions, which conserve momentum, cool the short
ones. Units: free rod, T = k = m = 1; Gamma: damping. The wave q has the temperature

    T_q = Theta + (1 - Theta)/(1 + xi^2 D_q),      D_q = 2 - 2 cos(pi q/L),

that of the noise for the centre of mass, q = 0, whatever e is, and the relative temperature Theta
of neighbours for the shortest ones. Between the two the viscosity of a gas that cools decides. With
the mean distance a of neighbouring points, n = 1/a, and W_v^2 for the velocity variance of a rod,
collisions take Q = 2 Gamma (1 - W_v^2), what the noise brings. A compression heats the gas, and the
heat is gone at the rate 2 Gamma + 3/2 Q/Theta. Until then its pressure resists. As a viscosity,
over Gamma, this is

    xi^2 = (2 Theta/a^2)/(Gamma (2 Gamma + 3/2 Q/Theta)).

The mean of T_q is the mean W_v^2. This fixes Theta, for each rod by its own W_v. xi^2 is at least
what it is for Theta = 0. The stiffness of the wave is 1 + kappa D_q with kappa = W_v^2/a^2. The
points of a theory have the same temperature w^2 in all waves, W_v^2 less the centre of mass, and
the widths b_i. So

    W_x(i)^2 = b_i^2 + sum over waves of c_q(i)^2 (T_q - w^2)/(1 + kappa D_q).

This is exact at e = 1, and where rods do not meet. a, kappa, xi, Theta and w are those of the
place: the D_q are a matrix of differences along the chain, and both denominators its tridiagonal
functions. Nothing is fitted.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded

from crazybilliards.kinetic.rods.places import RodPlaces
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_PASSES = 2  # Theta in xi is W_v^2 at first
_LEAST = 0.05  # of W_v^2, Theta in xi
_SAME = 1e-12


def displacement_widths(chain: Chain, points: RodPlaces, velocity_variance: Array) -> Array:
    """Return W_x [R] of rods with these W_v^2 [R^2/t_0^2], on linear springs.

    ``points``: where the rods of independent points are. The time is O(L^2).
    """
    s, L, damping = chain.thermal_length, chain.size, chain.relative_damping
    if L == 1:
        return points.width()
    T = velocity_variance / chain.free_velocity_width**2
    between, gap = (T[1:] + T[:-1]) / 2, np.diff(points.mean()) / s
    soft = _inverse(between / gap**2)
    relative = between
    for _ in range(_PASSES):
        cooling = 2 * relative + 3 * np.maximum(1 - between, 0.0)
        viscous = 2 * relative**2 / (gap * damping) ** 2 / cooling
        warm = _inverse(np.maximum(viscous, np.maximum(1 / between**2 - 1, 0.0) / 4))
        share = np.diag(warm)
        Theta = np.maximum((T - share) / np.maximum(1 - share, _SAME), 0.0)
        relative = np.maximum((Theta[1:] + Theta[:-1]) / 2, _LEAST * between)
    of_points = (T - 1 / L) / (1 - 1 / L)
    waves = (1 - Theta) * (warm * soft).sum(axis=1)  # the diagonal of the product
    return s * np.sqrt((points.width() / s) ** 2 + waves + (Theta - of_points) * np.diag(soft))


def _inverse(strength: Array) -> Array:
    """Return the inverse of 1 + d' strength d, d being the difference of neighbours."""
    diagonal = 1 + np.append(0, strength) + np.append(strength, 0)
    bands = np.array([np.append(0, -strength), diagonal])
    return np.asarray(solveh_banded(bands, np.eye(diagonal.size)))
