r"""The exact stationary state at e = 1: the Gibbs measure of ordered points.

Elastic collisions conserve the Gibbs measure, so in the reduced coordinate the stationary state is

    P(y, v) ~ exp(-sum_i U(y_i - y0_i)/T) exp(-sum_i m_i v_i^2 / 2T)    on  y_1 <= ... <= y_L.

Every velocity is therefore Gaussian with exactly the free width, W_i^2 = T/m_i, for any gap, spring
and mass. The positions are a Markov chain along the labels. With w(d) = exp(-U(d)/T),

    forward      Z_i(y) = int_{-h}^{y} w(z - y0_i) Z_{i-1}(z) dz,      Z_0 = 1,
    backward     Z_{L-i}(-y)                                           (the chain is symmetric),
    density      phi_i(y) = w(y - y0_i) Z_{i-1}(y) Z_{L-i}(-y) / Z,

where h is the place of the right wall, or infinite. For linear springs with a gap and without walls
this is the one-dimensional one-component plasma (R. J. Baxter, Math. Proc. Camb. Phil. Soc. 59, 779
(1963)). If all rods have the same w, because there is no gap or there are no springs,

    Z_i(y) = F(y)^i / i!,      F(y) = int_{-h}^{y} w(z) dz:

the positions are those of L independent draws from w, in order. Without springs they are spread
evenly, and rod i of L has the Beta law of the places 2h Beta(i, L + 1 - i).

The force on a wall, which in one dimension is the pressure, is T times the density of the outermost
rod there. Without springs it is L T/(X - 2RL), that of an ideal gas of points in the free length
(L. Tonks, Phys. Rev. 50, 955, 1936).

**On a grid.** The integrals are on one uniform grid in y and are kept as logarithms, because the
Z_i span hundreds of decades. Without walls every rod has a window of it around its anchor; Z_i is
constant beyond. Within a cell the logarithm of the integrand is a parabola, which stays accurate if
the integrand changes by large factors. Sums over the grid have Gregory's weights of fourth order at
the walls.
"""

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.special import gammaln

from crazybilliards.kinetic.accuracy import errors_of_equilibrium
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import WALLS_AND_MASSES, Array, Chain
from crazybilliards.model.checks import check_integer, require_memory
from crazybilliards.model.grid import position_grid, require_resolved
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.model.vocabulary import OF_RODS, result

_MOST_STATES = 10**15  # more than any memory holds, and still exact as a float
# Grid nodes in the width of the narrowest rod, which is the middle one without a gap.
_NODES_PER_WIDTH = 10
# Between walls: in all, and in the length in which the density falls by e.
_NODES, _RESOLUTION = 3000, 20
_GREGORY = np.array([3 / 8, 7 / 6, 23 / 24])  # weights of the nodes at an end


def equilibrium(chain: Chain) -> xr.Dataset:
    """Exact stationary state of the elastic chain: any gap, both springs, also in a box.

    It costs O(L^1.5) time and memory: 5 ms for L = 20, 1 s and 40 MB for L = 1000.

    Returns
    -------
    xarray.Dataset
        ``density`` and ``label`` over x; ``mean_displacement``, ``displacement_width`` and
        ``velocity_width`` over particle; in a box ``wall_force`` over wall.
        ``attrs["residual"]``, the spread of log Z over the particles, is of the order of the
        relative errors and normally 1e-6 or less.

    Raises
    ------
    ValueError
        If the restitution is not 1, if there is no steady state, or if L (above some 10^4) is too
        large for the memory: 8 bytes for each rod and each of its 150 sqrt(L) nodes.

    Examples
    --------
    >>> chain = Chain(size=2)  # without gap: the smaller and larger of two Gaussian draws
    >>> (equilibrium(chain).mean_displacement / chain.thermal_length).values.round(6)
    array([-0.56419,  0.56419])
    """
    check_equilibrium(chain)
    recursion, x = recursion_of(chain), position_grid(chain)
    density, label = np.zeros((2, x.size))
    mean, width, log_z = np.zeros((3, chain.size))
    for i in range(chain.size):
        d, p, share, log_z[i] = recursion.distribution(i)
        mean[i] = d @ share
        width[i] = np.sqrt((d - mean[i]) ** 2 @ share)
        _add_rod(x, chain.anchors[i] + d, p, density, label)
    force = np.full(2, chain.temperature * recursion.distribution(0)[1][0])
    return result(
        chain,
        {
            **({"wall_force": ("wall", force)} if chain.box else {}),
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
    ).assign_attrs(errors_of_equilibrium(chain).named(), density_of=OF_RODS)


def equilibrium_states(chain: Chain, replicas: int, seed: Seed = 0) -> xr.Dataset:
    """Draw ``replicas`` independent states of the elastic chain in its stationary state.

    The recursion is sampled backwards: the last rod from Z_L, then each rod from Z_i, up to its
    right neighbour. Velocities are independent Gaussians. ``seed`` is as in ``simulate``.

    Returns
    -------
    xarray.Dataset
        ``position`` and ``velocity`` over (replica, particle), the ``start`` of a simulation, at 40
        bytes for each rod of each state.

    Raises
    ------
    ValueError
        As :func:`equilibrium`, and for a wrong ``replicas`` or ``seed``.
    """
    check_equilibrium(chain)
    replicas = check_integer("replicas", replicas, least=1, most=_MOST_STATES)
    seed = seed_of(seed)
    generator = np.random.default_rng(seed)
    require_memory(f"replicas={replicas} of {chain.size} rods", 40.0 * replicas * chain.size)
    recursion = recursion_of(chain)
    y = np.empty((replicas, chain.size))
    below = np.full(replicas, np.inf)
    for i in reversed(range(chain.size)):
        nodes, log_f = recursion.nodes(i), recursion.log_z(i)
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


def check_equilibrium(chain: Chain) -> None:
    """Raise the ValueError that :func:`equilibrium` would raise, without the computation."""
    require_chain(
        chain,
        "the exact equilibrium",
        elastic=True,
        knows=WALLS_AND_MASSES,
        remedy="; chain.replace(restitution=1) is the elastic chain",
    )
    require_resolved(chain, float(chain.reduced_anchors[-1]))
    _window(chain)


def _add_rod(x: Array, centres: Array, p: Array, density: Array, label: Array) -> None:
    """Add one rod's density ``p`` at positions ``centres`` to density and label on x."""
    likely = np.flatnonzero(p > 1e-20 * np.max(p))
    window = slice(max(likely[0] - 2, 0), likely[-1] + 3)
    positions = centres[window]
    curve = CubicSpline(positions, p[window])
    cumulative = curve.antiderivative()
    # Both ends belong to the rod: at a wall, where it may be on a node, its density is not 0.
    first, last = np.searchsorted(x, positions[0]), np.searchsorted(x, positions[-1], "right")
    density[first:last] += curve(x[first:last])
    label[first:last] += cumulative(x[first:last]) / cumulative(positions[-1])
    label[last:] += 1


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


def _window(chain: Chain) -> tuple[float, int]:
    """Return half the length of a window, and the nodes to either side of its middle.

    It is a ValueError if the windows of all rods are larger than the memory.
    """
    length = chain.thermal_reach
    if chain.box:
        # All rods share one window, up to the walls or to where the springs let no rod come.
        length = min(chain.walls[1], float(chain.reduced_anchors[-1]) + length)
        # The walls push the outermost rods back, and so do springs whose anchors are outside.
        outside = np.maximum(np.abs(chain.reduced_anchors) - length, 0.0)
        steepest = chain.size / (2 * length) + chain.force(outside).sum() / (2 * chain.temperature)
        steepest += 4 / chain.thermal_length
        half = math.ceil(max(_NODES / 2, _RESOLUTION * length * steepest))
    else:
        # Width of the middle order statistic, 1/(2 phi(0) sqrt(L)), or of one free rod if smaller.
        narrowest = chain.thermal_length * min(1.0, 1.25 / np.sqrt(chain.size))
        half = math.ceil(length / narrowest * _NODES_PER_WIDTH)
    # Without walls it refuses, too, what would take as long as a table that is larger than memory.
    rods = 1 if chain.exchangeable and chain.box else chain.size
    require_memory(
        f"size={chain.size} (force_balance takes more): the exact equilibrium",
        8.0 * rods * (2 * half + 1),
    )
    return length, half


def recursion_of(chain: Chain) -> Recursion:
    """Compute log Z_i of all rods of a chain that ``check_equilibrium`` lets pass."""
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
