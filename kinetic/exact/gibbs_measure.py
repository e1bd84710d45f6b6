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
"""

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from crazybilliards.kinetic.accuracy import expected
from crazybilliards.kinetic.exact.recursion import recursion_of
from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import check_chain, check_integer, require_memory
from crazybilliards.model.grid import position_grid
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.model.vocabulary import OF_RODS, result

_MOST_STATES = 10**15  # more than any memory holds, and still exact as a float


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
    check_chain(chain)
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
    ).assign_attrs(expected("equilibrium", chain).named(), density_of=OF_RODS)


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
    check_chain(chain)
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
