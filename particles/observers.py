"""Observers: what is measured. Each takes buffers of snapshots, keeps sums, and reports.

A new measurement is a new class here and a line in :data:`OBSERVERS`; no kernel changes. Every
replica has observers of its own; they are joined in the order of the replicas, so that results
do not depend on how many threads ran them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Chain
from crazybilliards.model.grid import deposit, position_grid, thermal_reach
from crazybilliards.particles.blocks import block_means, jackknife

Array = NDArray[np.float64]
Variables = dict[str, tuple[tuple[str, ...], ArrayLike]]


class Snapshots(NamedTuple):
    """What observers are handed: some successive snapshots, all of one block."""

    block: int
    first: int  # number of the first one within the replica, from 0
    y: Array  # (snapshots, L), reduced coordinates
    v: Array  # (snapshots, L)
    collisions: NDArray[np.int64]  # since the last snapshots, by contact; empty if not counted


class Observer(ABC):
    """What the simulation asks of a measurement; made anew, with (chain, blocks), per replica."""

    x: Array | None = None  # the position grid, of a measurement that has one

    @abstractmethod
    def __init__(self, chain: Chain, blocks: int) -> None: ...

    @abstractmethod
    def observe(self, seen: Snapshots) -> None:
        """Take some snapshots."""

    @abstractmethod
    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas to one's own."""

    @abstractmethod
    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return the variables measured; ``counts``: the snapshots in every block."""


class Widths(Observer):
    """velocity_width W_v = sqrt(<v^2>), mean_displacement and displacement_width, per particle.

    Keeps the sums of d, d^2 and v^2: 24 L bytes per block.
    """

    def __init__(self, chain: Chain, blocks: int) -> None:
        self.anchors = chain.reduced_anchors
        self.sums = np.zeros((blocks, 3, chain.size))

    def observe(self, seen: Snapshots) -> None:
        """Add snapshots to the sums of their block."""
        d = seen.y - self.anchors
        sums = self.sums[seen.block]
        sums[0] += d.sum(axis=0)
        sums[1] += np.einsum("sp,sp->p", d, d)
        sums[2] += np.einsum("sp,sp->p", seen.v, seen.v)

    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas."""
        self.sums = np.concatenate([self.sums, *(other.sums for other in others)])

    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return the three quantities and their standard errors."""
        mean, blocks = block_means(self.sums, counts)
        quantities = {
            "mean_displacement": lambda average: average[0],
            # max: a rod that never moves has a variance of 0 up to rounding.
            "displacement_width": lambda average: np.sqrt(
                np.maximum(average[1] - average[0] ** 2, 0)
            ),
            "velocity_width": lambda average: np.sqrt(average[2]),
        }
        variables: Variables = {}
        for name, quantity in quantities.items():
            value, error = jackknife(quantity, mean, blocks)
            variables[name] = (("particle",), value)
            variables[f"{name}_error"] = (("particle",), error)
        return variables


class Density(Observer):
    """Density of the rods' centres on the position grid, in hat weights, block by block.

    The block means are part of the result, because the error of a smoothed density does not
    follow from the errors of the bins. 8 bytes per node and block.
    """

    def __init__(self, chain: Chain, blocks: int) -> None:
        if not np.isfinite(thermal_reach(chain)):
            raise ValueError(
                "observe: 'density' needs damping and stiffness above 0, to know "
                "how far the rods can go"
            )
        self.x = x = position_grid(chain)
        self.first, self.spacing = x[0], x[1] - x[0]
        self.offsets = chain.physical(np.zeros(chain.size))
        self.weights = np.zeros((blocks, x.size))
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
        mean, blocks = block_means(self.weights / self.spacing, counts)
        density, error = jackknife(lambda average: average, mean, blocks)
        return {
            "density": (("x",), density),
            "density_error": (("x",), error),
            "density_block": (("block", "x"), blocks),
            "outside": ((), np.float64(self.outside / counts.sum())),
        }


OBSERVERS: dict[str, type[Observer]] = {"widths": Widths, "density": Density}
