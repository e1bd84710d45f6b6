r"""The Gibbs measure of ``gibbs_measure.py`` between two walls, at y = -h and h.

The same recursion holds with y from -h on: Z_i(-h) = 0. If all rods have the same weight w, because
there is no gap or there are no springs, it is solved by

    Z_i(y) = F(y)^i / i!,      F(y) = int_{-h}^{y} w(z) dz,

so that the positions are those of L independent draws from w, in order. Without springs they are
spread evenly, and rod i of L has the Beta law of the places 2h Beta(i, L + 1 - i). Masses do not
matter, since positions and velocities are independent: W_i^2 = T/m_i.

A wall takes the momentum that the outermost rod brings, so the force on it, which in one dimension
is the pressure, is T times the density of that rod at the wall. Without springs it is

    P = L T/(X - 2RL),

that of an ideal gas of points in the free length (L. Tonks, Phys. Rev. 50, 955, 1936).

All functions are on one grid that ends at the walls. In each cell the integrand f is the cubic with
its values and derivatives at the ends,

    f' = -f U'(d)/T + w f_{i-1},      f = w Z_{i-1},

and sums over the whole grid have Gregory's weights of fourth order at the walls.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import thermal_reach

_NODES, _RESOLUTION = 3000, 20  # in all, and in the length in which the density falls by e
_GREGORY = np.array([3 / 8, 7 / 6, 23 / 24])  # weights of the nodes at a wall
_STEEPEST = 5.0  # of f'/f in a cell; where it is steeper Z_i is negligible


def weights(nodes: int) -> Array:
    """Return the weights of evenly spaced nodes in a sum that is an integral, in spacings."""
    found = np.ones(nodes)
    found[:3], found[-3:] = _GREGORY, _GREGORY[::-1]
    return found


@dataclass(frozen=True)
class BoxRecursion:
    """log Z_i of all rods on the grid between the walls."""

    chain: Chain
    y: Array
    log_f: Array  # shape (L, nodes), or that of log F, shape (1, nodes), if all weights are equal

    def log_weight(self, i: int) -> Array:
        """Return log w = -U(d)/T of rod i, counted from 0."""
        return (
            -self.chain.potential(self.y - self.chain.reduced_anchors[i]) / self.chain.temperature
        )

    def log_z(self, i: int) -> Array:
        """Return log Z of the rods up to number i, counted from 0; of none at -1."""
        if i < 0:
            return np.zeros(self.y.size)
        if len(self.log_f) == 1:
            return (i + 1) * self.log_f[0] - gammaln(i + 2)
        return np.asarray(self.log_f[i])

    def nodes(self, i: int) -> Array:
        """Return the grid, which all rods share."""
        return self.y

    @property
    def weights(self) -> Array:
        """The weights of the nodes in a sum over the grid."""
        return weights(self.y.size)

    def log_density(self, i: int) -> tuple[Array, Array]:
        """Return displacements of rod i and the logarithm of their density, not normalised."""
        mirrored = self.log_z(self.chain.size - 2 - i)[::-1]
        log_p = self.log_weight(i) + self.log_z(i - 1) + mirrored
        return self.y - self.chain.reduced_anchors[i], log_p


def _end(chain: Chain) -> float:
    """Return where the grid ends: at the wall, or where the springs let no rod come."""
    reach = thermal_reach(chain) if chain.stiffness > 0 else np.inf
    return min(chain.walls[1], float(chain.reduced_anchors[-1]) + reach)


def nodes_of(chain: Chain) -> tuple[int, int]:
    """Return the shape of the table of :func:`box_recursion`."""
    end = _end(chain)
    # Of the outermost rods: the walls push them back, and so do springs whose anchors are outside.
    outside = np.maximum(np.abs(chain.reduced_anchors) - end, 0.0)
    steepest = chain.size / (2 * end) + chain.force(outside).sum() / (2 * chain.temperature)
    if chain.stiffness > 0:
        steepest += 4 / chain.thermal_length
    return (1 if chain.exchangeable else chain.size), 1 + math.ceil(
        max(_NODES, _RESOLUTION * 2 * end * steepest)
    )


def box_recursion(chain: Chain) -> BoxRecursion:
    """Compute log Z_i of all rods between the walls."""
    rods, nodes = nodes_of(chain)
    end = _end(chain)
    recursion = BoxRecursion(chain, np.linspace(-end, end, nodes), np.empty((rods, nodes)))
    spacing = recursion.y[1] - recursion.y[0]
    before = np.zeros(nodes)  # f/Z of the rod before
    for i in range(rods):
        displacement = recursion.y - chain.reduced_anchors[i]
        log_w = recursion.log_weight(i)
        phi = log_w + recursion.log_z(i - 1)
        rise = spacing * (before - chain.force(displacement) / chain.temperature)
        rise = np.clip(rise, -_STEEPEST, _STEEPEST) / 12
        low, high = np.log(0.5 + rise[:-1]), np.log(0.5 - rise[1:])
        cells = np.logaddexp(phi[:-1] + low, phi[1:] + high)
        if i == 1:  # here f = 0, and f' is not
            first = log_w[0] + recursion.log_weight(0)[0] + np.log(spacing / 12)
            cells[0] = np.logaddexp(first, phi[1] + high[0])
        recursion.log_f[i, 0] = -np.inf
        recursion.log_f[i, 1:] = np.logaddexp.accumulate(cells + np.log(spacing))
        before[1:] = np.exp(phi[1:] - recursion.log_f[i, 1:])
    return recursion
