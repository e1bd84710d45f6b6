r"""The force balance with a prescribed W^2(x), closed by labels: Newton's method with scikit-fem.

The unknown is the log pressure P = ln(w rho_y). It is continuous where W^2 jumps, no derivative of
W^2 is needed, and rho always stays below close packing. Lengths are in thermal lengths s of the
free chain, w = W^2(x)/W^2, B = 2 R L/s and Lam = g L/s. Equation (***) of
:mod:`crazybilliards.kinetic.statics.balance` is

    (w + B exp(P)) P' = -u,      u = x - (B + Lam) nu,      nu' = n = exp(P)/(w + B exp(P)),

with n = rho s/L. One more derivative removes the label:

    ((w + B exp(P)) P')' = -1 + (B + Lam) n,
    flux (w + B exp(P)) P' = -x +- (B + Lam)/2 at the far ends or walls: all rods lie in between.

Weak form, for all test functions v: int (w + B e^P) P' v' + int ((B + Lam) n - 1) v = [flux v].

Without springs the pressure is constant, and the number of rods determines it. A Newton step may
change the pressure by a factor e^2 at most, except in the far tails. The mesh is fine at the edges
of the stationary state of the free chain and is then adapted to the solution.
"""

from collections.abc import Callable

import numpy as np
import xarray as xr
from scipy.integrate import cumulative_simpson, cumulative_trapezoid
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.optimize import brentq
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementLineP2, LinearForm, MeshLine
from skfem.helpers import grad

from crazybilliards.kinetic.statics.label_closure import closed_by_labels, stationary
from crazybilliards.kinetic.statics.profiles import Profile
from crazybilliards.model import Array, Chain
from crazybilliards.model.grid import position_grid

Warmth = Callable[[Array], Array]

_THEORY = "force balance, by labels, prescribed velocity variance"

_CELLS, _MESHES, _MOST_STEPS = 1200, 3, 200
_WIDENINGS = 4  # of the mesh, for a W^2(x) that grows outwards
_CAP = 2.0
_DEPTH = 6.0  # from an edge into a plateau where cells begin to grow, in thermal lengths
_DEAD = 30.0  # a pressure lower than the highest by exp(-30) is none
_VACUUM = 18.0  # so much must the log pressure have fallen at the ends of the mesh
_NODES = 40_001  # between walls
_REACH = 9.0  # of the mesh beyond the lattice of anchors, in the hottest thermal length


@BilinearForm
def _jacobian(u, v, w):  # type: ignore[no-untyped-def]
    pressure = np.exp(w.P)
    room = w.warmth + w.crowd * pressure
    stiffness = (w.crowd * pressure * u * grad(w.P)[0] + room * grad(u)[0]) * grad(v)[0]
    return stiffness + (w.crowd + w.lam) * pressure * w.warmth / room**2 * u * v


@LinearForm
def _residual(v, w):  # type: ignore[no-untyped-def]
    pressure = np.exp(w.P)
    room = w.warmth + w.crowd * pressure
    return room * grad(w.P)[0] * grad(v)[0] + ((w.crowd + w.lam) * pressure / room - 1) * v


def solve_variable_temperature(chain: Chain, variance: Profile) -> xr.Dataset:
    """Solve for the density at a given W^2(x); see ``force_balance``, which checks both."""
    if chain.stiffness == 0:
        return _between_walls(chain, variance)
    s, L, R = chain.thermal_length, chain.size, chain.radius
    crowd, lam = 2 * R * L / s, chain.lattice_gap * L / s
    free = chain.free_velocity_width**2 * (chain.mass / chain.mean_mass)

    def warmth(x: Array) -> Array:
        return variance.function(s * x) / free

    end = min(_end(warmth, crowd, lam), chain.walls[1] / s)
    even = np.linspace(0, end, 100_001)
    growth = 1 + np.maximum(lam / 2 - _DEPTH - even, 0) / _DEPTH
    cells_up_to = cumulative_trapezoid(1 / growth, even, initial=0)
    half = np.interp(np.linspace(0, cells_up_to[-1], _CELLS // 2 + 1), cells_up_to, even)
    rough = np.concatenate([-half[:0:-1], half])
    unit = stationary(chain).unit
    labels, log_density = stationary(chain).profile(rough * (s / unit))
    log_density += np.log(s / unit)
    nodes = rough + crowd * labels
    guess = PchipInterpolator(nodes, np.maximum(log_density, -60.0) + np.log(warmth(nodes)))
    for _ in range(_MESHES):
        basis = Basis(MeshLine(nodes), ElementLineP2(), intorder=6)
        P = _newton(basis, guess(basis.doflocs[0]), warmth, crowd, lam)
        pressure = np.exp(np.asarray(basis.interpolate(P)))
        room = warmth(basis.global_coordinates()[0]) + crowd * pressure
        label = np.append(0.0, np.cumsum((pressure / room * basis.dx).sum(axis=1)))
        nodes = _adapted(basis, P, label, crowd, warmth)
        order = np.argsort(basis.doflocs[0])
        guess = PchipInterpolator(basis.doflocs[0][order], P[order])
    if end < chain.walls[1] / s:
        _require_vacuum(basis, P, s)
    return _assemble(chain, basis, guess, label, warmth)


def _end(warmth: Warmth, crowd: float, lam: float) -> float:
    """Return the end of the mesh minus B/2; the hottest place in the mesh determines it."""
    end = lam / 2
    for _ in range(_WIDENINGS):
        places = np.linspace(-1, 1, 10_001) * (end + crowd / 2)
        end = lam / 2 + _REACH * max(float(np.sqrt(warmth(places).max())), 0.05)
    return end


def _newton(basis: Basis, P: Array, warmth: Warmth, crowd: float, lam: float) -> Array:
    """Solve the discrete equations from a guess."""
    fields = {"warmth": warmth(basis.global_coordinates()[0]), "crowd": crowd, "lam": lam}
    end = float(basis.mesh.p[0].max())
    outflow = basis.zeros()
    places = basis.doflocs[0]
    outflow[np.argmax(places)] = outflow[np.argmin(places)] = (crowd + lam) / 2 - end
    for _ in range(_MOST_STEPS):
        at_points = basis.interpolate(P)
        right = outflow - _residual.assemble(basis, P=at_points, **fields)
        try:
            step = splu(_jacobian.assemble(basis, P=at_points, **fields).tocsc()).solve(right)
        except RuntimeError as error:  # "exactly singular"
            raise ValueError(f"the force balance did not converge: {error}") from error
        alive = P.max() - _DEAD < P
        largest = float(np.abs(step[alive]).max())
        P = np.maximum(P + step * min(1.0, _CAP / largest), P.max() - 400)
        if largest < 1e-10:
            return P
    raise ValueError(f"the force balance did not converge in {_MOST_STEPS} Newton steps")


def _require_vacuum(basis: Basis, P: Array, s: float) -> None:
    """Raise unless the pressure is negligible at the ends of the mesh."""
    places = basis.doflocs[0]
    for end in (np.argmin(places), np.argmax(places)):
        if P[end] > P.max() - _VACUUM:
            raise ValueError(
                "velocity_variance is so high outside the chain that rods are found beyond "
                f"x = {s * places[end]:.4g}, where its equations are no longer solved"
            )


def _adapted(basis: Basis, P: Array, label: Array, crowd: float, warmth: Warmth) -> Array:
    """Return as many vertices, spread over free room (less on a plateau) and changes of P and w."""
    x = basis.mesh.p[0]
    w, alive = warmth(x), np.maximum(P[basis.nodal_dofs[0]], P.max() - _DEAD)
    width = np.diff(x - crowd * label) / np.sqrt((w[1:] + w[:-1]) / 2)
    change = np.abs(np.diff(np.log(w))) + np.abs(np.diff(alive)) / 4
    place = np.cumsum(width) - width / 2
    active = place[change > 1e-6 * width]
    nearest = np.searchsorted(active, place)
    right = np.append(active, np.inf)[nearest] - place
    left = place - np.insert(active, 0, -np.inf)[nearest]
    growth = 1 + np.maximum(np.minimum(left, right) - _DEPTH, 0) / _DEPTH
    spread = np.concatenate([[0.0], np.cumsum(width / growth + change)])
    return np.interp(np.linspace(0, spread[-1], x.size), spread, x)


def _assemble(
    chain: Chain, basis: Basis, log_pressure: PchipInterpolator, label: Array, warmth: Warmth
) -> xr.Dataset:
    """Put the solution onto the position grid and the particles."""
    s, L = chain.thermal_length, chain.size
    crowd = 2 * chain.radius * L / s

    def share(x: Array) -> Array:
        """Return n."""
        pressure = np.exp(log_pressure(x))
        return np.asarray(pressure / (warmth(x) + crowd * pressure))

    vertices = basis.mesh.p[0]
    count = CubicHermiteSpline(vertices, label / label[-1], share(vertices))
    x = position_grid(chain, s * vertices[-1] - float(chain.anchors[-1]))
    within = np.clip(x / s, vertices[0], vertices[-1])
    # By label: as differences of positions of many rods displacements would be lost in rounding.
    shares, first = np.unique(label / label[-1] - 0.5, return_index=True)
    at_vertices = vertices[first] - (crowd + chain.lattice_gap * L / s) * shares
    mean = s * PchipInterpolator(shares, at_vertices)(chain.rank / L)
    free = chain.free_velocity_width * np.sqrt(chain.mass / chain.rod_masses)
    return closed_by_labels(
        chain,
        x,
        np.where(within == x / s, share(within), 0.0) * L / s,
        L * np.clip(count(within), 0.0, 1.0),
        mean=mean,
        width=free * np.sqrt(warmth((chain.anchors + mean) / s)),
        wall_force=chain.temperature * L / s * np.exp(log_pressure(vertices[[0, -1]])),
        theory=_THEORY,
        residual=abs(label[-1] - 1),
    )


def _between_walls(chain: Chain, variance: Profile) -> xr.Dataset:
    """Solve without springs: rho = p/(W^2 + 2 R p), with the pressure m p that holds L rods."""
    L, R, end = chain.size, chain.radius, chain.box / 2
    x = np.linspace(-end, end, _NODES)
    squares = variance.function(x)

    def labels(log_p: float) -> Array:
        p = np.exp(log_p)
        return np.asarray(cumulative_simpson(p / (squares + 2 * R * p), x=x, initial=0))

    free = np.log(L * squares / (2 * chain.walls[1]))  # of a gas with one of these temperatures
    log_p = brentq(lambda p: labels(p)[-1] - L, free.min() - 1, free.max() + 1, xtol=1e-13)
    p, label = np.exp(log_p), labels(log_p)
    grid = position_grid(chain)
    within = np.clip(grid, -end, end)
    rods = np.interp(np.arange(L) + 0.5, L * label / label[-1], x)
    return closed_by_labels(
        chain,
        grid,
        np.where(within == grid, p / (variance.function(within) + 2 * R * p), 0.0),
        L * np.clip(PchipInterpolator(x, label / label[-1])(within), 0.0, 1.0),
        mean=rods - chain.anchors,
        width=np.sqrt(chain.mean_mass / chain.rod_masses * variance.function(rods)),
        wall_force=np.full(2, chain.mean_mass * p),
        theory=_THEORY,
        residual=abs(label[-1] / L - 1),
    )
