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

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS, entitle, house_style, panels

SHORT = "dt = 1e-3"  # in the names of the work


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


def draw(costs: dict[str, dict[int, float]], figure: Path) -> None:
    """Draw the costs at the step of 1e-3, and those of elastic chains at their longer steps."""
    with house_style():
        drawn, axes = panels(1, 2, height=2.9, sharex=True, sharey=True)
        for ax, title in zip(axes, (SHORT, "$e = 1$"), strict=True):
            entitle(ax, title.replace("dt = 1e-3", r"$\Delta t = 10^{-3}\ t_0$"))
            noise = list(costs[NOISE].items())
            ax.plot(*zip(*noise, strict=True), color="0.5", linestyle="--", label=NOISE)
            ax.set(xscale="log", yscale="log", xlabel="rods $L$", ylim=(0.7, 1e4))
        axes[0].set_ylabel("cost per rod and step [ns]")
        for number, (work, by_size) in enumerate(costs.items()):
            if work != NOISE:
                ax = axes[SHORT not in work]
                label = work.replace(f", {SHORT}" if ax is axes[0] else ", e = 1", "")
                label = re.sub(r"\be = ([\d.]+)", r"$e = \1$", label)
                look: dict[str, Any] = {"color": COLOURS[number - 1], "marker": SYMBOLS[number - 1]}
                ax.plot(*zip(*by_size.items(), strict=True), label=label, **look)
        for ax in axes:
            for line in ax.lines:
                line.set_markerfacecolor("none")
            ax.legend(loc="upper left")
        drawn.savefig(figure)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
