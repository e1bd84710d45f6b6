r"""How far does a rod move in a uniform elastic lattice of wells? The table of what a gap changes.

    python -m studies.elastic_lattice

Prints ``VARIANCES`` of kinetic/gas/descriptions.py. The rods of an infinite chain at e = 1 have
wells at the spacing x, in units of sqrt(T/k). In the reduced coordinate they are points that keep
their order. Their displacements u_i have the Gibbs measure

    prod_i exp(-u_i^2/2) theta(u_{i+1} + x - u_i).

The operator that leads from one rod to the next has the kernel

    exp(-(u^2 + u'^2)/4) theta(u' + x - u).

A rod has the density r(u) l(u), r and l being the right and the left eigenvector of its largest
eigenvalue. By mirror symmetry l(u) = r(-u). The variance is 1 for a rod that is alone.

On nodes at whole fractions of x the step theta is exact with the value 1/2 at 0. The error is then
proportional to the square of the distance of the nodes, and the extrapolation removes it.
"""

import math

import numpy as np

from crazybilliards.kinetic.gas.descriptions import VARIANCES
from studies.common import Table, print_table

FARTHEST = 6.0  # displacement
FEWEST, LONGEST = 8, 0.1  # nodes in a spacing, and the largest distance of two
SAME, MOST_TURNS = 1e-12, 1000  # of the eigenvector


def variance(spacing: float) -> float:
    """Return the variance of a rod, in units of T/k, at a spacing in units of sqrt(T/k)."""
    nodes = max(FEWEST, math.ceil(spacing / LONGEST))
    coarse, fine = (on_nodes(spacing, number) for number in (nodes, 2 * nodes))
    return (4 * fine - coarse) / 3


def on_nodes(spacing: float, number: int) -> float:
    """Return the variance with a number of nodes in a spacing."""
    distance = spacing / number
    index = np.arange(-math.ceil(FARTHEST / distance), math.ceil(FARTHEST / distance) + 1)
    step = np.heaviside(index[None, :] + number - index[:, None], 0.5)
    u = distance * index
    weight = np.exp(-(u**2) / 4)
    transfer = weight[:, None] * step * weight
    right = weight
    for _ in range(MOST_TURNS):
        before, right = right, transfer @ right
        right /= right.max()
        if np.abs(right - before).max() < SAME:
            density = right * right[::-1]  # its mean is 0
            return float(density @ u**2 / density.sum())
    raise RuntimeError(f"no eigenvector after {MOST_TURNS} turns at the spacing {spacing:g}")


def table() -> Table:
    yield "x", "variance of a rod", "in the package"
    for spacing, known in VARIANCES.items():
        if spacing > 0:  # there all rods are at one place
            yield f"{spacing:g}", f"{variance(spacing):.4f}", f"{known:.4f}"


if __name__ == "__main__":
    print_table(table())
