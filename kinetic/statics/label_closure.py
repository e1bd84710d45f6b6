r"""The force balance closed by labels, a boundary-value problem without any input.

With the label N(x) = int rho, the mean displacement at x is <dx> = x - (2R + g)(N - L/2). In the
reduced coordinate y = x - 2R (N - L/2) the length of the rods drops out. The unit of length l is
the thermal length s = (T/k)^(1/n) (n: exponent of the spring's potential), or half the room between
the walls, X/2 - RL, where this is shorter, and

    zeta  distance of y from the outer edge of the lattice of anchors, y = l zeta + g L/2,
    t     share of the rods further out, N = L (1 - t),
    P     log density, rho_y = (L/l) exp(P),
    u     displacement <dx>/l = zeta + Lam t,   with Lam = g L/l,
    K     strength of the springs, (l/s)^n: 1 without walls.

Then, on the right half of the (symmetric) chain,

    P' = -K u |u|^(n-2),      t' = -exp(P),      t = 1/2 at the centre,      t = 0 far outside,

or at the wall, zeta = (X/2 - RL)/l - Lam/2. No other condition holds at a wall: the pressure there
follows. Lam exp(P) - P - K |u|^n/n is conserved, and its drift is the residual. Without a gap
(Lam = 0) the solution is rho_y = L times the density of a rod that is alone. Without springs the
anchors mean nothing, and rho_y is constant.

Deep inside a chain with a gap there is a plateau with u = 0 and rho_y = 1/g. Perturbations of it
decay as exp(-distance/s) for linear and as 6 (s/distance)^2 for quadratic springs. The solver
starts where they have vanished.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import xarray as xr
from scipy.integrate import solve_bvp
from scipy.special import gamma, gammaincc

from crazybilliards.kinetic.accuracy import expected
from crazybilliards.model import Chain, spring
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import position_grid, thermal_reach
from crazybilliards.model.vocabulary import result

BY_LABELS = "force balance, by labels"

_TAIL = 36.0  # tails are followed down to exp(-36) = 2e-16 of the maximum
_EDGE_DEPTH = {2: 40.0, 3: 1e4}  # where the plateau is reached, by exponent n


def solve_label_closure(chain: Chain) -> xr.Dataset:
    """Solve the force balance closed by labels; see ``force_balance``, which checks the chain."""
    state = stationary(chain)
    x = position_grid(chain, fluid_reach(chain))
    density, label = state.fields(chain, x)
    lattice = (2 * chain.radius + chain.lattice_gap) * (label - chain.size / 2)
    # The middle of rod i has the label i - 1/2.
    rods = state.unit * state.at(chain.rank / chain.size)[0]
    walls = {}
    if chain.box:
        walls["wall_force"] = ("wall", np.full(2, chain.temperature * state.at_walls * chain.size))
    dataset = result(
        chain,
        {
            **walls,
            "density": ("x", density),
            "label": ("x", label),
            "displacement": ("x", x - lattice),
            "mean_displacement": ("particle", rods - chain.reduced_anchors),
            "velocity_width": ("particle", np.sqrt(chain.temperature / chain.rod_masses)),
        },
        coordinates={"x": x},
        source="theory",
        method={"theory": BY_LABELS},
        residual=state.residual,
    )
    dataset.attrs |= expected("force_balance", chain).named()
    return dataset


@dataclass(frozen=True)
class Stationary:
    """The scaled stationary state: a plateau up to zeta = left, computed up to right, then vacuum.

    Labels are nu = N/L - 1/2 in (-1/2, 1/2), eta = y/l, and densities rho_y are in L/l.
    """

    unit: float  # l
    stiffness: float  # K
    lam: float
    left: float
    right: float
    wall: float  # the wall's zeta
    scale: float  # the solver's second unknown is scale * t
    curve: Callable[[Array], Array]
    residual: float

    @property
    def at_walls(self) -> float:
        """The density rho_y/L at the walls [1/R]; 0 if no rod comes so far."""
        reached = self.right == self.wall
        return float(np.exp(self.curve(np.array(self.right))[0])) / self.unit if reached else 0.0

    def _evaluate(self, zeta: Array) -> tuple[Array, Array]:
        """Return P and t at zeta."""
        log_density, scaled = self.curve(np.clip(zeta, self.left, self.right))
        share = np.clip(scaled / self.scale, 0.0, 1.0)
        inside, outside = zeta < self.left, zeta > self.right
        if inside.any():
            log_density = np.where(inside, -np.log(self.lam), log_density)
            share = np.where(inside, -zeta / self.lam, share)
        return np.where(outside, -np.inf, log_density), np.where(outside, 0.0, share)

    def _invert(self, function: Callable[[Array], tuple[Array, Array]], target: Array) -> Array:
        """Solve function(zeta) = target for an ascending function that returns (value, slope)."""
        far = self.right + 1e3 * max(self.right, 1.0)
        table = np.concatenate([[-self.lam / 2], np.linspace(self.left, self.right, 40_001), [far]])
        zeta = np.interp(target, function(table)[0], table)
        for _ in range(3):  # the table is right to 1e-3: three iterations reach rounding
            value, slope = function(zeta)
            zeta = zeta - (value - target) / slope
        return zeta

    def at(self, labels: Array) -> tuple[Array, Array]:
        """Return eta and the density at labels."""

        def inside(zeta: Array) -> tuple[Array, Array]:
            log_density, share = self._evaluate(zeta)
            return 1 - share, np.exp(log_density)

        zeta = self._invert(inside, 0.5 + np.abs(labels))
        density = np.exp(self._evaluate(zeta)[0])
        return np.sign(labels) * (zeta + self.lam / 2), density

    def profile(self, eta: Array) -> tuple[Array, Array]:
        """Return label and log density at eta."""
        log_density, share = self._evaluate(np.abs(eta) - self.lam / 2)
        return np.sign(eta) * (0.5 - share), log_density

    def fields(self, chain: Chain, x: Array, stretch: float = 1.0) -> tuple[Array, Array]:
        """Return density and label at positions x, of the state stretched in y."""
        unit, L, R = stretch * self.unit, chain.size, chain.radius

        def position(zeta: Array) -> tuple[Array, Array]:
            log_density, share = self._evaluate(zeta)
            place = unit * (zeta + self.lam / 2) + 2 * R * L * (0.5 - share)
            return place, unit + 2 * R * L * np.exp(log_density)

        log_density, share = self._evaluate(self._invert(position, np.abs(x)))
        reduced_density = L / unit * np.exp(log_density)
        density = reduced_density / (1 + 2 * R * reduced_density)
        return density, L / 2 + np.sign(x) * L * (0.5 - share)


def length_unit(chain: Chain) -> float:
    """Return the thermal length or, if it is shorter, half the room between the walls [R]."""
    return min(chain.thermal_length, chain.walls[1])


@lru_cache(maxsize=8)
def stationary(chain: Chain) -> Stationary:
    """Solve the boundary-value problem of this module for a chain at its temperature."""
    n, room = chain.potential_exponent, chain.walls[1]
    unit = length_unit(chain)
    stiffness = (unit / chain.thermal_length) ** n
    lam = chain.lattice_gap * chain.size / unit if chain.stiffness > 0 else 0.0
    wall = room / unit - lam / 2
    right = min((n * _TAIL) ** (1 / n) * chain.thermal_length / unit, wall)
    edge = min(wall, 0.0)
    depth = _EDGE_DEPTH[n] * (chain.thermal_length / unit) - edge if stiffness else 0.0
    left = -min(lam / 2, depth)
    share_left = 0.5 if lam <= 2 * depth else depth / lam
    scale = max(lam, 1.0)

    def equations(zeta: Array, state: Array) -> Array:
        u = zeta + lam / scale * state[1]
        return np.array([-stiffness * spring.force(u, n), -scale * np.exp(state[0])])

    def boundary(at_left: Array, at_right: Array) -> Array:
        return np.array([at_left[1] / scale - share_left, at_right[1]])

    # The mesh is fine near the edge and geometrically coarser into the plateau, if there is any.
    fine = edge - 5.0 if left < edge - 6 else left
    inner = np.empty(0)
    if left < fine:
        inner = edge - np.geomspace(edge - fine, edge - left, 200)[:0:-1]
    mesh = np.concatenate([inner, np.linspace(fine, right, 300)])
    guess_density, guess_share = _free_lattice(n, lam, mesh)
    if right == wall:  # from a constant density on
        guess_density = np.full(mesh.size, share_left / (right - left))
        guess_share = guess_density * (right - mesh)
    guess = np.array([np.log(guess_density), scale * guess_share])
    solution = solve_bvp(equations, boundary, mesh, guess, tol=1e-9, max_nodes=100_000)
    if not solution.success:
        raise ValueError(f"the force balance found no solution: {solution.message}")
    P, u = solution.y[0], solution.x + lam / scale * solution.y[1]
    conserved = (lam * np.exp(P) - P - stiffness * spring.potential(u, n))[P.max() - 30 < P]
    known = unit, stiffness, lam, left, right, wall, scale
    return Stationary(*known, solution.sol, float(np.ptp(conserved)))


def _free_lattice(n: int, lam: float, zeta: Array) -> tuple[Array, Array]:
    """Density exp(P) and share t of rods without collisions: a thermally smeared lattice."""
    from scipy.stats import gennorm  # its import takes half a second, and few calls need it

    free = gennorm(n, scale=n ** (1 / n))
    if lam < 1e-3:
        return free.pdf(zeta), free.sf(zeta)

    def beyond(a: Array) -> Array:
        """int_a^inf sf = E max(d - a, 0)."""
        moment = gamma(2 / n) / gamma(1 / n) * n ** (1 / n) / 2
        size = np.abs(a)
        positive = moment * gammaincc(2 / n, size**n / n) - size * free.sf(size)
        return np.where(a > 0, positive, positive - a)

    density = (free.sf(zeta) - free.sf(zeta + lam)) / lam
    return np.maximum(density, 1e-17 / lam), (beyond(zeta) - beyond(zeta + lam)) / lam


def fluid_reach(chain: Chain) -> float:
    """Distance from the outer anchor beyond which the fluid at rest has no density [R].

    The fluid's lattice of anchors ends half a cell, R + g/2, beyond the outermost anchor.
    """
    return thermal_reach(chain) + chain.radius + chain.lattice_gap / 2
