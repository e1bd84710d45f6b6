"""Accuracy and cost of the theory with pair correlations: two tables of the documentation.

    python benchmarks/accuracy/correlated_mesh.py

The first has relative differences of W_v from the result on the finest mesh, for 100 rods at
e = 0.75. The second has the CPU seconds for 1000 rods, whose mesh is refined until the widths are
accurate to the default tolerance. Takes four minutes on one core.
"""

import argparse
import time

import numpy as np

from crazybilliards.kinetic import correlated_phase_space
from crazybilliards.model import Chain

CHAIN = Chain(size=100, restitution=0.75)
CELLS = (11, 16, 22, 33)
FINEST = 44
LONG = 1000
RESTITUTIONS = (0.95, 0.9, 0.75, 0.5, 0.0)


def tabulate_accuracy() -> None:
    finest = correlated_phase_space(CHAIN, cells=FINEST).velocity_width.values
    places = CHAIN.size // 2, CHAIN.size // 10, 0
    print("| cells | centre | a tenth | border | largest, 3 to L - 2 |\n|---|---|---|---|---|")
    for cells in CELLS:
        width = correlated_phase_space(CHAIN, cells=cells).velocity_width.values
        off = width / finest - 1
        shown = [f"{off[place]:+.1e}" for place in places]
        print(f"| {cells} | {' | '.join(shown)} | {np.abs(off[2:-2]).max():.1e} |", flush=True)


def tabulate_cost() -> None:
    print("\n| e | cells | CPU seconds, 1000 rods |\n|---|---|---|")
    for restitution in RESTITUTIONS:
        begin = time.process_time()
        theory = correlated_phase_space(Chain(size=LONG, restitution=restitution))
        seconds = time.process_time() - begin
        print(f"| {restitution:g} | {theory.attrs['cells']} | {seconds:.0f} |", flush=True)


def main() -> None:
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    tabulate_accuracy()
    tabulate_cost()


if __name__ == "__main__":
    main()
