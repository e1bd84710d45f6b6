r"""Starts of the hydrodynamics: checks given profiles, and makes common ones.

A start is a result with ``density`` over x (one time), and optionally ``label``, ``flow_velocity``
and ``velocity_variance``. ``force_balance`` of another chain gives a quench.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.optimize import elementwise

from crazybilliards.kinetic.exact.motion import fields_of_points
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.kinetic.statics.label_closure import fluid_reach, stationary
from crazybilliards.model import WALLS_AND_MASSES, Array, Chain, chain_of
from crazybilliards.model.checks import check_real, refuse_units, shown
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, OF_RODS, refuse_unread, require, result
from crazybilliards.model.warn import warn_user

_RODS_TOLERANCE = 1e-3
_READ = ("density", "label", "flow_velocity", "velocity_variance")
_APART = 0.5  # rods; more is no error of a grid, unless it is below a hundredth of all
_POINTS = 10_001  # from wall to wall
_CROWDED = 1.01  # so many rods in the length of one overlap, but for errors of the grid
_CRYSTAL = (
    "these are the spikes of a crystal, which no fluid has; take the smooth density of "
    "force_balance"
)
_NO_SIGN_CHANGE = -1  # status of a root that scipy did not look for; those below are failures


def displaced(chain: Chain, shift: float) -> xr.Dataset:
    """Return the stationary state at restitution 1, moved by ``shift`` [R] as a whole."""
    return _stationary_image(chain, shift=check_real("shift", shift, signed=True))


def compressed(chain: Chain, factor: float) -> xr.Dataset:
    """Return the stationary state at restitution 1, with y multiplied by ``factor`` > 0.

    Only the free room between rods shrinks or grows: y = x - 2 R (N - L/2).
    """
    return _stationary_image(chain, stretch=check_real("factor", factor, positive=True))


def _stationary_image(chain: Chain, stretch: float = 1.0, shift: float = 0.0) -> xr.Dataset:
    require_chain(chain, "a start from the stationary state")
    # Stretching widens the lattice of anchors as well as the tails beyond it.
    wider = max(stretch - 1, 0.0) * (chain.lattice_gap * chain.size / 2 + chain.thermal_reach)
    grid = position_grid(chain, fluid_reach(chain) + abs(shift) + wider)
    return _at_rest(chain, grid, *stationary(chain).fields(chain, grid - shift, stretch))


def gathered(chain: Chain, share: float) -> xr.Dataset:
    """Return a gas in a box whose points are evenly spread over the left ``share`` of their room.

    The room is l = X - 2RL: the density of points is L/(share l) there, and 0 beyond.
    """
    share = check_real("share", share, positive=True)
    if share > 1:
        raise ValueError(f"share must be at most 1, got {share:g}")
    return _gas_of_points(chain, lambda place: np.minimum(place / share, 1.0))


def wave(chain: Chain, height: float) -> xr.Dataset:
    """Return a gas in a box with the points' density L/l (1 + height cos(pi (y + l/2)/l)).

    l = X - 2RL is the room of the points, and ``height`` lies between -1 and 1.
    """
    height = check_real("height", height, signed=True)
    if abs(height) > 1:
        raise ValueError(f"height must be from -1 to 1, got {height:g}")
    return _gas_of_points(chain, lambda place: place + height * np.sin(np.pi * place) / np.pi)


def _gas_of_points(chain: Chain, below: Callable[[Array], Array]) -> xr.Dataset:
    """Return a start with the share ``below`` of the points left of each place, from 0 to 1."""
    require_chain(chain, "a gas of points", knows=WALLS_AND_MASSES)
    if not (chain.box and chain.exchangeable):
        raise ValueError("a gas of points needs a box=..., and gap=0 or stiffness=0")
    grid, place = position_grid(chain), np.linspace(0.0, 1.0, _POINTS)
    y = chain.walls[1] * (2 * place - 1)
    return _at_rest(chain, grid, *fields_of_points(chain, grid, y, chain.size * below(place)))


def _fluid_variance(chain: Chain) -> float:
    """Return the free W^2 of the fluid, whose mass is the mean of the rods'."""
    return chain.free_velocity_width**2 * (chain.mass / chain.mean_mass)


def _at_rest(chain: Chain, x: Array, density: Array, label: Array) -> xr.Dataset:
    return result(
        chain,
        {
            "density": ("x", density),
            "label": ("x", label),
            "flow_velocity": ("x", np.zeros(x.size)),
            "velocity_variance": ("x", np.full(x.size, _fluid_variance(chain))),
        },
        source="start",
        method={"start": "hydrodynamics"},
        coordinates={"x": x},
    ).assign_attrs(density_of=OF_FLUID)


def check_start(start: xr.Dataset | None) -> xr.Dataset:
    """Return a start, or raise a ValueError that says what one is and which functions make one."""
    if isinstance(start, xr.Dataset):
        return start
    came = "none" if start is None else shown(start)
    raise ValueError(
        "start must be a result with density over x: displaced(chain, shift) or compressed(chain, "
        f"factor) make one of this chain, force_balance one of another; got {came}"
    )


class Start(NamedTuple):
    """A checked start, as functions of x."""

    x: Array
    label: CubicHermiteSpline  # N
    velocity: PchipInterpolator  # V
    variance: PchipInterpolator  # W^2

    def positions(self, labels: Array) -> Array:
        """Return x where N(x) is ``labels``, which lie strictly inside (0, L)."""
        counts = np.maximum.accumulate(self.label(self.x))
        cell = np.clip(np.searchsorted(counts, labels, side="left") - 1, 0, self.x.size - 2)
        low, high = self.x[cell], self.x[cell + 1]
        find_root: Any = elementwise.find_root  # its stubs know no args
        root = find_root(lambda x, wanted: self.label(x) - wanted, (low, high), args=(labels,))
        if (root.status < _NO_SIGN_CHANGE).any():
            raise ValueError("start: its labels could not be inverted")
        # Every x in an empty cell has the same label. A bracket may then have no sign change.
        return np.asarray(np.where(root.success, root.x, (low + high) / 2))


def read_start(chain: Chain, start: xr.Dataset) -> Start:
    """Check a start and make functions of it."""
    require(start, ("density",))
    own = chain_of(start) if "provenance" in start.attrs else chain  # in a quench another one
    refuse_unread(start, "start of hydrodynamics", _READ)
    if "heat_flux" in start and "time" in start.coords:
        warn_user("start: its heat_flux is not read, so the fluid goes on without one")
    if start.attrs.get("density_of") == OF_RODS and "displacement" in start:
        start = _as_a_fluid(start)
    if start.density.dims != ("x",):
        raise ValueError(f"start: density must be over x alone, got {start.density.dims}")
    x, density = (_numbers(start, name) for name in ("x", "density"))
    if not (np.isfinite(density).all() and (np.diff(x) > 0).all() and (density >= 0).all()):
        raise ValueError("start: the density must be finite and not negative, over ascending x")
    rods = PchipInterpolator(x, density).antiderivative()(x)
    label = _numbers(start, "label") if "label" in start else rods
    label = label - label[0]
    if density.max() >= chain.close_packed_density:
        # The integral over narrow spikes is rough, and a label may not belong to the density.
        counted = label if np.isclose(label[-1], rods[-1], rtol=0.1) else rods
        crowded = np.interp(x + 2 * chain.radius, x, counted) - counted > _CROWDED
        raise ValueError(
            f"start: the density reaches {density.max():.4g}, close packing is "
            f"{chain.close_packed_density:.4g}: {'rods overlap' if crowded.any() else _CRYSTAL}"
        )
    require_rods(chain, "density", label[-1])
    scale = chain.size / label[-1]
    given, apart = x, float(np.abs(label - rods).max())
    if chain.box:
        x, density, label = _up_to_the_walls(chain, x, density, label)
    if apart > max(_APART, 0.01 * chain.size):  # the label is followed, and the density is not
        raise ValueError(
            f"start: its label and the integral of its density are {apart:.3g} rods apart; start."
            "drop_vars('label') has the density alone"
        )
    profiles = {}
    for name, default in (("flow_velocity", 0.0), ("velocity_variance", _fluid_variance(own))):
        values = _numbers(start, name) if name in start else np.full(given.size, default)
        if values.shape != given.shape or not np.isfinite(values).all():
            raise ValueError(f"start: {name} must be finite and over x alone")
        profiles[name] = PchipInterpolator(x, np.interp(x, given, values))
    if (profiles["velocity_variance"](x) <= 0).any():
        raise ValueError("start: velocity_variance must be positive")
    return Start(x, CubicHermiteSpline(x, scale * label, scale * density), *profiles.values())


def _up_to_the_walls(
    chain: Chain, x: Array, density: Array, label: Array
) -> tuple[Array, Array, Array]:
    """Return a start with nodes at the walls, where its density jumps and its label ends."""
    end, cell = chain.box / 2, float(np.diff(x).max())
    inside = np.diff(np.interp([-end - cell, end + cell], x, label))[0]
    require_rods(chain, "density between the walls", inside)
    within = np.abs(x) < end - cell / 2
    if not within.any():
        raise ValueError("start: x needs nodes between the walls")
    label = np.concatenate([[0.0], label[within], label[-1:]])
    return np.concatenate([[-end], x[within], [end]]), np.pad(density[within], 1, "edge"), label


def _as_a_fluid(start: xr.Dataset) -> xr.Dataset:
    """Return a result with the density of its fluid, whose label belongs to its displacement."""
    own, x = chain_of(start), start.x.values
    lattice = 2 * own.radius + own.lattice_gap
    label = own.size / 2 + (x - start.displacement.values) / lattice
    density = np.maximum(PchipInterpolator(x, label).derivative()(x), 0.0)
    return start.assign(density=("x", density), label=("x", label))


def require_rods(chain: Chain, name: str, rods: float) -> None:
    """Raise unless the variable of a start adds up to the number of rods, to a thousandth."""
    if abs(rods / chain.size - 1) > _RODS_TOLERANCE:
        raise ValueError(
            f"start: the {name} must add up to the chain's {chain.size} rods, got {rods:.6g}"
        )


def _numbers(start: xr.Dataset, name: str) -> Array:
    refuse_units(f"start: {name}", start[name])
    values = start[name].values
    if not np.issubdtype(values.dtype, np.number):
        raise ValueError(f"start: {name} must be numbers, got {values.dtype}")
    return np.asarray(values, dtype=float)
