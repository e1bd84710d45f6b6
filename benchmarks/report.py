"""Table and figure of the documentation, from the measurements of ``make benchmark``.

python benchmarks/report.py results/benchmark.json docs/tables/cost.csv docs/figures/cost.png
"""

import csv
import json
import re
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
from particle_steps import NOISE, SIZES, WORK

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import house_style, legend_above, panels


def main(source: Path, table: Path, figure: Path) -> None:
    costs: dict[str, dict[int, float]] = defaultdict(dict)
    for measured in json.loads(source.read_text())["benchmarks"]:
        info = measured["extra_info"]
        if "particle_steps" in info:
            cost = measured["stats"]["median"] / info["particle_steps"] * 1e9
            costs[info["work"]][info["size"]] = cost
            if "default step" in info["work"] and info["collisions"]:
                rate = info["collisions"] / measured["stats"]["median"]
                print(f"{info['work']}, L = {info['size']}: {rate:.2g} collisions per second")
    noise = costs[NOISE]
    print("noise alone [ns]:", ", ".join(f"{cost:.1f}" for cost in noise.values()))
    with table.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["", *(f"L = {_spaced(size)}" for size in SIZES)])
        for work in WORK:
            cells = [
                f"{_short(cost)} ({_short(cost / noise[size])}x)" if cost else ""
                for size in SIZES
                for cost in [costs[work].get(size)]
            ]
            writer.writerow([work, *cells])
    draw(costs, figure)


def _spaced(size: int) -> str:
    return f"{size:,}".replace(",", " ") if size >= 10_000 else str(size)


def _short(value: float) -> str:
    return f"{value:.1f}" if value < 10 else f"{value:.0f}"


def with_formula(work: str) -> str:
    """Return the name of some work with restitution and time step as formulas."""
    named = re.sub(r"\be = ([\d.]+)", r"$e = \1$", work)
    return named.replace("dt = 1e-3", r"$\Delta t = 10^{-3}$")


def draw(costs: dict[str, dict[int, float]], figure: Path) -> None:
    with house_style():
        drawn, [ax] = panels(1, 1, height=4.2)
        for number, (work, by_size) in enumerate(costs.items()):
            look: dict[str, Any] = {"color": "0.5", "linestyle": "--"}
            if work != NOISE:
                look = {"color": COLOURS[number - 1], "marker": SYMBOLS[number - 1]}
                look |= {"markerfacecolor": "none"}
            ax.plot(list(by_size), list(by_size.values()), label=with_formula(work), **look)
        ax.set(xscale="log", yscale="log", xlabel="rods $L$", ylabel="cost per rod and step [ns]")
        ax.set_ylim(0.7, 2e3)
        legend_above(drawn, ax)
        drawn.savefig(figure)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
