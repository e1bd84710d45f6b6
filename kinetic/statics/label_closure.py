r"""The force balance closed by labels, up to one integral in closed form.

With the label N(x) = int rho, the mean displacement at x is <dx> = x - (2R + g)(N - L/2). In the
reduced coordinate y = x - 2R (N - L/2) the length of the rods drops out. The unit of length l is
the thermal length s = (T/k)^(1/n) (n: exponent of the spring's potential), or half the room between
the walls, X/2 - RL, where this is shorter. With

    eta = y/l,    nu = N/L - 1/2,    P = ln(rho_y l/L),    u = <dx>/l = eta - Lam nu,    Lam = g L/l

and the springs' strength K = (l/s)^n, 1 without walls, the right half of the symmetric chain has

    P' = -K u |u|^(n-2),      nu' = exp(P),      nu = 0 at the centre,      nu = 1/2 far outside,

or at the wall. Since u' = 1 - Lam e^P,

    Lam e^P - P - K |u|^n/n = constant.

So e^P is a Wright omega function of u. With d = 1 - Lam e^P and the constant 1 + ln Lam + eps,

    -d - ln(1 - d) = eps + K |u|^n/n,      1/2 - nu = int_u e^P/d du,

where d > 0 if the rods spread, and d < 0 if the walls push them together. A root finder determines
eps so that nu = 0 at u = 0. Deep inside a long chain with a gap there is a plateau with u = 0 and
rho_y = 1/g, and eps is below what is told from 0. Without a gap Lam is set to 1e-12, and rho_y is L
times the density of a rod that is alone. Without springs rho_y is constant.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import xarray as xr
from numpy.polynomial import legendre
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq
from scipy.special import wrightomega

from crazybilliards.kinetic.accuracy import errors_of_force_balance
from crazybilliards.model import Array, Chain, spring
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import result

BY_LABELS = "force balance, by labels"

_TAIL = 36.0  # tails are followed down to exp(-36) = 2e-16 of the maximum
_FEW_CELLS, _CELLS = 600, 6000  # of the integral, and of the table, from the centre outwards
_POINTS = 4  # of the quadrature in a cell
_NO_GAP = 1e-12  # the least Lam, and the least |u| at a wall
_PLATEAU = 1e-35  # the least eps: rho_y is 1/g to rounding


def solve_label_closure(chain: Chain) -> xr.Dataset:
    """Solve the force balance closed by labels; see ``force_balance``, which checks the chain."""
    state = stationary(chain)
    x = position_grid(chain, fluid_reach(chain))
    # The middle of rod i has the label i - 1/2.
    rods = state.unit * state.at(chain.rank / chain.size)
    return closed_by_labels(
        chain,
        x,
        *state.fields(chain, x),
        mean=rods - chain.reduced_anchors,
        width=np.sqrt(chain.temperature / chain.rod_masses),
        wall_force=np.full(2, chain.temperature * state.at_walls * chain.size),
        theory=BY_LABELS,
        residual=state.residual,
    ).assign_attrs(errors_of_force_balance(chain).named())


def closed_by_labels(
    chain: Chain,
    x: Array,
    density: Array,
    label: Array,
    *,
    mean: Array,
    width: Array,
    wall_force: Array,
    theory: str,
    residual: float,
) -> xr.Dataset:
    """Return fields over x, mean displacements and velocity widths in the common vocabulary."""
    lattice = (2 * chain.radius + chain.lattice_gap) * (label - chain.size / 2)
    return result(
        chain,
        {
            **({"wall_force": ("wall", wall_force)} if chain.box else {}),
            "density": ("x", density),
            "label": ("x", label),
            "displacement": ("x", x - lattice),
            "mean_displacement": ("particle", mean),
            "velocity_width": ("particle", width),
        },
        coordinates={"x": x},
        source="theory",
        method={"theory": theory},
        residual=residual,
    )


@dataclass(frozen=True)
class Stationary:
    """The scaled stationary state of this module: a table from the centre outwards, then vacuum."""

    unit: float  # l
    stiffness: float  # K
    lam: float
    wall: float  # eta of the wall
    eta: Array
    beyond: Array  # 1/2 - nu
    log_density: Array  # P
    slope: Array  # P'

    @property
    def at_walls(self) -> float:
        """The density rho_y/L at the walls [1/R]; 0 if no rod comes so far."""
        return float(np.exp(self.log_density[-1])) / self.unit if self.eta[-1] == self.wall else 0.0

    @property
    def residual(self) -> float:
        """The relative error of the number of rods, integrated again."""
        density = np.exp(self.log_density)
        curve = CubicHermiteSpline(self.eta, density, density * self.slope)
        return abs(2 * float(curve.integrate(0, self.eta[-1])) - 1)

    def at(self, labels: Array) -> Array:
        """Return eta at labels nu."""
        curve = CubicHermiteSpline(-self.beyond, self.eta, np.exp(-self.log_density))
        return np.sign(labels) * curve(np.abs(labels) - 0.5)

    def profile(self, eta: Array) -> tuple[Array, Array]:
        """Return nu and P at eta."""
        return self._at_places(eta, self.eta, np.ones(self.eta.size))

    def fields(self, chain: Chain, x: Array, stretch: float = 1.0) -> tuple[Array, Array]:
        """Return density and label at positions x, of the state stretched in y."""
        unit, L, rods = stretch * self.unit, chain.size, 2 * chain.radius * chain.size
        places = unit * self.eta + rods * (0.5 - self.beyond)
        label, log_density = self._at_places(x, places, unit + rods * np.exp(self.log_density))
        reduced_density = L / unit * np.exp(log_density)
        return reduced_density / (1 + 2 * chain.radius * reduced_density), L * (0.5 + label)

    def _at_places(self, wanted: Array, places: Array, growth: Array) -> tuple[Array, Array]:
        """Return nu and P at wanted places; those of the table grow with eta as ``growth``."""
        size, density = np.abs(wanted), np.exp(self.log_density)
        within = np.minimum(size, places[-1])
        beyond = CubicHermiteSpline(places, self.beyond, -density / growth)(within)
        log_density = CubicHermiteSpline(places, self.log_density, self.slope / growth)(within)
        label = np.sign(wanted) * (0.5 - np.maximum(beyond, 0.0))
        return label, np.where(size > within, -np.inf, log_density)


def length_unit(chain: Chain) -> float:
    """Return the thermal length or, if it is shorter, half the room between the walls [R]."""
    return min(chain.thermal_length, chain.walls[1])


@lru_cache(maxsize=8)
def stationary(chain: Chain) -> Stationary:
    """Solve the equations of this module for a chain at its temperature."""
    n, unit = chain.potential_exponent, length_unit(chain)
    K, wall = (unit / chain.thermal_length) ** n, chain.walls[1] / unit
    gap = chain.lattice_gap * chain.size / unit if chain.stiffness > 0 else 0.0
    lam = max(gap, _NO_GAP)
    far = spring.reach(_TAIL, n) * (chain.thermal_length / unit)
    end = min(far, wall - lam / 2)
    end = end if abs(end) > _NO_GAP else _NO_GAP
    points, weights = legendre.leggauss(_POINTS)

    def solved(log_eps: float, cells: int) -> tuple[Array, Array, Array, Array]:
        """Return u, P and the distances of eta and nu from their ends, from u = 0 outwards."""
        eps = np.exp(log_eps)
        # Even where eps is more than the energy of the springs, and in the logarithm beyond.
        spread = max(np.arcsinh(abs(end) * (K / (n * eps)) ** (1 / n)), 1e-3)
        u = end * np.sinh(spread * np.linspace(0, 1, cells + 1)) / np.sinh(spread)
        half = np.diff(u)[:, np.newaxis] / 2
        inside = u[:-1, np.newaxis] + half * (1 + points)
        d, P = _closed_form(eps + K * spring.potential(inside, n), lam, end)
        steps = (half / d) @ weights, (half * np.exp(P) / d) @ weights
        eta, nu = (np.append(np.cumsum(each[::-1])[::-1], 0.0) for each in steps)
        return u, _closed_form(eps + K * spring.potential(u, n), lam, end)[1], eta, nu

    def missing(log_eps: float) -> float:
        return float(solved(log_eps, _FEW_CELLS)[3][0]) - 0.5

    low, high = np.log([_PLATEAU, 50 + lam])
    log_eps = low if missing(low) < 0 else brentq(missing, low, high, xtol=1e-13)
    u, P, inwards, beyond = solved(log_eps, _CELLS)
    eta = min(wall, far + lam / 2) - inwards
    eta[0], beyond[0] = 0.0, 0.5  # the plateau between is within the first cell
    return Stationary(unit, K, lam, wall, eta, beyond, P, -K * spring.force(u, n))


def _closed_form(energy: Array, lam: float, side: float) -> tuple[Array, Array]:
    """Return d, with the sign of ``side``, and P for given eps + K |u|^n/n."""
    root = np.copysign(np.sqrt(2 * energy), side)
    # A little off the branch cut, so that rounding does not choose the branch.
    omega = wrightomega(-1 - energy + 1j * np.pi * (1 - np.copysign(1e-12, side))).real
    series = root * (1 - root / 3 + root**2 / 36 + root**3 / 270)
    d = np.where(np.abs(root) < 0.01, series, 1 + omega)
    return d, -d - energy - np.log(lam)


def fluid_reach(chain: Chain) -> float:
    """Distance from the outer anchor, half a cell before its lattice ends, to the vacuum [R]."""
    return chain.thermal_reach + chain.radius + chain.lattice_gap / 2
