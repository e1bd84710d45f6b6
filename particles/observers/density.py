"""The density on the position grid."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.grid import deposit, position_grid, thermal_reach
from crazybilliards.particles.blocks import block_means, jackknife
from crazybilliards.particles.observers.base import Array, Observer, Snapshots, Variables
from crazybilliards.particles.schedule import Schedule


class Density(Observer):
    """Density of the rods' centres on the position grid, in hat weights, block by block.

    The block means are part of the result, because the error of a smoothed density does not
    follow from the errors of the bins. 8 bytes per node and block.
    """

    accumulated = ("weights", "outside")

    def __init__(self, chain: Chain, schedule: Schedule) -> None:
        if not np.isfinite(thermal_reach(chain)):
            raise ValueError(
                "observe: 'density' needs damping and stiffness above 0, to know "
                "how far the rods can go"
            )
        # Flippers (e > 1) drive a chain apart by several times the free reach.
        reach = thermal_reach(chain) * (5 if chain.restitution > 1 else 1)
        self.x = position_grid(chain, reach)
        self.first, self.spacing = self.x[0], self.x[1] - self.x[0]
        self.offsets = chain.physical(np.zeros(chain.size))
        self.weights = np.zeros((schedule.blocks, self.x.size))
        self.outside = 0

    def observe(self, seen: Snapshots) -> None:
        """Put every rod of every snapshot on the grid."""
        points = (seen.y + self.offsets).ravel()
        self.outside += deposit(points, self.first, self.spacing, self.weights[seen.block])

    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas."""
        self.weights = np.concatenate([self.weights, *(other.weights for other in others)])
        self.outside += sum(other.outside for other in others)

    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return density, density_error, density_block over x, and what lay outside x."""
        if self.outside:
            share = self.outside / counts.sum()
            warnings.warn(
                f"density: {share:.3g} rods per snapshot lay outside the grid and are missing",
                stacklevel=2,
            )
        mean, blocks = block_means(self.weights / self.spacing, counts)
        density, error = jackknife(lambda average: average, mean, blocks)
        return {
            "density": (("x",), density),
            "density_error": (("x",), error),
            "density_block": (("block", "x"), blocks),
            "outside": ((), np.float64(self.outside / counts.sum())),
        }

    def coordinates(self) -> dict[str, Array]:
        """Return the position grid."""
        return {"x": self.x}
