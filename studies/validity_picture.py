"""Draw where the kinetic equation holds: errors of W_v against the restitution.

    python -m studies.validity_picture FOLDER

Draws FOLDER/validity.png from the tables that ``studies.validity`` has written there. The axis of
the error is linear in the shaded band and logarithmic beyond it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.layout import entitle, legend_above, panels
from studies.common import options, save_picture

TABLES = "kinetic_equation", "correlations_derived_with", "correlations_held_out"
EARLIER = (45, 180, 600)  # rods of the chains held out earlier
LEAST_DRAWN = 30  # rods, if not held out: chains of 10 are in the tables only
LINEAR = 2.0  # per cent; the axis is linear up to there, and logarithmic beyond
LABELLED = (-50, -20, -10, -5, -2, 0, 2, 5)
# Even steps in the linear part, decades beyond: they show where the axis changes.
UNLABELLED = (-40, -30, *range(-9, -2), *np.arange(-1.5, 2, 0.5), 3, 4, 6, 7)
RESTITUTIONS = (0, 0.5, 0.75, 0.9, 0.98, 1)
DRIVEN = 0.14  # where e > 1 stands, beyond the break of the axis
MARKERS_OF_DRIVEN = {30: "x", 60: "+", 100: "*"}
LEFT = -1.13  # end of the axis


def errors(folder: Path, *, pairs: bool) -> pd.DataFrame:
    """Return the errors of a theory, one row a chain of the usual damping, and driven ones."""
    found = []
    if not pairs:
        alone = pd.read_csv(folder / f"{TABLES[0]}.csv")
        alone = alone.rename(columns=lambda name: name.removesuffix(", %"))
        rod = alone["error of a rod"]  # bounds that of the centre
        found.append(alone.assign(centre_error=rod, border_error=rod, held_out=False))
    for table in TABLES[1:]:
        both = pd.read_csv(folder / f"{table}.csv")
        parts = both["error of the centre, a rod, the border, %"].str.split(", ", expand=True)
        which = "" if pairs else " without"
        values = {place: both[f"W_v {place}{which}, %"] for place in ("centre", "border")}
        bars = {"centre_error": parts[0].astype(float), "border_error": parts[2].astype(float)}
        found.append(both.assign(**values, **bars, held_out=table == TABLES[2]))
    every = pd.concat(found)
    usual = (every.gamma == 1) | (every.e > 1)
    drawn = every.held_out | (every.L >= LEAST_DRAWN) & ~every.L.isin(EARLIER)
    every = every[usual & drawn].drop_duplicates(["L", "e"])
    # The axis is linear in sqrt(1 - e).
    return every.assign(place=np.where(every.e > 1, DRIVEN, -np.sqrt(np.maximum(1 - every.e, 0))))


def draw_errors(ax: Axes, found: pd.DataFrame, which: str, sizes: list[int]) -> None:
    """Draw a line for each of the sizes, and one symbol for all chains held out."""
    driven = found.e > 1
    usual = found[~found.held_out & ~driven]
    groups = {f"$L = {size}$": usual[usual["L"] == size] for size in sizes}
    groups["held out"] = found[found.held_out]
    for number, (label, group) in enumerate(groups.items()):
        if not len(group):
            continue
        shown = group.sort_values("place")
        points = shown.place, shown[which], shown[f"{which}_error"]
        look: dict[str, Any] = {"markerfacecolor": "none", "linestyle": "-", "linewidth": 0.8}
        if label == "held out":
            look |= {"markerfacecolor": COLOURS[number], "linestyle": "none"}
        draw_points(ax, *points, number=number, label=label, **look)
    for _, each in found[driven].iterrows():
        look = {"marker": MARKERS_OF_DRIVEN[each.L], "markersize": 5, "markerfacecolor": "none"}
        look |= {"color": "0.45", "linestyle": "none"}
        label = rf"$L = {each.L}$, $\gamma = {each.gamma:g}$"
        ax.errorbar(each.place, each[which], each[f"{which}_error"], label=label, **look)


def finish(ax: Axes) -> None:
    """Give a panel its axes, and mark where they change."""
    ax.axhspan(-LINEAR, LINEAR, color="0.93", zorder=0)
    ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    ax.set_yscale("symlog", linthresh=LINEAR)
    ax.set_yticks(LABELLED)
    ax.set_yticks(UNLABELLED, minor=True)
    ax.yaxis.set_major_formatter(lambda value, _: f"{value:+g}" if value else "0")
    ax.yaxis.set_minor_formatter("")
    ax.set_ylim(-60, 8)
    for y, scale in ((4, "log."), (0, "linear"), (-11, "logarithmic")):
        ax.text(LEFT + 0.035, y, scale, rotation="vertical", va="center", color="0.4")
    places = [*-np.sqrt(1 - np.array(RESTITUTIONS)), DRIVEN]
    ax.set_xticks(places, [*(f"{e:g}" for e in RESTITUTIONS), "1.05"])
    ax.set_xlim(LEFT, 1.5 * DRIVEN)
    box = {"facecolor": "white", "edgecolor": "none", "pad": 0}
    for y in (0, 1):
        frame: dict[str, Any] = {"ha": "center", "va": "center", "bbox": box}
        ax.text(DRIVEN / 2, y, "//", transform=ax.get_xaxis_transform(), **frame)


def draw(folder: Path) -> Figure:
    figure, axes = panels(2, 2, height=2.6, sharex=True, sharey=True)
    both = {name: errors(folder, pairs=name == "with") for name in ("without", "with")}
    every = pd.concat(both.values())
    sizes = sorted(set(every.L[~every.held_out & (every.e <= 1)]))
    for number, ax in enumerate(axes):
        which, theory = ("centre", "border")[number % 2], ("without", "with")[number // 2]
        draw_errors(ax, both[theory], which, sizes)
        finish(ax)
        entitle(ax, f"{which}, {theory} pair correlations")
    for ax in axes[2:]:
        ax.set_xlabel(r"restitution $e$, linear in $\sqrt{1 - e}$ up to 1")
    for ax in axes[::2]:
        ax.set_ylabel("$W_v$: theory $-$ simulation [%]\n(negative: too small)")
    legend_above(figure, axes[0])
    return figure


if __name__ == "__main__":
    folder = options(__doc__, folder=Path).folder
    tables = [folder / f"{name}.csv" for name in TABLES]
    save_picture(folder / "validity.png", draw, folder, tables)
