"""Table and figure of the documentation from the measurements of ``make benchmark``.

python benchmarks/report.py results/benchmark.json docs/figures/cost.png
"""

import json
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("agg")
from matplotlib import pyplot as plt
from particle_steps import NOISE, SIZES

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


def draw(costs: dict[str, dict[int, float]], figure: Path) -> None:
    fig, ax = plt.subplots(figsize=(5.5, 4.8), layout="constrained")
    colours = plt.get_cmap("cividis")
    for number, (work, by_size) in enumerate(costs.items()):
        style = (
            {"color": "0.6", "linestyle": "--"}
            if work == NOISE
            else {"marker": "osv^pD"[number - 1]}
        )
        style.setdefault("color", colours((number - 1) / max(len(costs) - 2, 1) * 0.9))
        ax.plot(list(by_size), list(by_size.values()), label=work, **style)
    for name, cost in PEERS.items():
        ax.plot(1000, cost, "*", color="tab:red", markersize=8)
        ax.annotate(name, (1000, cost), xytext=(7, -3), textcoords="offset points", fontsize=8)
    ax.set(xscale="log", yscale="log", xlabel="rods L", ylabel="cost per rod and step [ns]")
    ax.plot([], [], "*", color="tab:red", label="other programs, measured elsewhere")
    ax.set_ylim(2, 2e5)
    fig.legend(fontsize=8, ncols=2, loc="outside lower center")
    fig.savefig(figure, dpi=150)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
