r"""The force balance closed by labels, a boundary-value problem without any input.

With the label N(x) = int rho, the mean displacement at x is <dx> = x - (2R + g)(N - L/2). In the
reduced coordinate y = x - 2R (N - L/2) the length of the rods drops out. The unit of length is the
thermal length s = (T/k)^(1/n) (n: exponent of the spring's potential) and

    zeta  distance of y from the outer edge of the lattice of anchors, y = s zeta + g L/2,
    t     share of the rods further out, N = L (1 - t),
    P     log density, rho_y = (L/s) exp(P),
    u     displacement <dx>/s = zeta + Lam t,   with Lam = g L/s the only parameter left.

Then, on the right half of the (symmetric) chain,

    P' = -u |u|^(n-2),      t' = -exp(P),      t = 1/2 at the centre,      t = 0 far outside.

Lam exp(P) - P - |u|^n/n is conserved, and its drift is the residual. Without a gap (Lam = 0) the
solution is rho_y = L times the density of a free rod.

Deep inside a chain with a gap there is a plateau with u = 0 and rho_y = 1/g. Perturbations of it
decay as exp(-distance) for linear and as 6/distance^2 for quadratic springs. The solver starts
where they have vanished.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import xarray as xr
from scipy.integrate import solve_bvp
from scipy.special import gamma, gammaincc
from scipy.stats import gennorm

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
    rods = chain.thermal_length * state.at(chain.rank / chain.size)[0]
    dataset = result(
        chain,
        {
            "density": ("x", density),
            "label": ("x", label),
            "displacement": ("x", x - lattice),
            "mean_displacement": ("particle", rods - chain.reduced_anchors),
            "velocity_width": ("particle", np.full(chain.size, chain.free_velocity_width)),
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

    Labels are nu = N/L - 1/2 in (-1/2, 1/2), eta = y/s, and densities rho_y are in L/s.
    """

    lam: float
    left: float
    right: float
    scale: float  # the solver's second unknown is scale * t
    curve: Callable[[Array], Array]
    residual: float

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
        s, L, R = stretch * chain.thermal_length, chain.size, chain.radius

        def position(zeta: Array) -> tuple[Array, Array]:
            log_density, share = self._evaluate(zeta)
            place = s * (zeta + self.lam / 2) + 2 * R * L * (0.5 - share)
            return place, s + 2 * R * L * np.exp(log_density)

        log_density, share = self._evaluate(self._invert(position, np.abs(x)))
        reduced_density = L / s * np.exp(log_density)
        density = reduced_density / (1 + 2 * R * reduced_density)
        return density, L / 2 + np.sign(x) * L * (0.5 - share)


@lru_cache(maxsize=8)
def stationary(chain: Chain) -> Stationary:
    """Solve the boundary-value problem of this module for a chain at its temperature."""
    n, lam = chain.potential_exponent, chain.lattice_gap * chain.size / chain.thermal_length
    depth = _EDGE_DEPTH[n]
    left, right = -min(lam / 2, depth), (n * _TAIL) ** (1 / n)
    share_left = 0.5 if lam <= 2 * depth else depth / lam
    scale = max(lam, 1.0)

    def equations(zeta: Array, state: Array) -> Array:
        u = zeta + lam / scale * state[1]
        return np.array([-spring.force(u, n), -scale * np.exp(state[0])])

    def boundary(at_left: Array, at_right: Array) -> Array:
        return np.array([at_left[1] / scale - share_left, at_right[1]])

    # The mesh is fine near the edge and geometrically coarser into the plateau, if there is any.
    fine = -5.0 if left < -6 else left
    inner = -np.geomspace(-fine, -left, 200)[:0:-1] if left < fine else np.empty(0)
    mesh = np.concatenate([inner, np.linspace(fine, right, 300)])
    guess_density, guess_share = _free_lattice(n, lam, mesh)
    guess = np.array([np.log(guess_density), scale * guess_share])
    solution = solve_bvp(equations, boundary, mesh, guess, tol=1e-9, max_nodes=100_000)
    if not solution.success:
        raise ValueError(f"the force balance found no solution: {solution.message}")
    P, u = solution.y[0], solution.x + lam / scale * solution.y[1]
    conserved = (lam * np.exp(P) - P - spring.potential(u, n))[P.max() - 30 < P]
    return Stationary(lam, left, right, scale, solution.sol, float(np.ptp(conserved)))


def _free_lattice(n: int, lam: float, zeta: Array) -> tuple[Array, Array]:
    """Density exp(P) and share t of rods without collisions: a thermally smeared lattice."""
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
