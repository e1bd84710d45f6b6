"""Drawing results over one another: simulations as symbols, theories as lines."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from crazybilliards.model.vocabulary import require

# Okabe and Ito's colours, distinct for any colour vision; symbols and line styles differ too.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#000000")
SYMBOLS = "osD^v<>"
_SYMBOL_COLOUR = "#000000"
_LINES: tuple[dict[str, Any], ...] = (
    {"color": "#E69F00", "linestyle": "-", "linewidth": 2.2},
    {"color": "#0072B2", "linestyle": "--", "linewidth": 1.6},
    {"color": "#CC79A7", "linestyle": ":", "linewidth": 2.0},
    {"color": "#009E73", "linestyle": "-.", "linewidth": 1.6},
)
_MOST_SYMBOLS = 60


def overlay(
    results: Mapping[str, xr.Dataset],
    quantity: str = "density",
    *,
    along: Literal["normalized_particle", "mean_position"] = "normalized_particle",
    ax: Axes | None = None,
) -> Axes:
    """Draw one quantity of several results in one picture.

    Parameters
    ----------
    results
        ``{label: result}``. Simulations are drawn as circles with their standard errors,
        theories as lines, in the order given.
    quantity
        A variable over x, time or particle. Smooth all densities in the same way first.
    along
        Abscissa of a quantity over particle: i_n in -1..1, or the mean position of the rods.
    ax
        Axes to draw into; None: those of a new figure.

    Raises
    ------
    ValueError
        If a result lacks the quantity, or has it over other dimensions than one of x, time and
        particle. For example, one time of a density over time and x must be chosen first.

    Returns
    -------
    matplotlib.axes.Axes
        The axes without a legend; call its ``legend()``.
    """
    for label, dataset in results.items():
        require(dataset, (quantity,))
        _require_curve(label, dataset[quantity])
    if ax is None:
        _, ax = plt.subplots(layout="constrained")
    lines = cycle(_LINES)
    for label, dataset in results.items():
        values = dataset[quantity]
        own = [name for name in ("x", "time") if name in values.dims]
        abscissa = dataset[own[0] if own else along]
        if dataset.attrs.get("source") == "simulation":
            # The first and last rods are always drawn, because theories differ most at the border.
            count = min(abscissa.size, _MOST_SYMBOLS)
            shown = np.linspace(0, abscissa.size - 1, count).round().astype(int)
            error = dataset.get(f"{quantity}_error")
            ax.errorbar(
                abscissa[shown],
                values[shown],
                None if error is None else error[shown],
                fmt="o",
                markersize=4.5,
                markerfacecolor="none",
                color=_SYMBOL_COLOUR,
                linewidth=0.8,
                label=label,
                zorder=3,
            )
        else:
            ax.plot(abscissa, values, label=label, zorder=2, **next(lines))
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
    colour = COLOURS[number % len(COLOURS)]
    ax.errorbar(
        run[along][shown],
        run[quantity][shown] / unit,
        run[f"{quantity}_error"][shown] / unit,
        fmt=SYMBOLS[number % len(SYMBOLS)],
        markersize=4,
        markerfacecolor="none",
        linewidth=0.8,
        color=colour,
        label=label,
    )


def along_the_chain(ax: Axes) -> None:
    """Label the abscissa i_n, the normalized particle number."""
    ax.set(xlabel="normalized particle $i_n$", xticks=(-1, -0.5, 0, 0.5, 1))


def _axis_label(variable: xr.DataArray) -> str:
    unit = variable.attrs["units"]
    return variable.attrs["long_name"] + (f" [{unit}]" if unit != "1" else "")
