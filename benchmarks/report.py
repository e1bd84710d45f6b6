"""Table and figure of the documentation from the measurements of ``make benchmark``.

python benchmarks/report.py results/benchmark.json docs/figures/cost.png
"""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
from particle_steps import NOISE, SIZES

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import house_style, legend_above, panels

# Measured elsewhere, on the same kind of machine, for L = 1000, dt = 1e-3, e = 0 [ns].
PEERS = {"Siconos (Lemke)": 80_000, "pymunk": 780, "MuJoCo": 470}


def main(source: Path, figure: Path) -> None:
    costs: dict[str, dict[int, float]] = defaultdict(dict)
    for measured in json.loads(source.read_text())["benchmarks"]:
        info = measured["extra_info"]
        if "particle_steps" in info:
            cost = measured["stats"]["median"] / info["particle_steps"] * 1e9
            costs[info["work"]][info["size"]] = cost
            if "default step" in info["work"]:
                rate = info["collisions"] / measured["stats"]["median"]
                print(f"{info['work']}, L = {info['size']}: {rate:.2g} collisions per second")
    print("\n| ns per particle and step | " + " | ".join(f"L = {size}" for size in SIZES) + " |")
    print("|---" * (len(SIZES) + 1) + "|")
    for work, by_size in costs.items():
        cells = [
            f"{by_size[size]:.1f} ({by_size[size] / costs[NOISE][size]:.1f}x)"
            if size in by_size
            else "-"
            for size in SIZES
        ]
        print(f"| {work} | " + " | ".join(cells) + " |")
    draw(costs, figure)


def with_formula(work: str) -> str:
    """Return the name of some work with the restitution as a formula."""
    return re.sub(r"\be ?= ?([\d.]+)", r"$e = \1$", work)


def draw(costs: dict[str, dict[int, float]], figure: Path) -> None:
    with house_style():
        drawn, [ax] = panels(1, 1, height=4.2, wanted=1)
        for number, (work, by_size) in enumerate(costs.items()):
            look: dict[str, Any] = {"color": "0.5", "linestyle": "--"}
            if work != NOISE:
                look = {"color": COLOURS[number - 1], "marker": SYMBOLS[number - 1]}
                look |= {"markerfacecolor": "none"}
            ax.plot(list(by_size), list(by_size.values()), label=with_formula(work), **look)
        for name, cost in PEERS.items():
            ax.plot(1000, cost, "*", color="black", markersize=7, markerfacecolor="none")
            ax.annotate(name, (1000, cost), xytext=(6, -3), textcoords="offset points")
        ax.plot(
            [], [], "*", color="black", markerfacecolor="none", label="others, measured elsewhere"
        )
        ax.set(xscale="log", yscale="log", xlabel="rods $L$", ylabel="cost per rod and step [ns]")
        ax.set_ylim(2, 2e5)
        legend_above(drawn, ax)
        drawn.savefig(figure)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
