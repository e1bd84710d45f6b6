"""Where the kinetic equation holds: its relative errors against restitution and size.

    python benchmarks/validity.py FOLDER FIGURE.png

Prints the table of docs/kinetic_equation.md and draws its figure. Simulations are kept in FOLDER,
so that a second run only draws. Takes about an hour on one core.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import entitle, house_style, legend_above, panels
from crazybilliards.comparison.studies.restitutions import WidthDeviation, width_deviation
from crazybilliards.kinetic import phase_space
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate

RESTITUTIONS = (0.0, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0)
DURATIONS = {30: 40_000.0, 100: 20_000.0, 300: 2_000.0, 1000: 300.0}
LONGER = 4.0  # times these for L >= 300 and e >= 0.9, where a step is longer
DRIVEN = ((30, 20_000.0), (60, 20_000.0), (100, 50_000.0))  # e = 1.05, gamma = 4
_LINEAR = 2.0  # per cent; the axis is linear up to there, and logarithmic beyond


def compared(chain: Chain, duration: float, folder: Path) -> WidthDeviation:
    """Return the deviations for a chain, simulated now or before."""
    path = folder / f"L{chain.size}_e{chain.restitution:g}_gamma{chain.damping:g}_{duration:g}.nc"
    if path.exists():
        run = load(path)
    else:
        run = simulate(
            chain, duration=duration, seed=2, observe="widths", threads=1, progress=False
        )
        save(run, path)
    theory = phase_space(chain, tolerance=4e-3)
    return width_deviation(run, theory)


def row(chain: Chain, found: WidthDeviation) -> str:
    """Return a line of the table, in per cent."""
    name = f"{chain.restitution:g}" + (f", gamma = {chain.damping:g}" if chain.damping != 1 else "")
    values = " | ".join(
        f"{100 * value:+.1f} ± {100 * error:.1f}"
        for value, error in ((found.centre, found.error), (found.border, found.border_error))
    )
    return f"| {name} | {chain.size} | {values} | {100 * found.largest:.1f} |"


def main(folder: Path, figure: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    print("| e | L | centre, % | border, % | largest, 3 to L-2, % |\n|---|---|---|---|---|")
    results: dict[int, list[tuple[float, WidthDeviation]]] = {size: [] for size in DURATIONS}
    for size, duration in DURATIONS.items():
        for restitution in RESTITUTIONS:
            chain = Chain(size=size, restitution=restitution)
            longer = LONGER if size >= 300 and restitution >= 0.9 else 1.0
            found = compared(chain, longer * duration, folder)
            results[size].append((restitution, found))
            print(row(chain, found), flush=True)
    driven = []
    for size, duration in DRIVEN:
        chain = Chain(size=size, restitution=1.05, damping=4.0)
        found = compared(chain, duration, folder)
        driven.append((size, found))
        print(row(chain, found), flush=True)
    draw(results, driven, figure)


def draw(
    results: dict[int, list[tuple[float, WidthDeviation]]],
    driven: list[tuple[int, WidthDeviation]],
    figure: Path,
) -> None:
    with house_style():
        drawing, axes = panels(1, 2, height=2.9)
        for ax, place in zip(axes, ("centre", "border"), strict=True):
            _draw_place(ax, place, results, driven)
            entitle(ax, place)
        legend_above(drawing, axes[0])
        drawing.savefig(figure)


def _draw_place(
    ax: Axes,
    place: str,
    results: dict[int, list[tuple[float, WidthDeviation]]],
    driven: list[tuple[int, WidthDeviation]],
) -> None:
    error = "border_error" if place == "border" else "error"
    shown = [*RESTITUTIONS, 1.05]  # evenly spaced: most of what happens lies close to 1
    for number, (size, found) in enumerate(results.items()):
        ax.errorbar(
            [shown.index(e) + 0.04 * (number - 1.5) for e, _ in found],
            [100 * getattr(each, place) for _, each in found],
            [100 * getattr(each, error) for _, each in found],
            label=f"$L = {size}$",
            color=COLOURS[number],
            marker=SYMBOLS[number],
            markerfacecolor="none",
        )
    for number, (size, each) in enumerate(driven):
        ax.errorbar(
            len(shown) - 1 + 0.15 * (number - 1),
            100 * getattr(each, place),
            100 * getattr(each, error),
            color="black",
            marker="<^>"[number],
            markerfacecolor="none",
            linestyle="none",
            label=rf"$L = {size}$, $\gamma = 4$",
        )
    ax.axhspan(-_LINEAR, _LINEAR, color="0.93", zorder=0, label="linear scale")
    ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    ax.set_yscale("symlog", linthresh=_LINEAR)
    ax.set_yticks([-50, -20, -10, -5, -2, -1, 0, 1, 2, 5])
    ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    ax.set_xticks(range(len(shown)), [f"{e:g}" for e in shown])
    # The last restitution is of other chains: a gap in the axis.
    broken = (len(shown) - 1.5, 0)
    ax.annotate("//", broken, xycoords=("data", "axes fraction"), ha="center", va="center")
    ax.set(xlabel="restitution $e$ (not to scale)", ylabel="$W_v$: theory less simulation [%]")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
