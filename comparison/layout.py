"""How pictures are laid out: in one style, one or two columns of a journal wide, panels lettered.

``plt.style.use("crazybilliards.comparison.figures")`` gives other pictures the same style.
"""

from __future__ import annotations

import string
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties

Columns = Literal[1, 2]

_STYLE = "crazybilliards.comparison.figures"
_WIDTHS: dict[Columns, float] = {1: 3.4, 2: 7.0}  # inches
_LEAST_WIDTH = 1.6  # of a panel: narrower ones go below one another

_columns: ContextVar[Columns | None] = ContextVar("columns", default=None)


@contextmanager
def house_style(columns: Columns | None = None) -> Iterator[None]:
    """Draw in the style of the package, and save there as well: some of it acts only then.

    ``columns``: the width of every picture, 1 or 2 columns of a journal; None: as its panels need.
    """
    before = _columns.set(columns)
    try:
        with plt.style.context(_STYLE):
            yield
    finally:
        _columns.reset(before)


def picture_width(wanted: Columns) -> float:
    """Return the width in inches of a picture that is best in so many columns."""
    return _WIDTHS[_columns.get() or wanted]


def panels(
    rows: int, columns: int, *, height: float = 2.4, wanted: Columns = 2, **how: Any
) -> tuple[Figure, list[Axes]]:
    """Make a figure with lettered panels, row by row; one below the other where it is narrow.

    ``height`` [inch] is that of a row, ``wanted`` the width that suits the figure, in columns of a
    journal, and ``how`` as ``plt.subplots`` takes it.
    """
    width = picture_width(wanted)
    if width / columns < _LEAST_WIDTH or (columns > 1 and width < _WIDTHS[wanted]):
        rows, columns = rows * columns, 1
        how.pop("width_ratios", None)
        if len(how.get("height_ratios", ())) not in (0, rows):
            del how["height_ratios"]
    figure, axes = plt.subplots(rows, columns, figsize=(width, height * rows), squeeze=False, **how)
    made = list(axes.ravel())
    if len(made) > 1:
        letter(made)
    return figure, made


def mosaic(
    pattern: Sequence[Sequence[str]], *, height: float, **how: Any
) -> tuple[Figure, dict[str, Axes]]:
    """Make a figure of two columns with lettered panels of several sizes, by their names.

    In one column they go below one another. ``pattern`` and ``how`` as ``plt.subplot_mosaic``
    takes them; ``height`` [inch] is that of the wide figure.
    """
    names = list(dict.fromkeys(name for row in pattern for name in row))
    width = picture_width(2)
    if width < _WIDTHS[2]:
        pattern, height, how = [[name] for name in names], 2.0 * len(names), {}
    figure, axes = plt.subplot_mosaic(
        [list(row) for row in pattern], figsize=(width, height), **how
    )
    letter([axes[name] for name in names])
    return figure, axes


def letter(axes: Sequence[Axes]) -> None:
    """Call panels (a), (b), ..."""
    for name, ax in zip(string.ascii_lowercase, axes, strict=False):
        ax.set_title(f"({name})", loc="left")


def entitle(ax: Axes, text: str) -> None:
    """Write what a panel shows behind its letter."""
    ax.set_title(f"{ax.get_title(loc='left')}  {text}".strip(), loc="left")


def at_the_left(ax: Axes) -> bool:
    """Whether a panel stands at the left, where an axis that several share has its label."""
    place = ax.get_subplotspec()
    return place is None or place.is_first_col()


def label_outer(axes: Sequence[Axes], *, x: str, y: str) -> None:
    """Label shared axes below the lowest panel of every column, with numbers, and at the left.

    The last row may be shorter than the others.
    """
    places = [(place, ax) for ax in axes if (place := ax.get_subplotspec())]
    for ax in {place.colspan.start: ax for place, ax in places}.values():
        ax.set_xlabel(x)
        ax.tick_params(labelbottom=True)
    for ax in filter(at_the_left, axes):
        ax.set_ylabel(y)


def legend_above(figure: Figure, ax: Axes, title: str | None = None) -> None:
    """Put the legend of one panel over all of them, in as many columns as fit."""
    handles, labels = ax.get_legend_handles_labels()
    if not handles:
        return
    size = FontProperties(size=plt.rcParams["legend.fontsize"]).get_size_in_points() / 72
    longest = max(len(text.replace("$", "").replace("\\", "")) for text in labels)
    fit = max(1, int(figure.get_figwidth() / (size * (0.55 * longest + 4))))
    rows = int(np.ceil(len(labels) / fit))
    figure.legend(
        handles,
        labels,
        loc="outside upper center",
        ncols=int(np.ceil(len(labels) / rows)),
        title=title,
    )
