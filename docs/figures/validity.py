"""Draw how right the kinetic equation is without and with pair correlations.

Run it to write validity.png beside it, from the tables of kinetic_equation.md and correlations.md.
"""

import re
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import entitle, house_style, legend_above, panels

DOCS = Path(__file__).parents[1]
HELD_OUT = "## Chains that were held out"
DERIVED_WITH = "## Chains that it was derived with"
NUMBER = r"([-+]?[\d.]+)"
KINETIC_EQUATION = re.compile(
    rf"^\| {NUMBER}(, gamma = 4)? \| (\d+) \| {NUMBER} \| {NUMBER} \| {NUMBER} \| {NUMBER} \|$",
    re.MULTILINE,
)
BOTH = re.compile(
    rf"^\| (\d+) \| {NUMBER} \| 1 \| (\S+) -> {NUMBER} \| (\S+) -> {NUMBER} \|", re.MULTILINE
)
LINEAR = 2.0  # per cent; the axis is linear up to there, and logarithmic beyond
TICKS = (0, 0.5, 0.75, 0.9, 0.98, 1)
DRIVEN = 0.14  # where e = 1.05 stands, beyond the break of the axis
MARKERS_OF_DRIVEN = {30: "x", 60: "+", 100: "*"}


class Error(NamedTuple):
    """Errors of W_v of one chain, in per cent."""

    size: int
    restitution: float
    centre: float
    border: float
    held_out: bool
    driven: bool = False


def independent() -> list[Error]:
    """Return the rows of the kinetic equation's page."""
    text = (DOCS / "kinetic_equation.md").read_text(encoding="utf-8")
    return [
        Error(int(size), float(e), float(centre), float(border), False, bool(driven))
        for e, driven, size, centre, border, _, _ in KINETIC_EQUATION.findall(text)
    ]


def of_both() -> tuple[list[Error], list[Error]]:
    """Return the rows of the correlations' page: without correlations, and with them."""
    text = (DOCS / "correlations.md").read_text(encoding="utf-8")
    without, with_them = list[Error](), list[Error]()
    for heading in (HELD_OUT, DERIVED_WITH):
        part = text.split(heading + "\n")[1].split("\n## ")[0]
        for size, e, *errors in BOTH.findall(part):
            held_out = heading == HELD_OUT
            if errors[0] != "-":  # solved without correlations as well
                values = float(errors[0]), float(errors[2])
                without.append(Error(int(size), float(e), *values, held_out))
            values = float(errors[1]), float(errors[3])
            with_them.append(Error(int(size), float(e), *values, held_out))
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
            ax.plot(
                [place(each) for each in shown],
                [getattr(each, which) for each in shown],
                markerfacecolor=look["color"] if held_out else "none",
                label=f"$L = {size}$" + (", held out" if held_out else "") if shown else None,
                **look,
            )
    for each in (each for each in errors if each.driven):
        label, marker = rf"$L = {each.size}$, $\gamma = 4$", MARKERS_OF_DRIVEN[each.size]
        ax.plot(DRIVEN, getattr(each, which), marker, color="black", mfc="none", label=label)


def finish(ax: Axes) -> None:
    """Give a panel its axes."""
    ax.axhspan(-LINEAR, LINEAR, color="0.93", zorder=0)
    ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    ax.set_yscale("symlog", linthresh=LINEAR)
    ax.set_yticks([-50, -20, -10, -5, -2, 0, 2, 5], minor=False)
    ax.set_yticks([], minor=True)
    ax.yaxis.set_major_formatter(lambda value, _: f"{value:+g}" if value else "0")
    ax.set_ylim(-60, 8)
    ax.set_xticks([*(-np.sqrt(1 - np.array(TICKS))), DRIVEN], [*(f"{e:g}" for e in TICKS), "1.05"])
    ax.set_xlim(-1.05, 1.5 * DRIVEN)
    ax.annotate("//", (DRIVEN / 2, 0), xycoords=("data", "axes fraction"), ha="center", va="center")


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
            theory = ("independent points", "with pair correlations")[number // 2]
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
