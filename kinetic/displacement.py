"""Prescribed displacement profiles <dx>(x): what a user may hand to the force balance.

A *table* (x, <dx>), a *result* with ``mean_displacement`` (simulated or exact), or a *callable*
of x, such as the paper's arctanh fit. A callable may have an attribute ``support``, the interval
(left, right) on which it is finite; the density vanishes outside.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import require

Displacement = (
    xr.Dataset | Sequence[ArrayLike] | NDArray[np.float64] | Callable[[ArrayLike], ArrayLike]
)


class Profile(NamedTuple):
    """<dx> as a function of x, and the interval on which it is defined."""

    function: Callable[[ArrayLike], ArrayLike]
    left: float
    right: float


def make_profile(chain: Chain, displacement: Displacement) -> Profile:
    """Turn any accepted form of displacement into a :class:`Profile`, or say what is wrong."""
    if callable(displacement):
        left, right = getattr(displacement, "support", (-math.inf, math.inf))
        return Profile(displacement, float(left), float(right))
    if isinstance(displacement, xr.Dataset):
        require(displacement, ("mean_displacement",))
        mean = displacement.mean_displacement.values
        if mean.size != chain.size:
            raise ValueError(
                f"displacement: the result has {mean.size} particles, the chain {chain.size}"
            )
        return _interpolated(chain.anchors + mean, mean)
    try:
        x, values = (np.asarray(column, dtype=float) for column in displacement)
    except (TypeError, ValueError) as error:
        raise ValueError(
            "displacement takes a table (x, displacement), a result with mean_displacement, or a "
            f"callable of x, got {type(displacement).__name__}"
        ) from error
    return _interpolated(x, values)


def _interpolated(x: NDArray[np.float64], values: NDArray[np.float64]) -> Profile:
    """Shape-preserving cubic through the table, continued with slope 1 to either side.

    Slope 1 is the truth outside the chain, where a rod that goes further out leaves its anchor
    behind by as much.
    """
    if x.shape != values.shape or x.ndim != 1 or x.size < 2:
        raise ValueError(
            "displacement: a table needs two equally long columns of at least 2 rows, got shapes "
            f"{x.shape} and {values.shape}"
        )
    if not (np.isfinite(x).all() and np.isfinite(values).all() and (np.diff(x) > 0).all()):
        raise ValueError("displacement: the table must be finite and its x ascending")
    inner = PchipInterpolator(x, values)

    def function(position: ArrayLike) -> NDArray[np.float64]:
        inside = np.clip(position, x[0], x[-1])
        return inner(inside) + (np.asarray(position) - inside)

    return Profile(function, -math.inf, math.inf)
