"""Where the kinetic equation holds: its relative errors against restitution and size.

    python benchmarks/validity.py FOLDER

Prints docs/tables/kinetic_equation.csv. Simulations are kept in FOLDER. Takes about an hour on one
core. docs/figures/validity.py draws the table, with those of benchmarks/correlations.py.
"""

import sys
from pathlib import Path

import xarray as xr
from kept import kept_or_made

from crazybilliards.comparison.widths import WidthDeviation, width_deviation
from crazybilliards.kinetic import phase_space
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

RESTITUTIONS = (0.0, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0)
DURATIONS = {30: 40_000.0, 100: 20_000.0, 300: 2_000.0, 1000: 300.0}
LONGER = 4.0  # times these for L >= 300 and e >= 0.9, where a step is longer
DRIVEN = ((30, 20_000.0), (60, 20_000.0), (100, 50_000.0))  # e = 1.05, gamma = 4


def compared(chain: Chain, duration: float, folder: Path) -> WidthDeviation:
    """Return the deviations for a chain, simulated now or before."""
    path = folder / f"L{chain.size}_e{chain.restitution:g}_gamma{chain.damping:g}_{duration:g}.nc"

    def make() -> xr.Dataset:
        return simulate(
            chain, duration=duration, seed=2, observe="widths", threads=1, progress=False
        )

    run = kept_or_made(path, make)
    theory = phase_space(chain, tolerance=4e-3)
    return width_deviation(run, theory)


def row(chain: Chain, found: WidthDeviation) -> str:
    """Return a line of the table, in per cent."""
    return (
        f"{chain.restitution:g},{chain.size},{chain.damping:g},{100 * found.centre:+.1f},"
        f"{100 * found.border:+.1f},{100 * found.largest:.1f},{100 * found.error:.1f}"
    )


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    print('e,L,gamma,"centre, %","border, %","largest, %","error of a rod, %"')
    for size, duration in DURATIONS.items():
        for restitution in RESTITUTIONS:
            chain = Chain(size=size, restitution=restitution)
            longer = LONGER if size >= 300 and restitution >= 0.9 else 1.0
            print(row(chain, compared(chain, longer * duration, folder)), flush=True)
    for size, duration in DRIVEN:
        chain = Chain(size=size, restitution=1.05, damping=4.0)
        print(row(chain, compared(chain, duration, folder)), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
