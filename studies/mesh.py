"""What do the meshes of the kinetic equations cost, and how accurate are they? Three tables.

    python -m studies.mesh

The first has the errors of ``phase_space`` on coarser meshes, as differences from the finest. The
second has those of ``correlated_phase_space``, for 100 rods at e = 0.75; the third its CPU seconds
for 1000 rods, with the mesh refined until the widths are accurate to the default tolerance. Takes
some minutes on one core.
"""

import time

import numpy as np

from crazybilliards.kinetic import correlated_phase_space, phase_space
from crazybilliards.model import Chain
from studies.common import Table, print_table

CASES = ((0.95, 1.0), (1.05, 4.0))
CELLS = (8, 12, 16, 22, 33, 44)
FINEST = 60
PAIRS = Chain(size=100, restitution=0.75)
CELLS_OF_PAIRS = (11, 16, 22, 33)
FINEST_OF_PAIRS = 44
LONG = 1000
RESTITUTIONS = (0.95, 0.9, 0.75, 0.5, 0.0)


def without_correlations() -> Table:
    width, place = "W_v, largest error, %", "displacement, largest error / s"
    yield "e", "gamma", "cells", width, place, "seconds"
    for restitution, damping in CASES:
        chain = Chain(restitution=restitution, damping=damping)
        finest = phase_space(chain, cells=FINEST)
        for cells in (*CELLS, None):
            begin = time.perf_counter()
            theory = phase_space(chain, cells=cells)
            seconds = time.perf_counter() - begin
            off = np.abs(theory.velocity_width / finest.velocity_width - 1).max()
            moved = np.abs(theory.mean_displacement - finest.mean_displacement).max()
            name = cells or f"default ({theory.attrs['cells']})"
            errors = f"{100 * float(off):.3f}", f"{float(moved) / chain.thermal_length:.1e}"
            yield f"{restitution:g}", f"{damping:g}", name, *errors, f"{seconds:.1f}"


def with_correlations() -> Table:
    yield "cells", "centre", "a tenth", "border", "largest, 3 to L - 2"
    finest = correlated_phase_space(PAIRS, cells=FINEST_OF_PAIRS).velocity_width.values
    places = PAIRS.size // 2, PAIRS.size // 10, 0
    for cells in CELLS_OF_PAIRS:
        width = correlated_phase_space(PAIRS, cells=cells).velocity_width.values
        off = width / finest - 1
        yield cells, *(f"{off[place]:+.1e}" for place in places), f"{abs(off[2:-2]).max():.1e}"


def cost() -> Table:
    yield "e", "cells", "CPU seconds, 1000 rods"
    for restitution in RESTITUTIONS:
        begin = time.process_time()
        theory = correlated_phase_space(Chain(size=LONG, restitution=restitution))
        seconds = time.process_time() - begin
        yield f"{restitution:g}", theory.attrs["cells"], f"{seconds:.0f}"


if __name__ == "__main__":
    for table in (without_correlations, with_correlations, cost):
        print_table(table())
