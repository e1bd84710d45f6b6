"""Draw why displacements are too large in the theory with pair correlations.

Run it to write correlated_displacements.png beside it, from docs/tables.
"""

import csv
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import entitle, house_style, panels

TABLES = Path(__file__).parents[1] / "tables"
PLACES = "contact 1", "contact 4", "contact 10", "centre"
QUANTITIES = {
    "h_gg": "$h_{gg}$, two distances",
    "h_gTheta": r"$h_{g\Theta}$, distance and temperature",
}
SIZES = 30, 100, 300, 1000
TICKS = (0, 0.5, 0.75, 0.9, 1)


def table(name: str) -> list[dict[str, str]]:
    """Return the rows of a table of the documentation."""
    with open(TABLES / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def draw_ingredient(ax: Axes, quantity: str) -> None:
    """Draw what the theory has against what the simulation has, at four contacts of each chain."""
    rows = [row for row in table("correlations_ingredients") if row["quantity"] == quantity]
    for colour, symbol, row in zip(COLOURS, SYMBOLS, rows, strict=False):
        simulated, theory = zip(*(row[place].split(" / ") for place in PLACES), strict=True)
        value, error = np.array([each.split(" ± ") for each in simulated], dtype=float).T
        ax.errorbar(
            value,
            np.array(theory, dtype=float),
            xerr=error,
            fmt=symbol,
            color=colour,
            markerfacecolor="none",
            label=f"$L = {row['L']}$, $e = {row['e']}$",
        )
    ax.axline((0, 0), slope=1, color="0.6", linewidth=0.6, zorder=0)
    ax.set(xlabel="simulation", ylabel="theory")
    ax.legend()


def draw_widths(ax: Axes) -> None:
    """Draw the mean error of the displacement widths against the restitution."""
    found: dict[int, list[tuple[float, float]]] = {size: [] for size in SIZES}
    for row in table("correlations_derived_with"):
        if row["gamma"] == "1" and int(row["L"]) in found:
            place = -np.sqrt(1 - float(row["e"]))
            found[int(row["L"])].append((place, float(row["W_x rods 2 to L/2, %"])))
    for number, (size, points) in enumerate(found.items()):
        ax.plot(
            *np.array(sorted(points)).T,
            color=COLOURS[number % len(COLOURS)],
            marker=SYMBOLS[number % len(SYMBOLS)],
            linewidth=0.8,
            markerfacecolor="none",
            label=f"{size}",
        )
    ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    ax.set_xticks(-np.sqrt(1 - np.array(TICKS)), [f"{e:g}" for e in TICKS])
    ax.set(xlabel=r"restitution $e$, linear in $\sqrt{1 - e}$", ylabel="theory $-$ simulation [%]")
    ax.set_ylim(-1.5, 34)  # room for the legend
    ax.legend(title="$L$", ncols=2, loc="upper right")


def main() -> None:
    """Write the picture."""
    with house_style():
        figure, axes = panels(1, 3, height=2.7)
        for ax, (quantity, title) in zip(axes, QUANTITIES.items(), strict=False):
            draw_ingredient(ax, quantity)
            entitle(ax, title)
        draw_widths(axes[2])
        entitle(axes[2], "$W_x$, mean of the rods 2 to $L/2$")
        figure.savefig(Path(__file__).with_suffix(".png"))
        plt.close(figure)


if __name__ == "__main__":
    mpl.use("Agg")
    main()
