"""The density on the position grid."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.model.grid import deposit, position_grid, thermal_reach
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run


def _grid(run: Run) -> Array:
    chain = run.chain
    if not np.isfinite(thermal_reach(chain)):
        raise ValueError("observe: 'density' needs damping and stiffness above 0, to size its grid")
    # Flippers (e > 1) drive a chain apart by several times the free reach.
    thermal = thermal_reach(chain) * (5 if chain.restitution > 1 else 1)
    # A start with thermal or smaller displacements needs no more room than that.
    return position_grid(chain, thermal + max(0.0, run.swing - 0.75 * thermal))


class Density(Averaged):
    """Density of the rods' centres on the position grid, in hat weights, block by block.

    The block means are part of the result, because the error of a smoothed density does not
    follow from the errors of the bins. They take 8 bytes per node and block.
    """

    name = "density"
    gives = ("density", "density_block", "outside")
    along = ("x",)
    histograms = ("density",)

    def shape(self, run: Run) -> tuple[int, ...]:
        """Return the shape of the sums of one block: one number a node of the grid."""
        return (_grid(run).size,)

    def prepare(self, run: Run, copies: int) -> None:
        """Make the sums."""
        super().prepare(run, copies)
        self.x = _grid(run)
        self.first, self.spacing = self.x[0], self.x[1] - self.x[0]
        self.offsets = run.chain.physical(np.zeros(run.chain.size))
        self.outside = 0

    def observe(self, snapshots: Snapshots) -> None:
        """Put every rod of every snapshot on the grid."""
        points = (snapshots.y + self.offsets).ravel()
        self.outside += deposit(points, self.first, self.spacing, self.sums[snapshots.block])

    def join(self, others: Sequence[Self]) -> None:
        """Append the measurements of others."""
        super().join(others)
        self.outside += sum(other.outside for other in others)

    def report(self, counts: Integers) -> Variables:
        """Return density, density_error, density_block over x, and the rods outside x."""
        if self.outside:
            share = self.outside / counts.sum()
            warnings.warn(
                f"density: {share:.3g} rods per snapshot lay outside the grid and are missing",
                stacklevel=2,
            )
        spacing = self.spacing
        variables = self.averages({"density": lambda average: average / spacing}, counts, "x")
        if self.schedule.ensemble:
            # In an interrupted run a group has no density at times that it did not reach: NaN.
            known = np.where(counts > 0, counts, np.nan)[..., np.newaxis]
            means = self.sums[:, : counts.shape[-1]] / (known * spacing)
            variables["density_block"] = (("block", "time", "x"), means)
        else:
            complete = counts == counts.max()
            means = self.sums[complete] / (counts.max() * spacing)
            variables["density_block"] = (("block", "x"), means)
        variables["outside"] = ((), np.float64(self.outside / counts.sum()))
        return variables

    def coordinates(self) -> dict[str, Array]:
        """Return the position grid."""
        return {"x": self.x}
