"""Drawing results over one another: simulations as symbols, theories as lines."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle, pairwise
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.container import ErrorbarContainer
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model.vocabulary import require

Array = NDArray[np.float64]

# Okabe and Ito's colours, distinct for any colour vision; symbols and line styles differ too.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#000000")
SYMBOLS = "osD^v<>"
_SIMULATIONS: tuple[dict[str, Any], ...] = (
    {"color": "#000000", "marker": "o"},
    {"color": "#D55E00", "marker": "s"},
    {"color": "#56B4E9", "marker": "D"},
    {"color": "#0072B2", "marker": "^"},
)
_LINES: tuple[dict[str, Any], ...] = (
    {"color": "#E69F00", "linestyle": "-", "linewidth": 2.0},
    {"color": "#0072B2", "linestyle": "--", "linewidth": 1.4},
    {"color": "#CC79A7", "linestyle": ":", "linewidth": 1.8},
    {"color": "#009E73", "linestyle": "-.", "linewidth": 1.4},
)
_MOST_SYMBOLS = 60
_SEEN = 0.01  # of the height of the picture, between a curve and a line
# Standard errors between a curve and lines from node to node that noise makes: at most, of hundreds
# of nodes whose errors are themselves uncertain, and their root mean square, 1.2 to 1.3.
_LARGEST, _TYPICAL = 6.0, 2.0
# How axes are labelled; other variables by their long names.
_LABELS = {
    "density": r"density $\rho$",
    "label": "rods to the left $N$",
    "displacement": r"displacement $\langle\Delta x\rangle$",
    "mean_displacement": r"displacement $\langle\Delta x\rangle$",
    "displacement_width": "displacement width $W_x$",
    "velocity_width": "velocity width $W_v$",
    "velocity_variance": "velocity variance $W^2$",
    "flow_velocity": "flow velocity $V$",
    "kinetic_energy": "kinetic energy $E$",
    "x": "position $x$",
    "time": "time $t$",
    "mean_position": r"mean position $\langle x_i\rangle$",
    "normalized_particle": "normalized particle $i_n$",
}


def overlay(
    results: Mapping[str, xr.Dataset],
    quantity: str = "density",
    *,
    along: Literal["normalized_particle", "mean_position"] = "normalized_particle",
    ax: Axes | None = None,
    style: Mapping[str, Mapping[str, Any]] | None = None,
) -> Axes:
    """Draw one quantity of several results in one picture.

    Parameters
    ----------
    results
        ``{label: result}``. Simulations are drawn as symbols with their standard errors, theories
        as lines, in the order given; every one has its own colour. Where the symbols of a
        simulation would hide waves between them, all its values are drawn instead, as a thin line
        in a band of one standard error.
    quantity
        A variable over x, time or particle. Smooth all densities in the same way first.
    along
        Abscissa of a quantity over particle: i_n in -1..1, or the mean position of the rods.
    ax
        Axes to draw into; None: those of a new figure.
    style
        ``{label: keywords}`` for matplotlib, of ``errorbar`` for a simulation and of ``plot`` for
        a theory, instead of those chosen here: ``{"run 2": {"color": "red", "alpha": 0.5}}``.

    Raises
    ------
    ValueError
        If a result lacks the quantity, or has it over other dimensions than one of x, time and
        particle. For example, one time of a density over time and x must be chosen first. If
        ``style`` names no result.

    Returns
    -------
    matplotlib.axes.Axes
        The axes without a legend; call its ``legend()``.
    """
    for label, dataset in results.items():
        require(dataset, (quantity,))
        _require_curve(label, dataset[quantity])
    if unknown := set(style or {}) - set(results):
        raise ValueError(f"style: no result is called {min(unknown)!r}")
    if ax is None:
        _, ax = plt.subplots(layout="constrained")
    lines, symbols = cycle(_LINES), cycle(_SIMULATIONS)
    for label, dataset in results.items():
        values, own = dataset[quantity], dict((style or {}).get(label, {}))
        axes = [name for name in ("x", "time") if name in values.dims]
        abscissa = dataset[axes[0] if axes else along]
        look: dict[str, Any]
        if dataset.attrs.get("source") == "simulation":
            # The first and last rods are always drawn, because theories differ most at the border.
            count = min(abscissa.size, _MOST_SYMBOLS)
            shown = np.linspace(0, abscissa.size - 1, count).round().astype(int)
            error = dataset.get(f"{quantity}_error")
            look = {"markersize": 3.5, "label": label, "zorder": 3} | next(symbols) | own
            _draw_measured(ax, abscissa, values, error, shown, look)
        else:
            look = {"label": label, "zorder": 2}
            look |= next(lines) | own
            ax.plot(abscissa, values, **look)
        ax.set_xlabel(_axis_label(abscissa))
        ax.set_ylabel(_axis_label(values))
    return ax


def _require_curve(label: str, values: xr.DataArray) -> None:
    """Raise unless these are values over one dimension, that of an abscissa."""
    if values.dims in (("x",), ("time",), ("particle",)):
        return
    message = f"{label}: {values.name} is over ({', '.join(map(str, values.dims))})"
    if "time" in values.dims:
        raise ValueError(f"{message}; choose a time: .isel(time=...)")
    raise ValueError(f"{message}; overlay draws what is over x, time or particle")


def draw_rods(
    ax: Axes,
    run: xr.Dataset,
    quantity: str,
    *,
    number: int,
    label: str,
    unit: float = 1.0,
    along: str = "normalized_particle",
) -> None:
    """Draw a quantity of the rods as symbols with error bars; a long chain shows some rods.

    As in :func:`overlay` a thin line shows all rods where the symbols would not. Make an axis
    logarithmic before, because that changes what can be seen.

    Parameters
    ----------
    number
        Number of the colour and symbol.
    unit
        Unit to divide by.
    along
        Abscissa. ``particle`` is meant for a logarithmic axis and spaces the symbols for it.
    """
    spaced = np.geomspace if along == "particle" else np.linspace
    last = run.particle.size
    shown = np.unique(np.round(spaced(1, last, min(last, _MOST_SYMBOLS))).astype(int)) - 1
    look = {
        "color": COLOURS[number % len(COLOURS)],
        "marker": SYMBOLS[number % len(SYMBOLS)],
        "linewidth": 0.7,
        "label": label,
    }
    error = run[f"{quantity}_error"] / unit
    _draw_measured(ax, run[along], run[quantity] / unit, error, shown, look)


def draw_points(
    ax: Axes,
    x: ArrayLike,
    values: ArrayLike,
    errors: ArrayLike,
    *,
    number: int,
    label: str = "",
    **how: Any,
) -> None:
    """Draw a few measured numbers as symbols with error bars, in the colour of that number."""
    look = {"linestyle": "none", "markerfacecolor": "none", **how}
    colour, marker = COLOURS[number % len(COLOURS)], SYMBOLS[number % len(SYMBOLS)]
    ax.errorbar(x, values, errors, color=colour, marker=marker, label=label, **look)


def _draw_measured(
    ax: Axes,
    x: xr.DataArray,
    values: xr.DataArray,
    error: xr.DataArray | None,
    shown: NDArray[np.int64],
    look: Mapping[str, Any],
) -> None:
    """Draw the nodes ``shown`` as symbols with error bars, and the stretches they hide as a line.

    ``look``: color, label and other keywords of ``errorbar``.
    """
    at, y = x.values, values.values
    spread = np.zeros(y.size) if error is None else error.values
    kept = shown[_tell_the_curve(ax, at, y, spread, shown)]
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
        curve = np.where(lined, y, np.nan)
        ax.plot(at, curve, linewidth=0.8, label="" if kept.size else look["label"], **same)
        band = same | {"alpha": 0.3 * same.get("alpha", 1.0), "linewidth": 0}
        ax.fill_between(at, curve - spread, curve + spread, **band)


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


def mark_clipped(ax: Axes) -> None:
    """Put a triangle on the frame above or below every symbol that lies beyond it."""
    low, high = ax.get_ylim()
    for container in ax.containers:
        if not isinstance(container, ErrorbarContainer):
            continue
        symbols = container.lines[0]
        x, y = (np.asarray(values, dtype=float) for values in symbols.get_data())
        for beyond, edge, marker in ((y > high, high, "^"), (y < low, low, "v")):
            ax.plot(
                x[beyond],
                np.full(beyond.sum(), edge),
                marker,
                color=symbols.get_color(),
                clip_on=False,
                zorder=4,
            )


def along_the_chain(ax: Axes) -> None:
    """Label the abscissa i_n, the normalized particle number."""
    ax.set(xlabel="normalized particle $i_n$", xticks=(-1, -0.5, 0, 0.5, 1))


def _axis_label(variable: xr.DataArray) -> str:
    unit = variable.attrs["units"]
    name = _LABELS.get(str(variable.name), variable.attrs["long_name"])
    return name + (f" [{unit}]" if unit != "1" else "")
