"""Where the kinetic equation holds: its relative errors against restitution and size.

    python benchmarks/validity.py FOLDER FIGURE.png

Prints the table of docs/kinetic_equation.md and draws its figure. Simulations are kept in FOLDER,
so that a second run only draws. Takes about an hour on one core.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from crazybilliards.comparison.studies.restitutions import WidthDeviation, width_deviation
from crazybilliards.kinetic import phase_space
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate

RESTITUTIONS = (0.0, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0)
DURATIONS = {30: 40_000.0, 100: 20_000.0, 300: 2_000.0, 1000: 300.0}
LONGER = 4.0  # times these for L >= 300 and e >= 0.9, where a step is longer
DRIVEN = ((30, 20_000.0), (60, 20_000.0), (100, 50_000.0))  # e = 1.05, gamma = 4
LOOKS = {30: ("#0072B2", "o"), 100: ("#E69F00", "s"), 300: ("#009E73", "D"), 1000: ("#CC79A7", "^")}


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
    drawing, axes = plt.subplots(1, 2, figsize=(9.2, 4.2), sharex=True, layout="constrained")
    shown = [*RESTITUTIONS, 1.05]  # evenly spaced: most of what happens lies close to 1
    for ax, place, error in zip(axes, ("centre", "border"), ("error", "border_error"), strict=True):
        for number, (size, found) in enumerate(results.items()):
            colour, symbol = LOOKS[size]
            ax.errorbar(
                [shown.index(e) + 0.04 * (number - 1.5) for e, _ in found],
                [100 * getattr(each, place) for _, each in found],
                [100 * getattr(each, error) for _, each in found],
                label=f"L = {size}",
                color=colour,
                marker=symbol,
                markerfacecolor="none",
                linewidth=1.2,
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
                label=rf"L = {size}, $\gamma = 4$",
            )
        ax.axhline(0, color="0.6", linewidth=0.8, zorder=0)
        ax.set_yscale("symlog", linthresh=2)
        ax.set_yticks([-50, -20, -10, -5, -2, -1, 0, 1, 2, 5])
        ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        ax.set_xticks(range(len(shown)), [f"{e:g}" for e in shown])
        ax.set(xlabel="restitution e", ylabel=f"error of $W_v$, {place} [%]")
    drawing.legend(
        *axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False
    )
    drawing.savefig(figure, dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
