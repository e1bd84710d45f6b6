"""How pictures are laid out: in one style, one or two columns of a journal wide, panels lettered.

``plt.style.use("crazybilliards.comparison.figures")`` gives other pictures the same style. Figures
that are written to files are made without pyplot, and without the settings of the reader.
"""

import string
from collections.abc import Iterable
from contextlib import AbstractContextManager
from typing import Any

from matplotlib import rcParams, style
from matplotlib.axes import Axes
from matplotlib.figure import Figure

ONE_COLUMN, TWO_COLUMNS = 3.4, 7.0  # widths of journals in inches


def house_style() -> AbstractContextManager[None]:
    """Draw in the style of the package alone, and save there as well: some of it acts only then."""
    ffmpeg = {"animation.ffmpeg_path": rcParams["animation.ffmpeg_path"]}  # a place, and no look
    return style.context(["default", ffmpeg, "crazybilliards.comparison.figures"])


def panels(
    rows: int, columns: int, *, height: float = 2.4, **how: Any
) -> tuple[Figure, list[Axes]]:
    """Make a figure with lettered panels, row by row, one column of a journal wide or two.

    ``height`` [inch] is that of a row, and ``how`` as ``Figure.subplots`` takes it.
    """
    width = ONE_COLUMN if columns == 1 else TWO_COLUMNS
    figure = Figure(figsize=(width, height * rows))
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
    longest = max(len(label.replace("$", "").replace("\\", "")) for label in entries)
    columns = max(1, int(figure.get_figwidth() / (0.06 * longest + 0.4)))
    how: Any = {"loc": "outside upper center", "ncols": min(columns, len(entries)), "title": title}
    figure.legend(entries.values(), entries.keys(), **how)
