"""Draw how right the kinetic equation is without and with pair correlations.

Run it to write validity.png beside it, from docs/tables.
"""

import csv
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import entitle, house_style, legend_above, panels

TABLES = Path(__file__).parents[1] / "tables"
LINEAR = 2.0  # per cent; the axis is linear up to there, and logarithmic beyond
LABELLED = (-50, -20, -10, -5, -2, 0, 2, 5)
# Even steps in the linear part, decades beyond: they show where the axis changes.
UNLABELLED = (-40, -30, *range(-9, -2), *np.arange(-1.5, 2, 0.5), 3, 4, 6, 7)
TICKS = (0, 0.5, 0.75, 0.9, 0.98, 1)
DRIVEN = 0.14  # where e = 1.05 stands, beyond the break of the axis
MARKERS_OF_DRIVEN = {30: "x", 60: "+", 100: "*"}
DRIVEN_COLOUR = "0.45"
LEFT = -1.13  # end of the axis


class Error(NamedTuple):
    """Errors of W_v of one chain, and the standard errors of its simulation, in per cent."""

    size: int
    restitution: float
    centre: float
    border: float
    centre_error: float
    border_error: float
    held_out: bool
    driven: bool = False


def table(name: str) -> list[dict[str, str]]:
    """Return the rows of a table."""
    with open(TABLES / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def independent() -> list[Error]:
    """Return the errors without correlations that were measured for them."""
    return [
        Error(
            int(row["L"]),
            float(row["e"]),
            float(row["centre, %"]),
            float(row["border, %"]),
            float(row["error of a rod, %"]),
            float(row["error of a rod, %"]),
            False,
            row["gamma"] == "4",
        )
        for row in table("kinetic_equation")
    ]


def of_both() -> tuple[list[Error], list[Error]]:
    """Return the errors in the tables of pair correlations, gamma = 1: without them, and with."""
    without, with_them = list[Error](), list[Error]()
    stated_in = {
        "correlations_held_out": "error of the centre, a rod, the border, %",
        "correlations_derived_with": "error of a rod, the border, %",
    }
    for name, column in stated_in.items():
        for row in (each for each in table(name) if each["gamma"] == "1"):
            # Of the centre, if it is there, a rod and the border; empty where none is stated.
            each = [float(number) for number in row[column].split(",") if number] or [np.nan]
            stated = each[0], each[-1], name == "correlations_held_out"
            for errors, suffix in ((without, " without, %"), (with_them, ", %")):
                if centre := row[f"W_v centre{suffix}"]:
                    border = float(row[f"W_v border{suffix}"])
                    chain = int(row["L"]), float(row["e"])
                    errors.append(Error(*chain, float(centre), border, *stated))
    return without, with_them


def place(error: Error) -> float:
    """Return where a restitution stands on the axis, which is linear in sqrt(1 - e)."""
    return DRIVEN if error.driven else -float(np.sqrt(1 - error.restitution))


def draw_errors(ax: Axes, errors: list[Error], which: str, sizes: list[int]) -> None:
    """Draw the errors in the centre or at the border against the restitution."""
    for number, size in enumerate(sizes):
        of_size = sorted((e for e in errors if e.size == size and not e.driven), key=place)
        look = {"color": COLOURS[number], "marker": SYMBOLS[number]}
        for held_out in (False, True):
            shown = [each for each in of_size if each.held_out == held_out]
            if not shown:
                continue
            ax.errorbar(
                [place(each) for each in shown],
                [getattr(each, which) for each in shown],
                [getattr(each, f"{which}_error") for each in shown],
                markerfacecolor=look["color"] if held_out else "none",
                label=f"$L = {size}$" + (", held out" if held_out else ""),
                linewidth=0.8,
                **look,
            )
    for each in (each for each in errors if each.driven):
        value, error = getattr(each, which), getattr(each, f"{which}_error")
        look = {"color": DRIVEN_COLOUR, "markerfacecolor": "none", "linestyle": "none"}
        label, marker = rf"$L = {each.size}$, $\gamma = 4$", MARKERS_OF_DRIVEN[each.size]
        ax.errorbar(DRIVEN, value, error, marker=marker, markersize=5, label=label, **look)


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
    ax.set_xticks([*(-np.sqrt(1 - np.array(TICKS))), DRIVEN], [*(f"{e:g}" for e in TICKS), "1.05"])
    ax.set_xlim(LEFT, 1.5 * DRIVEN)
    for y in (0, 1):
        gap = {"facecolor": "white", "edgecolor": "none", "pad": 0}
        ax.text(
            DRIVEN / 2,
            y,
            "//",
            transform=ax.get_xaxis_transform(),
            bbox=gap,
            ha="center",
            va="center",
        )


def main() -> None:
    """Write the picture."""
    without, with_them = of_both()
    known = {(each.size, each.restitution) for each in independent()}
    first = independent() + [
        each for each in without if (each.size, each.restitution) not in known and each.size > 10
    ]
    second = [each for each in with_them if each.size > 10]
    sizes = sorted({each.size for each in first if not each.driven})
    with house_style():
        figure, axes = panels(2, 2, height=2.6, sharex=True, sharey=True)
        for number, ax in enumerate(axes):
            which = ("centre", "border")[number % 2]
            draw_errors(ax, (first, second)[number // 2], which, sizes)
            finish(ax)
            theory = ("without pair correlations", "with pair correlations")[number // 2]
            entitle(ax, f"{which}, {theory}")
        for ax in axes[2:]:
            ax.set_xlabel(r"restitution $e$, linear in $\sqrt{1 - e}$ up to 1")
        for ax in axes[::2]:
            ax.set_ylabel("$W_v$: theory $-$ simulation [%]\n(negative: too small)")
        legend_above(figure, axes[0])
        figure.savefig(Path(__file__).with_suffix(".png"))
        plt.close(figure)


if __name__ == "__main__":
    mpl.use("Agg")
    main()
