r"""The closed form of the force balance with a prescribed displacement and a constant W^2.

Equation (**) of :mod:`crazybilliards.kinetic.statics.balance`, times 1 + 2 R rho_y, integrates to

    ln rho_y + 2 R rho_y = C - Psi(x)/T,      Psi = int F(<dx>) dx.

The Wright omega function, the solution of omega + ln omega = z, inverts this:

    2 R rho_y = omega(C - Psi/T + ln 2R),     rho = rho_y/(1 + 2 R rho_y).

A root finder determines C so that there are L rods in all. Integrals are by Gauss-Legendre
quadrature in every cell of the position grid.
"""

import math

import numpy as np
import xarray as xr
from numpy.polynomial import legendre
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq
from scipy.special import wrightomega

from crazybilliards.kinetic.statics.label_closure import fluid_reach
from crazybilliards.kinetic.statics.profiles import Profile
from crazybilliards.model import Array, Chain
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import result

_POINTS = 5  # of the quadrature in a cell
_NOTHING = 1e-12  # of the largest density, at the end of the grid
_VACUUM = 1e-16  # of the largest density: there are no rods beyond


def solve_wright_closure(chain: Chain, profile: Profile) -> xr.Dataset:
    """Return the density for a given <dx>(x); see ``force_balance``, which checks both."""
    edges = _edges(chain, profile)
    points, weights = legendre.leggauss(_POINTS)
    half = np.diff(edges)[:, np.newaxis] / 2
    x = (edges[1:] + edges[:-1])[:, np.newaxis] / 2 + half * points
    pull = _pull(chain, profile, x)
    at_edges = np.concatenate([[0.0], np.cumsum((half * pull) @ weights)])
    potential = at_edges[:-1, np.newaxis] + half * (pull @ _partial_integrals(points).T)
    lowest = float(potential.min())

    def density(constant: float, values: Array) -> Array:
        covered = wrightomega(constant - (values - lowest))  # 2 R rho_y
        return np.asarray(covered / (1 + covered) / (2 * chain.radius))

    def excess(constant: float) -> float:
        return float(((half * density(constant, potential)) @ weights).sum()) / chain.size - 1

    # From below 1e-300 of close packing to what fills the grid.
    high = 1.0
    while excess(high) < 0:
        high *= 2
        if high > 1e15:
            raise ValueError("displacement: no density of this profile adds up to the chain's rods")
    constant = brentq(excess, -700.0, high, xtol=1e-13, rtol=1e-14)
    densities = density(constant, at_edges)
    ends = densities[[0, -1]]
    for value, end, limit in zip(ends, edges[[0, -1]], (profile.left, profile.right), strict=True):
        if math.isinf(limit) and value > _NOTHING * chain.close_packed_density:
            raise ValueError(f"displacement does not hold the rods together at x = {end:g}")

    rods = ((half * density(constant, potential)) @ weights).cumsum()
    farthest = float(np.abs(edges[densities > _VACUUM * densities.max()]).max() - chain.anchors[-1])
    grid = position_grid(chain, max(farthest, fluid_reach(chain)))
    within = np.clip(grid, edges[0], edges[-1])
    inside = (grid > profile.left) & (grid < profile.right)
    values = density(constant, PchipInterpolator(edges, at_edges)(within))
    displacement = np.zeros(grid.size)  # beyond the profile
    displacement[inside] = profile.function(grid[inside])
    pressure = chain.temperature * ends / (1 - 2 * chain.radius * ends)
    forces = np.where(abs(edges[[0, -1]]) == chain.box / 2, pressure, 0)
    return result(
        chain,
        {
            **({"wall_force": ("wall", forces)} if chain.box else {}),
            "density": ("x", np.where(inside, values, 0.0)),
            "label": ("x", np.interp(within, edges, np.append(0.0, rods))),
            "displacement": ("x", displacement),
        },
        coordinates={"x": grid},
        source="theory",
        method={"theory": "force balance, prescribed displacement"},
        residual=abs(rods[-1] / chain.size - 1),
    )


def _edges(chain: Chain, profile: Profile) -> Array:
    """Return the nodes inside the profile, with room for rods that spread further than usual."""
    wide = position_grid(chain, 2 * chain.thermal_reach + float(chain.anchors[-1]))
    ends = [end for end in (profile.left, profile.right) if abs(end) < wide[-1]]
    return np.unique(np.concatenate([wide[(wide > profile.left) & (wide < profile.right)], ends]))


def _pull(chain: Chain, profile: Profile, x: Array) -> Array:
    """Return F(<dx>)/T."""
    with np.errstate(all="ignore"):
        pull = chain.force(profile.function(x.ravel()).reshape(x.shape)) / chain.temperature
    if not np.isfinite(pull).all():
        raise ValueError(
            f"displacement is not finite at x = {float(x[~np.isfinite(pull)][0]):g}; an attribute "
            "`support` can tell the interval on which it is"
        )
    return pull


def _partial_integrals(points: Array) -> Array:
    """Matrix that integrates a function known at the points from -1 to each of them."""
    integrals = legendre.legval(points, legendre.legint(np.eye(points.size), lbnd=-1)).T
    return integrals @ np.linalg.inv(legendre.legvander(points, points.size - 1))
