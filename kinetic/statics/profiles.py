"""Prescribed profiles: the displacement <dx>(x) and the velocity variance W^2(x) of the user.

A profile is a *table* (x, values), a DataArray of the values over x, a *result* (simulated or
exact) with ``mean_displacement`` or ``velocity_width`` of the particles, or a *callable* of x, such
as the paper's arctanh fit. A velocity variance may also be a *number*, the same everywhere. A
displacement that is callable may have an attribute ``support``, the interval (left, right) on which
it is finite; the density vanishes outside.
"""

import math
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import check_real, refuse_units, shown
from crazybilliards.model.vocabulary import refuse_unread, require, require_all_particles

Prescribed = xr.Dataset | Sequence[ArrayLike] | Array | Callable[[ArrayLike], ArrayLike]


class Profile(NamedTuple):
    """A function of x, and the interval on which it is defined."""

    function: Callable[[ArrayLike], Array]
    left: float
    right: float


def read_displacement(chain: Chain, displacement: Prescribed | None) -> Profile | None:
    """Turn any accepted form of <dx>(x) into a :class:`Profile`, or raise a ValueError.

    None (displacements by labels) stays None. A table is continued with slope 1 to either side, as
    outside the chain the displacement of the outermost rod grows like its position.
    """
    if displacement is None:
        return None
    if callable(displacement):
        left, right = getattr(displacement, "support", (-math.inf, math.inf))
        return Profile(_numbers("displacement", displacement), float(left), float(right))
    table = _table("displacement", "mean_displacement", chain, displacement)
    return Profile(_interpolated(*table, slope=1.0), -math.inf, math.inf)


def read_velocity_variance(
    chain: Chain, variance: float | Prescribed | None
) -> tuple[Chain, Profile | None]:
    """Return the chain to solve for and W^2(x), None if it is the chain's free value everywhere.

    W^2 enters the equations only as T = m W^2. A number W^2 therefore gives the elastic chain with
    this temperature. A table is continued with its last value.
    """
    if variance is None:
        return chain, None
    if isinstance(variance, Real) or getattr(variance, "shape", None) == ():
        number = check_real("velocity_variance", variance, positive=True)
        amplitude = math.sqrt(2 * chain.damping * chain.mean_mass * number)
        # Without damping no amplitude gives this temperature; such a chain has no steady state.
        return chain.replace(amplitude=amplitude, restitution=1) if amplitude else chain, None
    if callable(variance):
        function = _numbers("velocity_variance", variance)
    else:
        x, values = _table("velocity_variance", "velocity_width", chain, variance)
        if isinstance(variance, xr.Dataset):
            values = values**2
        function = _interpolated(x, values, slope=0.0)

    def positive(x: ArrayLike) -> Array:
        values = function(x)
        if not (np.isfinite(values).all() and (values > 0).all()):
            raise ValueError("velocity_variance must be finite and positive everywhere")
        return values

    positive(chain.anchors)
    return chain, Profile(positive, -math.inf, math.inf)


def _numbers(name: str, function: Callable[[ArrayLike], ArrayLike]) -> Callable[[ArrayLike], Array]:
    """Return a user's function with a check at each call that it returns one number per x."""

    def checked(x: ArrayLike) -> Array:
        values = function(x)
        refuse_units(name, values)
        try:
            return np.broadcast_to(np.asarray(values, dtype=float), np.shape(x))
        except (TypeError, ValueError) as error:
            raise ValueError(
                f"{name}: the callable must return a number for each x, got {shown(values)}"
            ) from error

    return checked


def _table(
    name: str, variable: str, chain: Chain, source: xr.Dataset | Sequence[ArrayLike] | Any
) -> tuple[Array, Array]:
    """Return x and values of a table, or of the particles of a result at their mean positions."""
    if isinstance(source, xr.Dataset):
        require(source, (variable, "mean_displacement"))
        refuse_unread(source, name, (variable, "mean_displacement"))
        require_all_particles(source, chain.size, name)
        refuse_units(name, source[variable])
        return chain.anchors + source.mean_displacement.values, source[variable].values
    refuse_units(name, source)
    if isinstance(source, xr.DataArray):
        if source.dims != ("x",) or "x" not in source.coords or source.name == "velocity_width":
            raise ValueError(
                f"{name}: a DataArray must hold its values over x alone, got {source.name} over "
                f"{source.dims}; of the rods give the result itself, with {variable}"
            )
        source = source.x.values, source.values
    try:
        x, values = (np.asarray(column, dtype=float) for column in source)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(
            f"{name} takes {'a number, ' if name == 'velocity_variance' else ''}a table (x, "
            f"values), a result with {variable}, or a callable of x, got {shown(source)}"
        ) from error
    if x.shape != values.shape or x.ndim != 1 or x.size < 2:
        raise ValueError(
            f"{name}: a table needs two equally long columns of at least 2 rows, got shapes "
            f"{x.shape} and {values.shape}"
        )
    if not (np.isfinite(x).all() and np.isfinite(values).all() and (np.diff(x) > 0).all()):
        raise ValueError(f"{name}: the table must be finite and its x ascending")
    return x, values


def _interpolated(x: Array, values: Array, slope: float) -> Callable[[ArrayLike], Array]:
    """Return a shape-preserving cubic through the table, continued with ``slope``."""
    inner = PchipInterpolator(x, values)

    def function(position: ArrayLike) -> Array:
        inside = np.clip(position, x[0], x[-1])
        return np.asarray(inner(inside) + slope * (np.asarray(position) - inside))

    return function
