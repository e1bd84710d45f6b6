"""Measured values as symbols, as a line where symbols would hide the curve, and room for noise."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from crazybilliards.model.arrays import Array

MOST_SYMBOLS = 60
LEAST_SEEN = 0.1  # of the free rod's width: an axis of widths or displacements is not lower
_SEEN = 0.01  # of the height of the picture, between a curve and a line
# Standard errors between a curve and lines from node to node that noise makes: at most, of hundreds
# of nodes whose errors are themselves uncertain, and their root mean square, 1.2 to 1.3.
_LARGEST, _TYPICAL = 6.0, 2.0
_NOISE = 20.0  # median errors: an axis is not lower, so that noise alone does not fill it


def draw_measured(
    ax: Axes,
    x: Array,
    values: Array,
    error: Array | None,
    look: Mapping[str, Any],
    *,
    most: int = MOST_SYMBOLS,
    logarithmic: bool = False,
) -> None:
    """Draw nodes as symbols with error bars, and the stretches they hide as a line.

    Of more than ``most`` nodes some are drawn: every second, every third or so on, and the last.
    ``logarithmic`` spaces them over the logarithms of their numbers.

    A node that is not known, or that a logarithmic axis cannot show, is left out. ``error`` None:
    standard errors are not known. ``look``: color, label and other keywords of ``errorbar``.
    The first and the last are always drawn, because theories differ most at the border.
    """
    known = np.isfinite(values) & np.isfinite(x)
    if ax.get_xscale() == "log":
        known &= x > 0
    if not known.any():
        return
    at, y = x[known], values[known]
    spread = np.zeros(y.size) if error is None else error[known]
    shown = _every(y.size, most)
    if logarithmic:
        shown = np.unique(np.round(np.geomspace(1, y.size, min(y.size, most))).astype(int)) - 1
    kept = shown[_tell_the_curve(ax, at, y, spread, shown)] if y.size > 1 else shown
    look = {"linestyle": "none", "linewidth": 0.8, "markerfacecolor": "none", **look}
    if kept.size:
        ax.errorbar(at[kept], y[kept], None if error is None else spread[kept], **look)
    lined = np.zeros(y.size, dtype=bool)
    for first, last in pairwise(shown):
        lined[first : last + 1] |= not {first, last} <= set(kept)
    if lined.any():
        same: dict[str, Any] = {
            name: look[name] for name in ("color", "alpha", "zorder") if name in look
        }
        curve, width = np.full((2, x.size), np.nan)  # with a break where a node is not known
        curve[known], width[known] = np.where(lined, y, np.nan), spread
        ax.plot(x, curve, linewidth=0.8, label="" if kept.size else look["label"], **same)
        band = same | {"alpha": 0.3 * same.get("alpha", 1.0), "linewidth": 0}
        ax.fill_between(x, curve - width, curve + width, **band)
    if np.isfinite(spread).any():
        keep_room(ax, y, _NOISE * float(np.nanmedian(spread)))


def keep_room(ax: Axes, values: Array, least: float) -> None:
    """Keep the vertical axis at least so high around these values: it does not magnify less."""
    low, high = np.nanmin(values), np.nanmax(values)
    if np.isfinite(least) and high - low < least:
        middle = (low + high) / 2
        room = [(0.0, middle - least / 2), (0.0, middle + least / 2)]
        ax.update_datalim(room, updatex=False)
        ax.autoscale_view(scalex=False)


def _every(count: int, most: int) -> NDArray[np.int64]:
    """Return the numbers of evenly spaced nodes and the last, which the best spacing meets."""
    least = max(1, math.ceil((count - 1) / (most - 1)))
    meeting = (each for each in range(least, 2 * least) if (count - 1) % each == 0)
    return np.unique([*range(0, count, next(meeting, least)), count - 1])


def _tell_the_curve(
    ax: Axes, x: Array, values: Array, error: Array, shown: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return which of the nodes ``shown`` can be symbols because they tell the curve around them.

    Symbols further apart than the waves of a curve would show waves that do not exist. Straight
    lines from a symbol to its neighbours must therefore follow all nodes between, to a hundredth
    of the picture or to what noise makes. If most symbols fail, or if the other nodes together are
    further off than noise makes them, none is left.
    """
    if ax.get_xscale() == "log":
        x = np.log(x)
    if ax.get_yscale() == "log":
        with np.errstate(divide="ignore", invalid="ignore"):
            values, error = np.log(values), error / values
    across, high = (float(np.nanmax(each) - np.nanmin(each)) or 1.0 for each in (x, values))
    stretch = np.searchsorted(shown[1:-1], np.arange(x.size), side="right")
    slopes = np.diff(values[shown]) / high / (np.diff(x[shown]) / across)
    seen = _SEEN * high * np.hypot(1.0, slopes)[stretch]  # a steep line is nearer than it is below
    missed = np.abs(values - np.interp(x, x[shown], values[shown]))
    missed[missed <= seen] = 0.0
    noise = np.where(np.isfinite(error), error, 0.0)
    hidden = stretch[~(missed <= _LARGEST * noise)]
    tells = np.ones(shown.size, dtype=bool)
    tells[hidden] = tells[hidden + 1] = False
    rest = ~np.isin(stretch, hidden) & (noise > 0)
    together = np.sum((missed[rest] / noise[rest]) ** 2) > _TYPICAL**2 * rest.sum()
    return tells & (tells.mean() > 0.5) & ~together
