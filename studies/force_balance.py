"""How far the force balance closed by labels is from the exact equilibrium.

    python -m studies.force_balance

Prints kinetic/measured/force_balance.csv: the largest error of the smoothed density, relative to
close packing, and of the mean displacement, in thermal lengths s.
"""

import itertools

import numpy as np

from crazybilliards import Chain, equilibrium, force_balance, smooth
from studies.common import Table, print_table

GAPS = (0.0, 0.1, 0.2, 0.3, 0.6, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
SIZES = (2, 3, 5, 10, 30, 100, 300, 1000)
LENGTHS = (0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.1, 3.0, 5.0, 7.0, 21.0)  # s/R


def errors(chain: Chain) -> tuple[float, float]:
    """Return those of the density and of the mean displacement."""
    exact, found = equilibrium(chain), force_balance(chain)
    theirs, ours = smooth(found).density, smooth(exact).density
    off = np.abs(theirs.interp(x=ours.x, kwargs={"fill_value": 0.0}) - ours)
    moved = np.abs(found.mean_displacement - exact.mean_displacement)
    return float(off.max()) / chain.close_packed_density, float(moved.max()) / chain.thermal_length


def table() -> Table:
    yield "theory", "quantity", "g/s", "L", "s/R", "error", "standard error"
    s = Chain().thermal_length
    for gap, size in itertools.product(GAPS, SIZES):
        chain = Chain(size=size, gap=gap * s)
        found = [errors(chain.replace(radius=s / length)) for length in LENGTHS]
        yield "force_balance", "mean_displacement", gap, size, "", f"{found[0][1]:.4f}", 0
        for length, (density, _) in zip(LENGTHS, found, strict=True):
            yield "force_balance", "density", gap, size, length, f"{density:.4f}", 0


if __name__ == "__main__":
    print_table(table())
