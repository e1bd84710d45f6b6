r"""The exact stationary state at e = 1: the Gibbs measure of ordered points.

Elastic collisions conserve the Gibbs measure, so in the reduced coordinate the stationary state is

    P(y, v) ~ exp(-sum_i U(y_i - y0_i)/T) exp(-sum_i m v_i^2 / 2T)    on  y_1 <= ... <= y_L.

Every velocity is therefore Gaussian with exactly the free width W, for any gap and any spring. The
positions are a Markov chain along the labels. With w(d) = exp(-U(d)/T),

    forward      Z_i(y) = int_{-inf}^{y} w(z - y0_i) Z_{i-1}(z) dz,      Z_0 = 1,
    backward     Z_{L-i}(-y)                                             (the chain is symmetric),
    density      phi_i(y) = w(y - y0_i) Z_{i-1}(y) Z_{L-i}(-y) / Z.

Without a gap phi_i is the density of the i-th order statistic of L draws from w. For linear springs
with a gap this is the one-dimensional one-component plasma (R. J. Baxter, Math. Proc. Camb. Phil.
Soc. 59, 779 (1963)).

The integrals are on one uniform grid in y and are kept as logarithms, because the Z_i span hundreds
of decades. Within a cell the logarithm of the integrand is a parabola, which stays accurate if the
integrand changes by large factors from one node to the next. Z must be the same for every i.
Its spread is the residual that :func:`equilibrium` reports. ``between_walls.py`` has the same for a
chain in a box.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from crazybilliards.kinetic.accuracy import expected
from crazybilliards.kinetic.exact.between_walls import BoxRecursion, box_recursion, nodes_of
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_integer
from crazybilliards.model.grid import position_grid, require_resolved, thermal_reach
from crazybilliards.model.memory import require_memory
from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.model.vocabulary import OF_RODS, result
from crazybilliards.model.words import check_chain

# Grid nodes in the width of the narrowest rod, which is the middle one without a gap.
_NODES_PER_WIDTH = 10

_MOST_STATES = 10**15  # more than any memory holds, and still exact as a float


def equilibrium(chain: Chain) -> xr.Dataset:
    """Exact stationary state of the elastic chain: any gap, both springs, also in a box.

    It costs O(L^1.5) time and memory: 5 ms for L = 20, 1 s and 40 MB for L = 1000.

    Returns
    -------
    xarray.Dataset
        ``density`` and ``label`` over x; ``mean_displacement``, ``displacement_width`` and
        ``velocity_width`` over particle; in a box ``wall_force`` over wall.
        ``attrs["residual"]`` is the spread of log Z over the particles. It is normally 1e-6 or
        less, and relative errors are of this order.

    Raises
    ------
    ValueError
        If the restitution is not 1, if there is no steady state, or if L is so large (above
        some 10^4) that the recursion would not fit into memory: 8 bytes for each rod and each of
        its 150 sqrt(L) nodes.

    Examples
    --------
    >>> chain = Chain(size=2)  # without gap: the smaller and larger of two Gaussian draws
    >>> (equilibrium(chain).mean_displacement / chain.thermal_length).values.round(6)
    array([-0.56419,  0.56419])
    """
    check_chain(chain)
    return _in_vocabulary(chain, recursion_of(chain))


def _in_vocabulary(chain: Chain, recursion: Recursion | BoxRecursion) -> xr.Dataset:
    x = position_grid(chain)
    density, label = np.zeros((2, x.size))
    mean, width, log_z = np.zeros((3, chain.size))
    weights, at_the_walls = recursion.weights, []
    for i in range(chain.size):
        d, log_p = recursion.log_density(i)
        top = np.max(log_p)
        p = np.exp(log_p - top)
        total = (p * weights).sum()
        log_z[i] = top + np.log(total)
        p /= total
        at_the_walls += [p[0], p[-1]]
        mean[i] = d @ (p * weights)
        width[i] = np.sqrt((d - mean[i]) ** 2 @ (p * weights))
        _add_rod(x, chain.anchors[i] + d, p, density, label)
    spacing = recursion.nodes(0)[1] - recursion.nodes(0)[0]
    walls = {}
    if chain.box:
        reached = recursion.nodes(0)[-1] == chain.walls[1]  # by any rod
        ends = np.array([at_the_walls[0], at_the_walls[-1]]) if reached else np.zeros(2)
        walls["wall_force"] = ("wall", chain.temperature / spacing * ends)
    dataset = result(
        chain,
        {
            **walls,
            "density": ("x", density),
            "label": ("x", label),
            "mean_displacement": ("particle", mean),
            "displacement_width": ("particle", width),
            "velocity_width": ("particle", np.sqrt(chain.temperature / chain.rod_masses)),
        },
        coordinates={"x": x},
        source="theory",
        method={"theory": "exact equilibrium"},
        residual=float(np.ptp(log_z)),
    )
    dataset.attrs |= expected("equilibrium", chain).named()
    return dataset.assign_attrs(density_of=OF_RODS)


def equilibrium_states(chain: Chain, replicas: int, seed: Seed = 0) -> xr.Dataset:
    """Draw ``replicas`` independent states of the elastic chain in its stationary state.

    The recursion is sampled backwards: the last rod from Z_L, then each rod from Z_i, up to the
    position of its right neighbour. Velocities are independent Gaussians of width W. ``seed``
    is as in ``simulate``.

    Returns
    -------
    xarray.Dataset
        ``position`` and ``velocity`` over (replica, particle): the ``start`` of a simulation.
        It takes 40 bytes for each rod of each state.

    Raises
    ------
    ValueError
        As :func:`equilibrium`, and for a wrong ``replicas`` or ``seed``.
    """
    check_chain(chain)
    replicas = check_integer("replicas", replicas, least=1, most=_MOST_STATES)
    seed = seed_of(seed)
    generator = np.random.default_rng(seed)
    require_memory(f"replicas={replicas} of {chain.size} rods", 40.0 * replicas * chain.size)
    recursion = recursion_of(chain)
    y = np.empty((replicas, chain.size))
    below = np.full(replicas, np.inf)
    for i in reversed(range(chain.size)):
        nodes = recursion.nodes(i)
        log_f = recursion.log_z(i)
        # 1 - U lies in (0, 1]: its logarithm is finite.
        target = np.interp(below, nodes, log_f) + np.log1p(-generator.random(replicas))
        # Linear in log Z_i between nodes, in both directions, so that the order is kept exactly.
        y[:, i] = below = np.minimum(np.interp(target, log_f, nodes), below)
    velocity = np.sqrt(chain.temperature / chain.rod_masses) * generator.standard_normal(
        (replicas, chain.size)
    )
    dims = ("replica", "particle")
    return result(
        chain,
        {"position": (dims, chain.physical(y)), "velocity": (dims, velocity)},
        source="theory",
        method={"theory": "exact equilibrium, sampled", "seed": seed},
    )


@dataclass(frozen=True)
class Recursion:
    """log Z_i on each rod's own window of the common grid y = j h, |y - y0_i| <= reach."""

    chain: Chain
    spacing: float
    centres: NDArray[np.int64]  # node nearest to each anchor; antisymmetric in the label
    half: int  # nodes of a window to either side of its centre
    log_f: Array  # shape (L, 2 half + 1)

    def nodes(self, i: int) -> Array:
        """Return the grid on window i."""
        first = self.centres[i] - self.half
        return self.spacing * np.arange(first, first + 2 * self.half + 1)

    weights = 1.0  # of the nodes in a sum over the grid, where the density ends at 0

    def log_z(self, i: int) -> Array:
        """Return log Z of the rods up to number i, counted from 0, on the window of i."""
        return np.asarray(self.log_f[i])

    def log_weight(self, i: int) -> tuple[Array, Array]:
        """Displacements d on window i (i from 0) and log w(d) = -U(d)/T."""
        d = self.nodes(i) - self.chain.reduced_anchors[i]
        return d, -self.chain.potential(d) / self.chain.temperature

    def log_below(self, i: int) -> Array:
        """Log Z of the rod before i on the window of i; constant beyond its own window."""
        if i == 0:
            return np.zeros(2 * self.half + 1)
        shift = min(self.centres[i] - self.centres[i - 1], 2 * self.half)
        return np.pad(self.log_f[i - 1][shift:], (0, shift), mode="edge")

    def log_density(self, i: int) -> tuple[Array, Array]:
        """Displacements on window i and the logarithm of phi_i, not normalised."""
        d, log_w = self.log_weight(i)
        mirrored = self.log_below(self.chain.size - 1 - i)[::-1]
        return d, log_w + self.log_below(i) + mirrored


def check_equilibrium(chain: Chain) -> None:
    """Raise the ValueError that :func:`equilibrium` would raise, without the computation."""
    remedy = "; chain.replace(restitution=1) is the elastic chain"
    require_chain(
        chain, "the exact equilibrium", elastic=True, remedy=remedy, knows=WALLS_AND_MASSES
    )
    require_resolved(chain, float(chain.reduced_anchors[-1]))
    rods, nodes = nodes_of(chain) if chain.box else (chain.size, 2 * _half_window(chain) + 1)
    require_memory(
        f"size={chain.size} (force_balance takes more): the exact equilibrium", 8.0 * rods * nodes
    )


def _half_window(chain: Chain) -> int:
    """Return the nodes to either side of a rod's anchor."""
    # Width of the middle order statistic, 1/(2 phi(0) sqrt(L)), or of one free rod if smaller.
    narrowest = chain.thermal_length * min(1.0, 1.25 / np.sqrt(chain.size))
    return int(np.ceil(thermal_reach(chain) / narrowest * _NODES_PER_WIDTH))


def recursion_of(chain: Chain) -> Recursion | BoxRecursion:
    """Compute log Z_i of all rods."""
    check_equilibrium(chain)
    if chain.box:
        return box_recursion(chain)
    reach, half = thermal_reach(chain), _half_window(chain)
    spacing = reach / half
    # Rounding halves to even keeps the centres antisymmetric, as log_density needs.
    centres = np.rint(chain.reduced_anchors / spacing).astype(np.int64)
    log_f = np.empty((chain.size, 2 * half + 1))
    recursion = Recursion(chain, spacing, centres, half, log_f)
    for i in range(chain.size):
        log_f[i] = _log_cumulative(recursion.log_weight(i)[1] + recursion.log_below(i))
    return recursion


def _log_cumulative(phi: Array) -> Array:
    """Logarithm of the cumulative integral of exp(phi) on a uniform grid, from -infinity.

    The spacing is the unit of length. In each cell phi is the parabola through its ends with the
    curvature c of the neighbourhood:
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
    cells = (phi[1:] + phi[:-1]) / 2 + log_sinhc - c * r / 2
    # Left of the grid the integrand falls off exponentially, at the rate of the first cell.
    tail = phi[0] - np.log(max(a[0], 1e-300))
    return np.logaddexp.accumulate(np.concatenate([[tail], cells]))


def _add_rod(x: Array, centres: Array, p: Array, density: Array, label: Array) -> None:
    """Add one rod's probabilities ``p`` at positions ``centres`` to density and label on x."""
    likely = np.flatnonzero(p > 1e-20 * np.max(p))
    window = slice(max(likely[0] - 2, 0), likely[-1] + 3)
    positions = centres[window]
    curve = CubicSpline(positions, p[window] / (positions[1] - positions[0]))
    cumulative = curve.antiderivative()
    # Both ends belong to the rod: at a wall, where it may be on a node, its density is not 0.
    first, last = np.searchsorted(x, positions[0]), np.searchsorted(x, positions[-1], "right")
    density[first:last] += curve(x[first:last])
    label[first:last] += cumulative(x[first:last]) / cumulative(positions[-1])
    label[last:] += 1
