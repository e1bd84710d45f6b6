"""Drawing results over one another: simulations as symbols, theories as lines; layout and style.

Pictures have one style, are one or two columns of a journal wide, and their panels have letters.
``plt.style.use("crazybilliards.comparison.figures")`` gives other pictures the same style. Figures
that are written to files are made without pyplot, and without the settings of the reader.
"""

import math
import string
from collections.abc import Iterable, Mapping
from contextlib import AbstractContextManager
from io import BytesIO
from itertools import cycle
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from matplotlib import rcParams
from matplotlib import style as styles
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from crazybilliards.comparison.curves import find_curves, shared_label
from crazybilliards.model.checks import check_choice, shown

Along = Literal["normalized_particle", "mean_position"]

# Okabe and Ito's colours, distinct for any colour vision; symbols and line styles differ too.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#000000")
# The colours of velocities: what moves to the left is blue, what moves to the right orange.
DIRECTIONS = LinearSegmentedColormap.from_list("directions", (COLOURS[0], "#F0F0F0", COLOURS[1]))
SYMBOLS = "osD^v<"
_DASHES = ("-", "--", ":", "-.")
ONE_COLUMN, TWO_COLUMNS = 3.4, 7.0  # widths of journals in inches
_NO_DATE = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
_ALL, _SOME = 60, 30  # symbols of a curve: so many values are all drawn, of more values some


def overlay(
    results: Mapping[str, xr.Dataset | xr.DataArray | tuple[ArrayLike, ArrayLike]],
    quantity: str = "density",
    *,
    along: Along = "normalized_particle",
    ax: Axes | None = None,
    style: Mapping[str, Mapping[str, Any]] | None = None,
) -> Axes:
    """Draw one quantity of several results in one picture, in the current style of matplotlib.

    Parameters
    ----------
    results
        ``{label: result}``. Simulations are drawn as symbols with their standard errors, theories
        as lines, in the order given. Of more than 60 values all are drawn as a thin line, and
        evenly spaced ones also as symbols. Data of your own, in the same units, are a Dataset or a
        DataArray with a coordinate of the same name, or two columns such as ``(x, density)``:
        lines, and symbols if a Dataset has DENSITY_error, say. Whether they are smoothed like the
        results is not known.
    quantity
        A variable over one dimension, such as x, time, particle, mode or velocity. Densities must
        be smoothed all or not at all. ``velocity_density`` is the mean over all rods, unless one
        particle was chosen.
    along
        Abscissa of a quantity over particle: i_n in -1..1, or the mean position of the rods. A
        contact lies at the i_n half way between its rods.
    ax
        Axes to draw into; None: those of a new figure.
    style
        ``{label: keywords}`` for matplotlib, of ``errorbar`` for a simulation and of ``plot`` for
        a theory, instead of those chosen here: ``{"run 2": {"color": "red", "alpha": 0.5}}``.

    Raises
    ------
    ValueError
        If ``results`` are not given by labels, if one lacks the quantity, has it in another unit
        or over another or several dimensions, or if ``style`` names no result.

    Returns
    -------
    matplotlib.axes.Axes
        The axes, without a legend; call its ``legend()``.
    """
    # A Dataset and a tree of them are mappings, too.
    if isinstance(results, xr.Dataset | xr.DataTree) or not (
        isinstance(results, Mapping) and results
    ):
        raise ValueError(
            "overlay takes results by their labels, e.g. {'simulation': run, 'theory': theory}, "
            f"got {shown(results)}"
        )
    check_choice("along", along, get_args(Along))
    curves = find_curves(results, quantity, along)
    xlabel = shared_label({label: curve.abscissa for label, curve in curves.items()})
    ylabel = shared_label({label: curve.values for label, curve in curves.items()})
    style = style or {}
    for label in style:
        check_choice("style: a label", label, results)
    if ax is None:
        import matplotlib.pyplot as plt  # the only picture that is shown by the reader's backend

        _, ax = plt.subplots(layout="constrained")
    symbols, dashes = cycle(SYMBOLS), cycle(_DASHES)
    for label, (abscissa, values, error, measured) in curves.items():
        how = {"label": label, **style.get(label, {})}
        if measured:
            spread = None if error is None else error.values
            draw_measured(
                ax, abscissa.values, values.values, spread, **{"marker": next(symbols)} | how
            )
        else:
            ax.plot(abscissa, values, **{"linestyle": next(dashes)} | how)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    least = min(np.fmin.reduce(each.values.values, initial=np.inf) for each in curves.values())
    if quantity.endswith("density") and least >= 0 and ax.get_autoscaley_on():
        low, high = ax.get_ylim()
        ax.set_ylim(max(low, 0.0), high, auto=None)  # the margin and error bars reach below 0
    return ax


def draw_measured(
    ax: Axes, x: ArrayLike, values: ArrayLike, errors: ArrayLike | None = None, **how: Any
) -> None:
    """Draw measured values as symbols with error bars.

    Of more than 60 all are drawn as a thin line, pale so that noise hides nothing, and evenly
    spaced ones as symbols; make an axis logarithmic before. ``how``: keywords of ``errorbar``.
    """
    count = np.size(x)
    look: dict[str, Any] = {"linestyle": "none", "linewidth": 0.7, "markerfacecolor": "none"}
    if count > _ALL:
        drawn = np.arange(0, count, count // _SOME)
        if ax.get_xscale() == "log":
            drawn = np.unique(np.geomspace(1, count, _SOME).round().astype(int)) - 1
        look |= {"linestyle": "-", "markevery": list(drawn), "errorevery": drawn}
    look |= {"zorder": 1.8} | how  # below the lines of theories
    [line, *_] = ax.errorbar(x, values, errors, **look).lines
    if count > _ALL and line.get_marker() != "none":
        line.set(markeredgecolor=line.get_markeredgecolor(), color=(line.get_color(), 0.4))


def draw_rods(
    ax: Axes,
    run: xr.Dataset,
    quantity: str,
    *,
    number: int,
    unit: float = 1.0,
    along: str = "normalized_particle",
    **how: Any,
) -> None:
    """Draw a quantity of simulated rods, divided by ``unit``, in the look of that number.

    ``how``: keywords of ``errorbar``, instead of those of that look as well.
    """
    values, errors = (run[name].values / unit for name in (quantity, f"{quantity}_error"))
    draw_measured(ax, run[along].values, values, errors, **_look(number) | how)


def draw_points(
    ax: Axes, x: ArrayLike, values: ArrayLike, errors: ArrayLike, *, number: int, **how: Any
) -> None:
    """Draw a few measured numbers as symbols with error bars; the rest as in draw_rods."""
    ax.errorbar(
        x, values, errors, **{"linestyle": "none", "markerfacecolor": "none"} | _look(number) | how
    )


def _look(number: int) -> dict[str, Any]:
    return {"color": COLOURS[number % len(COLOURS)], "marker": SYMBOLS[number % len(SYMBOLS)]}


def mark_clipped(ax: Axes) -> None:
    """Put a triangle on the frame above or below every symbol that lies beyond it."""
    low, high = ax.get_ylim()
    for container in [each for each in ax.containers if isinstance(each, ErrorbarContainer)]:
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


def house_style() -> AbstractContextManager[None]:
    """Draw in the style of the package alone, and save there as well: some of it acts only then."""
    ffmpeg = {"animation.ffmpeg_path": rcParams["animation.ffmpeg_path"]}  # a place, and no look
    return styles.context(["default", ffmpeg, "crazybilliards.comparison.figures"])


def as_file(figure: Figure, kind: str = "png") -> bytes:
    """Return a picture as a file, which is the same whenever it is drawn."""
    content = BytesIO()
    figure.savefig(content, format=kind, metadata=_NO_DATE.get(kind))
    return content.getvalue()


def panels(
    rows: int, columns: int, *, height: float = 2.4, **how: Any
) -> tuple[Figure, list[Axes]]:
    """Make a figure with lettered panels, row by row, one column of a journal wide or two.

    ``height`` [inch] is that of a row, and ``how`` as ``Figure.subplots`` takes it.
    """
    figure = Figure(figsize=(ONE_COLUMN if columns == 1 else TWO_COLUMNS, height * rows))
    axes = list(figure.subplots(rows, columns, squeeze=False, **how).ravel())
    if len(axes) > 1:
        letter(axes)
    return figure, axes


def letter(axes: Iterable[Axes]) -> None:
    """Call panels (a), (b), ..."""
    for name, ax in zip(string.ascii_lowercase, axes, strict=False):
        ax.set_title(f"({name})", loc="left")


def entitle(ax: Axes, text: str) -> None:
    """Write what a panel shows behind its letter."""
    ax.set_title(f"{ax.get_title(loc='left')}  {text}".strip(), loc="left")


def legend_above(figure: Figure, *axes: Axes, title: str | None = None) -> None:
    """Put one legend of some panels over all of them, in as many columns as fit."""
    entries = {
        label: handle
        for ax in reversed(axes)  # the first of several with one name is shown
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    if not entries:
        return
    widths = [0.06 * len(label.replace("$", "").replace("\\", "")) + 0.4 for label in entries]
    width = figure.get_figwidth()
    in_a_row = len(entries) if sum(widths) < width else max(1, int(width / max(widths)))
    rows = math.ceil(len(entries) / in_a_row)
    figure.legend(
        entries.values(),
        entries.keys(),
        loc="outside upper center",
        ncols=math.ceil(len(entries) / rows),
        title=title,
    )
