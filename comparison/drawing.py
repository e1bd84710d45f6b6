"""Drawing results over one another: simulations as symbols, theories as lines."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from io import BytesIO
from typing import Any, Literal, get_args

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.container import ErrorbarContainer
from numpy.typing import ArrayLike

from crazybilliards.comparison.coverage import require_same_smoothing
from crazybilliards.comparison.curves import Curve, axis_label, find_curve, is_of_one_rod
from crazybilliards.comparison.layout import house_style, panels
from crazybilliards.comparison.symbols import MOST_SYMBOLS, draw_measured
from crazybilliards.model.checks import check_choice, check_path, got, shown
from crazybilliards.model.storage import write_atomically

Along = Literal["normalized_particle", "mean_position"]

# Okabe and Ito's colours, distinct for any colour vision; symbols and line styles differ too.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#000000")
# The colours of velocities: what moves to the left is blue, what moves to the right orange.
DIRECTIONS = LinearSegmentedColormap.from_list("directions", (COLOURS[0], "#F0F0F0", COLOURS[1]))
SYMBOLS = "osD^v<>"
_ON_PAPER = 200  # symbols of a curve at most


def _looks(order: Sequence[int], ways: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return every colour in every way once; neighbours differ in both."""
    return [
        {"color": COLOURS[order[n]]} | ways[(n + turn) % len(ways)]
        for turn in range(len(ways))
        for n in range(len(order))
    ]


_MARKERS = [{"marker": symbol} for symbol in SYMBOLS]
_NUMBERED = _looks(range(len(COLOURS)), _MARKERS)
_SIMULATIONS = _looks((6, 4, 5, 0, 1, 2, 3), _MARKERS)
_LINES = _looks(
    (1, 0, 3, 2, 4, 5, 6),
    (
        {"linestyle": "-", "linewidth": 2.0},
        {"linestyle": "--", "linewidth": 1.4},
        {"linestyle": ":", "linewidth": 1.8},
        {"linestyle": "-.", "linewidth": 1.4},
    ),
)


def overlay(
    results: Mapping[str, xr.Dataset],
    quantity: str = "density",
    *,
    along: Along = "normalized_particle",
    ax: Axes | None = None,
    style: Mapping[str, Mapping[str, Any]] | None = None,
    paper: str | os.PathLike[str] | None = None,
) -> Axes:
    """Draw one quantity of several results in one picture.

    Parameters
    ----------
    results
        ``{label: result}``. Simulations are drawn as symbols with their standard errors, theories
        as lines, in the order given. Every simulation has its own colour and symbol, up to 49, and
        every theory its own colour and line style, up to 28. Of more than 60 values (200 in a
        picture for print) evenly spaced ones and the last are drawn as symbols. Where the symbols
        of a simulation would hide waves between them, all its values are drawn instead, as a thin
        line in a band of one standard error. The picture is at least twenty median errors high.
    quantity
        A variable over x, time, particle, contact, mode, separation, velocity or velocity_bin.
        Densities must be smoothed all or not at all. ``velocity_density`` is that of a rod picked
        at random, unless one particle was chosen: the mean over all rods of a simulation, the
        integral over y of a ``phase_space_density``.
    along
        Abscissa of a quantity over particle: i_n in -1..1, or the mean position of the rods. A
        contact lies at the i_n half way between its rods.
    ax
        Axes to draw into; None: those of a new figure.
    style
        ``{label: keywords}`` for matplotlib, of ``errorbar`` for a simulation and of ``plot`` for
        a theory, instead of those chosen here: ``{"run 2": {"color": "red", "alpha": 0.5}}``. More
        than 49 simulations or 28 theories can be drawn if the others are given ``color`` and
        ``marker``, or ``color`` and ``linestyle``.
    paper
        A file for the picture, e.g. ``"density.pdf"``. It is drawn for print, with a legend: one
        column of a journal wide (3.4 inches), in letters of 8 points, in a pdf as letters that can
        be searched (Type 42).

    Raises
    ------
    ValueError
        If ``results`` are not given by labels, if one lacks the quantity, or has it over several
        dimensions: one time of a density over time and x must be chosen first. If ``style`` names
        no result, or lacks the looks of curves for which none is left. If ``paper`` is no name of a
        picture, or stands beside ``ax``.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, without a legend unless drawn for print; call its ``legend()``.
    """
    if paper is not None:
        if ax is not None:
            raise ValueError("paper: the picture has axes of its own, and ax must be None")
        file = check_path("paper", paper)
        if not file.suffix:
            raise ValueError(
                f"paper must be a name that ends in .pdf or .png, got {shown(str(file))}"
            )
        kind = check_choice("paper", file.suffix[1:], FigureCanvasBase.get_supported_filetypes())
    curves = _curves(results, quantity, along)
    if not (ax is None or isinstance(ax, Axes)):
        raise ValueError(f"ax must be Axes of matplotlib, got {shown(ax)}")
    style = {} if style is None else style
    words = [style, *(style.values() if isinstance(style, Mapping) else ())]
    if not all(isinstance(each, Mapping) for each in words):
        raise ValueError(f"style must be keywords of matplotlib by label, got {shown(style)}")
    for label in style:
        if label not in results:
            raise ValueError(f"style: the results are {got(label, list(results))}")
    looks = _choose(curves, style)
    if paper is None:
        if ax is None:
            _, ax = plt.subplots(layout="constrained")
        return _draw(ax, curves, looks, style)
    picture = BytesIO()
    with house_style():  # which acts when the file is written, too
        figure, [ax] = panels(1, 1, wanted=1)
        _draw(ax, curves, looks, style, most=_ON_PAPER).legend()
        figure.savefig(picture, format=kind)
    write_atomically(file, picture.getvalue())
    return ax


def _draw(
    ax: Axes,
    curves: Mapping[str, Curve],
    looks: Mapping[str, Mapping[str, Any]],
    style: Mapping[str, Mapping[str, Any]],
    most: int = MOST_SYMBOLS,
) -> Axes:
    """Draw simulations as symbols, at most so many, and theories as lines."""
    for label, (abscissa, values, error, measured) in curves.items():
        own, look = dict(style.get(label, {})), dict(label=label, **looks.get(label, {}))
        try:
            if measured:
                look = {"markersize": 3.5, "zorder": 3} | look | own
                spread = None if error is None else error.values
                draw_measured(ax, abscissa.values, values.values, spread, look, most=most)
            else:
                ax.plot(abscissa, values, **{"zorder": 2} | look | own)
        except (AttributeError, TypeError, ValueError) as problem:  # of matplotlib, for a keyword
            if not own:
                raise
            raise ValueError(f"style of {label!r}: {problem}") from problem
        ax.set_xlabel(axis_label(abscissa))
        ax.set_ylabel(axis_label(values))
    return ax


def _choose(
    curves: Mapping[str, Curve], style: Mapping[str, Mapping[str, Any]]
) -> dict[str, dict[str, Any]]:
    """Return a look for every curve; if too few are left, for those that ``style`` gives none."""
    chosen: dict[str, dict[str, Any]] = {}
    for measured, looks, way in ((True, _SIMULATIONS, "marker"), (False, _LINES, "linestyle")):
        labels = [label for label, each in curves.items() if each.measured == measured]
        if len(labels) > len(looks):
            labels = [each for each in labels if not {"color", way} <= style.get(each, {}).keys()]
        if len(labels) > len(looks):
            raise ValueError(
                f"style= must give color and {way} of {len(labels) - len(looks)} more curves: "
                f"there are {len(looks)} looks for {'simulations' if measured else 'theories'}"
            )
        chosen |= dict(zip(labels, looks, strict=False))
    return chosen


def _curves(results: Mapping[str, xr.Dataset], quantity: str, along: str) -> dict[str, Curve]:
    """Return what is drawn of every result, or raise before anything is drawn."""
    # A Dataset and a tree of them are mappings, too.
    if not isinstance(results, Mapping) or isinstance(results, xr.Dataset | xr.DataTree):
        raise ValueError(
            "overlay takes results by their labels, e.g. {'simulation': run, 'theory': theory}, "
            f"got a {type(results).__name__}"
        )
    check_choice("along", along, get_args(Along))
    if not isinstance(quantity, str):
        raise ValueError(f"quantity must be the name of a variable, got {shown(quantity)}")
    curves = {
        label: find_curve(label, dataset, quantity, along) for label, dataset in results.items()
    }
    if quantity == "density":
        require_same_smoothing(results)
    single = [label for label, dataset in results.items() if is_of_one_rod(dataset, quantity)]
    of_all = [label for label, dataset in results.items() if quantity not in dataset]
    if single and of_all:
        raise ValueError(f"{quantity}: {single[0]} is of one rod, {of_all[0]} of all rods")
    return curves


def draw_rods(
    ax: Axes,
    run: xr.Dataset,
    quantity: str,
    *,
    number: int,
    label: str,
    unit: float = 1.0,
    along: str = "normalized_particle",
    **how: Any,
) -> None:
    """Draw a quantity of the rods as symbols with error bars; a long chain shows some rods.

    As in :func:`overlay` a thin line shows all rods where the symbols would not. Make an axis
    logarithmic before, because that changes what can be seen. The values are divided by ``unit``.
    The abscissa ``along="particle"`` is meant for a logarithmic axis and spaces the symbols for it.
    ``how``: keywords of ``errorbar``, in place of those of the look of that number as well.
    """
    look = {**_NUMBERED[number], "linewidth": 0.7, "label": label, **how}
    values, error = (run[name].values / unit for name in (quantity, f"{quantity}_error"))
    logarithmic = along == "particle"
    draw_measured(ax, run[along].values, values, error, look, logarithmic=logarithmic)


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
    """Draw a few measured numbers as symbols with error bars, in the look of that number.

    ``how``: keywords of ``errorbar``, in place of those of that look as well.
    """
    look = {"linestyle": "none", "markerfacecolor": "none", **_NUMBERED[number]}
    ax.errorbar(x, values, errors, **look | {"label": label} | how)


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
