r"""The recursion of :mod:`.gibbs_measure` on a grid: log Z_i of all rods.

The integrals are on one uniform grid in y and are kept as logarithms, because the Z_i span hundreds
of decades. Without walls every rod has a window of it around its anchor; Z_i is constant beyond.
Within a cell the logarithm of the integrand is a parabola, which stays accurate if the integrand
changes by large factors. Sums over the grid have Gregory's weights of fourth order at the walls.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import WALLS_AND_MASSES, Array, Chain
from crazybilliards.model.checks import require_memory
from crazybilliards.model.grid import require_resolved, thermal_reach

# Grid nodes in the width of the narrowest rod, which is the middle one without a gap.
_NODES_PER_WIDTH = 10
# Between walls: in all, and in the length in which the density falls by e.
_NODES, _RESOLUTION = 3000, 20
_GREGORY = np.array([3 / 8, 7 / 6, 23 / 24])  # weights of the nodes at an end


@dataclass(frozen=True)
class Recursion:
    """log Z_i on the windows of all rods, numbered from 0, in the common grid y = j h."""

    chain: Chain
    spacing: float  # h
    first: NDArray[np.int64]  # node of each window; antisymmetric in the label but for the width
    log_f: Array  # shape (L, nodes), or that of log F, shape (1, nodes), if all weights are equal

    def nodes(self, i: int) -> Array:
        """Return the grid on window i."""
        return self.spacing * (self.first[i] + np.arange(self.log_f.shape[1]))

    def log_z(self, i: int) -> Array:
        """Return log Z of the rods up to number i on the window of i; spacings are its lengths."""
        if self.chain.exchangeable:
            return np.asarray((i + 1) * self.log_f[0] - gammaln(i + 2))
        return np.asarray(self.log_f[i])

    def log_weight(self, i: int) -> Array:
        """Return log w = -U(d)/T of rod i."""
        d = self.nodes(i) - self.chain.reduced_anchors[i]
        return -self.chain.potential(d) / self.chain.temperature

    def log_below(self, i: int) -> Array:
        """Return log Z of the rods before i on the window of i; constant beyond their own."""
        if i == 0:
            return np.zeros(self.log_f.shape[1])
        shift = min(self.first[i] - self.first[i - 1], self.log_f.shape[1] - 1)
        return np.pad(self.log_z(i - 1)[shift:], (0, shift), mode="edge")

    def distribution(self, i: int) -> tuple[Array, Array, Array, float]:
        """Return displacements of rod i, their density phi_i, their shares in means, and log Z."""
        log_p = self.log_weight(i) + self.log_below(i)
        log_p += self.log_below(self.chain.size - 1 - i)[::-1]
        p = np.exp(log_p - log_p.max())
        total = weights(p.size) @ p
        d, density = self.nodes(i) - self.chain.reduced_anchors[i], p / (self.spacing * total)
        share = self.spacing * weights(p.size) * density
        return d, density, share, float(log_p.max() + np.log(total))


def weights(nodes: int) -> Array:
    """Return the weights of evenly spaced nodes in a sum that is an integral, in spacings."""
    found = np.ones(nodes)
    found[:3], found[-3:] = _GREGORY, _GREGORY[::-1]
    return found


def check_equilibrium(chain: Chain) -> None:
    """Raise the ValueError that :func:`equilibrium` would raise, without the computation."""
    remedy = "; chain.replace(restitution=1) is the elastic chain"
    require_chain(
        chain, "the exact equilibrium", elastic=True, remedy=remedy, knows=WALLS_AND_MASSES
    )
    require_resolved(chain, float(chain.reduced_anchors[-1]))
    # Without walls it refuses, too, what would take as long as a table that is larger than memory.
    rods = 1 if chain.exchangeable and chain.box else chain.size
    require_memory(
        f"size={chain.size} (force_balance takes more): the exact equilibrium",
        8.0 * rods * (2 * _window(chain)[1] + 1),
    )


def _window(chain: Chain) -> tuple[float, int]:
    """Return half the length of a window, and the nodes to either side of its middle."""
    reach = thermal_reach(chain)
    if not chain.box:
        # Width of the middle order statistic, 1/(2 phi(0) sqrt(L)), or of one free rod if smaller.
        narrowest = chain.thermal_length * min(1.0, 1.25 / np.sqrt(chain.size))
        return reach, math.ceil(reach / narrowest * _NODES_PER_WIDTH)
    # All rods share one window, up to the walls or to where the springs let no rod come.
    end = min(chain.walls[1], float(chain.reduced_anchors[-1]) + reach)
    # Of the outermost rods: the walls push them back, and so do springs whose anchors are outside.
    outside = np.maximum(np.abs(chain.reduced_anchors) - end, 0.0)
    steepest = chain.size / (2 * end) + chain.force(outside).sum() / (2 * chain.temperature)
    steepest += 4 / chain.thermal_length
    return end, math.ceil(max(_NODES / 2, _RESOLUTION * end * steepest))


def recursion_of(chain: Chain) -> Recursion:
    """Compute log Z_i of all rods."""
    check_equilibrium(chain)
    length, half = _window(chain)
    spacing = length / half
    # Rounding halves to even keeps the middles antisymmetric, as ``distribution`` needs.
    middles = np.zeros(chain.size) if chain.box else np.rint(chain.reduced_anchors / spacing)
    rods = 1 if chain.exchangeable else chain.size
    log_f = np.empty((rods, 2 * half + 1))
    recursion = Recursion(chain, spacing, middles.astype(np.int64) - half, log_f)
    for i in range(rods):
        phi = recursion.log_weight(i) + recursion.log_below(i)
        from_zero = phi[0] == -np.inf
        cells = _log_cells(np.append(phi[1] if from_zero else phi[0], phi[1:]))
        if from_zero:  # exp(phi) begins as t^i
            t = np.arange(1.0, phi.size)
            exact = (i + 1) * np.log(t) + np.log1p(-((1 - 1 / t) ** (i + 1)))
            cells[1:] += exact[1:] - np.log(i + 1) - _log_cells(i * np.log(np.append(1.0, t)))[1:]
            cells[0] = phi[1] - np.log(i + 1)
        log_f[i] = np.logaddexp.accumulate(np.append(-np.inf, cells))
    return recursion


def _log_cells(phi: Array) -> Array:
    """Logarithms of the integrals of exp(phi) over the cells of a uniform grid.

    In each cell phi is the parabola through its ends with the curvature c of the neighbourhood:
    int_0^1 exp(a t - c t(1-t)/2) dt = exp(a/2) sinh(a/2)/(a/2) exp(-c r(a)/2) + O(c^2), where
    r = (a coth(a/2) - 2)/a^2 is the mean of t(1-t) under exp(a t).
    """
    a = np.diff(phi)
    c = np.pad((a[2:] - a[:-2]) / 2, 1, mode="edge")
    size = np.maximum(np.abs(a), 1e-3)  # below it the series are exact to rounding
    log_sinhc = np.where(
        np.abs(a) > 1e-3, size / 2 + np.log1p(-np.exp(-size)) - np.log(size), a**2 / 24
    )
    size = np.maximum(np.abs(a), 0.05)
    r = np.where(np.abs(a) > 0.05, (size / np.tanh(size / 2) - 2) / size**2, 1 / 6 - a**2 / 360)
    return np.asarray((phi[1:] + phi[:-1]) / 2 + log_sinhc - c * r / 2)
