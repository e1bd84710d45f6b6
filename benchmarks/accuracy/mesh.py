"""Accuracy against cost of the kinetic equation's mesh: a table for the documentation.

    python benchmarks/accuracy/mesh.py

Errors are differences from the finest mesh. Takes a few minutes on one core.
"""

import time

import numpy as np

from crazybilliards.kinetic import phase_space
from crazybilliards.model import Chain

CASES = ((0.95, 1.0), (1.05, 4.0))
CELLS = (8, 12, 16, 22, 33, 44)
FINEST = 60


def main() -> None:
    print('e,gamma,cells,"W_v, largest error, %","displacement, largest error / s",seconds')
    for restitution, damping in CASES:
        chain = Chain(restitution=restitution, damping=damping)
        finest = phase_space(chain, cells=FINEST)
        for cells in (*CELLS, None):
            begin = time.perf_counter()
            theory = phase_space(chain, cells=cells)
            seconds = time.perf_counter() - begin
            width = 100 * np.abs(theory.velocity_width / finest.velocity_width - 1).max()
            place = np.abs(theory.mean_displacement - finest.mean_displacement).max()
            name = cells or f"default ({theory.attrs['cells']})"
            print(
                f"{restitution:g},{damping:g},{name},{float(width):.3f},"
                f"{float(place) / chain.thermal_length:.1e},{seconds:.1f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
