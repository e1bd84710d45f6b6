"""Prescribed profiles: what a user may hand to the theories as <dx>(x) or as W^2(x).

A *table* (x, values), a *result* (simulated or exact) with ``mean_displacement`` or
``velocity_width`` of the particles, or a *callable* of x, such as the paper's arctanh fit. A
displacement that is callable may have an attribute ``support``, the interval (left, right) on which
it is finite; the density vanishes outside.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from crazybilliards.model import Chain
from crazybilliards.model.checks import shown
from crazybilliards.model.vocabulary import require

Prescribed = (
    xr.Dataset | Sequence[ArrayLike] | NDArray[np.float64] | Callable[[ArrayLike], ArrayLike]
)


class Profile(NamedTuple):
    """A function of x, and the interval on which it is defined."""

    function: Callable[[ArrayLike], ArrayLike]
    left: float
    right: float


def displacement_profile(chain: Chain, displacement: Prescribed) -> Profile:
    """Turn any accepted form of <dx>(x) into a :class:`Profile`, or say what is wrong.

    A table is continued with slope 1 to either side, the truth outside the chain, where a rod that
    goes further out leaves its anchor behind by as much.
    """
    if callable(displacement):
        left, right = getattr(displacement, "support", (-math.inf, math.inf))
        return Profile(_numbers("displacement", displacement), float(left), float(right))
    table = _table("displacement", "mean_displacement", chain, displacement)
    return Profile(_interpolated(*table, slope=1.0), -math.inf, math.inf)


def variance_profile(chain: Chain, variance: Prescribed) -> Profile:
    """Turn any accepted form of W^2(x) into a :class:`Profile`; a table goes on as it ends."""
    if callable(variance):
        function = _numbers("velocity_variance", variance)
    else:
        x, values = _table("velocity_variance", "velocity_width", chain, variance)
        if isinstance(variance, xr.Dataset):
            values = values**2
        function = _interpolated(x, values, slope=0.0)

    def positive(x: ArrayLike) -> NDArray[np.float64]:
        values = np.asarray(function(x))
        if not (np.isfinite(values).all() and (values > 0).all()):
            raise ValueError("velocity_variance must be finite and positive everywhere")
        return values

    positive(chain.anchors)
    return Profile(positive, -math.inf, math.inf)


def _numbers(
    name: str, function: Callable[[ArrayLike], ArrayLike]
) -> Callable[[ArrayLike], NDArray[np.float64]]:
    """Return a user's function, checked at each call: numbers, as many as positions."""

    def checked(x: ArrayLike) -> NDArray[np.float64]:
        values = function(x)
        try:
            return np.broadcast_to(np.asarray(values, dtype=float), np.shape(x))
        except (TypeError, ValueError) as error:
            raise ValueError(
                f"{name}: the callable must return a number for each x, got {shown(values)}"
            ) from error

    return checked


def _table(
    name: str, variable: str, chain: Chain, source: xr.Dataset | Sequence[ArrayLike] | Any
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return x and values of a table, or of a result's particles at their mean positions."""
    if isinstance(source, xr.Dataset):
        require(source, (variable, "mean_displacement"))
        if source.sizes.get("particle") != chain.size:
            raise ValueError(
                f"{name}: the result has {source.sizes.get('particle')} particles, the chain "
                f"{chain.size}"
            )
        return chain.anchors + source.mean_displacement.values, source[variable].values
    try:
        x, values = (np.asarray(column, dtype=float) for column in source)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(
            f"{name} takes a table (x, values), a result with {variable}, or a callable of x, got "
            f"{type(source).__name__}"
        ) from error
    if x.shape != values.shape or x.ndim != 1 or x.size < 2:
        raise ValueError(
            f"{name}: a table needs two equally long columns of at least 2 rows, got shapes "
            f"{x.shape} and {values.shape}"
        )
    if not (np.isfinite(x).all() and np.isfinite(values).all() and (np.diff(x) > 0).all()):
        raise ValueError(f"{name}: the table must be finite and its x ascending")
    return x, values


def _interpolated(
    x: NDArray[np.float64], values: NDArray[np.float64], slope: float
) -> Callable[[ArrayLike], NDArray[np.float64]]:
    """Shape-preserving cubic through the table, continued with ``slope`` to either side."""
    inner = PchipInterpolator(x, values)

    def function(position: ArrayLike) -> NDArray[np.float64]:
        inside = np.clip(position, x[0], x[-1])
        return np.asarray(inner(inside) + slope * (np.asarray(position) - inside))

    return function
