"""Draw the phase diagram of driven chains: critical size against damping.

Run it to write critical_size.png beside it. The simulations are those of
docs/tables/critical_size.csv; the lines are computed, which takes half a minute.
"""

import csv
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import house_style, panels
from crazybilliards.kinetic import critical_size
from crazybilliards.model import Chain

TABLE = Path(__file__).parents[1] / "tables" / "critical_size.csv"
RESTITUTIONS = {1.02: "-", 1.05: "--", 1.1: "-."}
DAMPINGS = (0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0)


def simulated() -> dict[float, np.ndarray]:
    """Return damping, critical size and its error of the simulations, by restitution."""
    with open(TABLE, encoding="utf-8", newline="") as file:
        rows = np.array(
            [
                [row["e"], row["gamma"], *row["simulation"].split(" ± ")]
                for row in csv.DictReader(file)
            ],
            dtype=float,
        )
    return {e: rows[rows[:, 0] == e, 1:].T for e in np.unique(rows[:, 0])}


def main() -> None:
    """Write the picture."""
    measured = simulated()
    assert set(measured) <= set(RESTITUTIONS), "a restitution of the table has no line"
    with house_style():
        figure, [ax] = panels(1, 1, height=2.9, wanted=1)
        for colour, (e, line) in zip(COLOURS, RESTITUTIONS.items(), strict=False):
            theory = [critical_size(Chain(restitution=e, damping=each)).value for each in DAMPINGS]
            ax.plot(DAMPINGS, theory, line, color=colour, label=f"kinetic equation, $e = {e:g}$")
        for number, e in enumerate(RESTITUTIONS):
            if e in measured:
                ax.errorbar(
                    *measured[e],
                    fmt=SYMBOLS[number],
                    markerfacecolor="none",
                    color=COLOURS[number],
                    label=f"simulation, $e = {e:g}$",
                )
        ax.text(0.97, 0.02, "steady states below the lines", ha="right", transform=ax.transAxes)
        ax.set(xlabel=r"damping $\gamma$ [$\sqrt{kM}$]", ylabel="number of rods $L$")
        ax.set(xlim=(0, 5.1), ylim=(0, 420))
        ax.legend(loc="upper left")
        figure.savefig(Path(__file__).with_suffix(".png"))
        plt.close(figure)


if __name__ == "__main__":
    mpl.use("Agg")
    main()
