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

All functions are on one grid that ends at the walls, where integrals are sums of trapezoids.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_NODES, _NODES_PER_ROD = 4000, 20  # the outermost rod is within some 2h/L of its wall


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

    def log_density(self, i: int) -> tuple[Array, Array]:
        """Return displacements and the logarithm of the weight of each node, not normalised."""
        mirrored = self.log_z(self.chain.size - 2 - i)[::-1]
        log_p = self.log_weight(i) + self.log_z(i - 1) + mirrored
        log_p[[0, -1]] -= np.log(2.0)  # trapezoids
        return self.y - self.chain.reduced_anchors[i], log_p


def nodes_of(chain: Chain) -> tuple[int, int]:
    """Return the shape of the table of :func:`box_recursion`."""
    alike = chain.gap * chain.stiffness == 0
    return (1 if alike else chain.size), 1 + max(_NODES, _NODES_PER_ROD * chain.size)


def box_recursion(chain: Chain) -> BoxRecursion:
    """Compute log Z_i of all rods between the walls."""
    rods, nodes = nodes_of(chain)
    recursion = BoxRecursion(chain, np.linspace(*chain.walls, nodes), np.empty((rods, nodes)))
    for i in range(rods):
        phi = recursion.log_weight(i) + recursion.log_z(i - 1)
        spacing = recursion.y[1] - recursion.y[0]
        cells = np.logaddexp(phi[1:], phi[:-1]) + np.log(spacing / 2)
        recursion.log_f[i, 0] = -np.inf
        recursion.log_f[i, 1:] = np.logaddexp.accumulate(cells)
    return recursion
