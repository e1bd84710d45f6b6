"""Avalanche sizes by origin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.observers.base import (
    Array,
    Integers,
    Observer,
    Snapshots,
    Variables,
)
from crazybilliards.particles.run import Run


class Avalanches(Observer):
    """avalanche_count: rightward waves started by each particle that triggered N_c collisions.

    Counted by the collision kernel itself (see ``particles/laws/avalanche.py``) while measuring. By
    symmetry leftward waves are those of the mirrored particles. In a dissipative chain the counts
    depend on the time step: rods in contact are kicked anew in every step. 16 L^2 bytes.
    """

    name = "avalanches"
    gives = ("avalanche_count",)
    along = ("avalanche_size",)
    single_collisions = True
    ensemble = False

    def prepare(self, run: Run, copies: int) -> None:
        """Make the sums."""
        tally = make_tally(run.chain.size, contacts=False, waves=True)
        _, self.heads, self.following, self.origins, self.unused, self.sizes = tally

    def tally(self, tally: Tally) -> Tally:
        """Return the tally with the waves of this observer."""
        return tally._replace(
            heads=self.heads,
            following=self.following,
            origins=self.origins,
            unused=self.unused,
            sizes=self.sizes,
        )

    def memory(self, run: Run) -> float:
        """Return the bytes it keeps."""
        return 16.0 * run.chain.size**2

    def observe(self, snapshots: Snapshots) -> None:
        """Nothing: the kernel has counted already."""

    def join(self, others: Sequence[Self]) -> None:
        """Add the counts of other replicas."""
        self.sizes = self.sizes + sum(other.sizes for other in others)

    def report(self, counts: Integers) -> Variables:
        """Return avalanche_count."""
        return {"avalanche_count": (("particle", "avalanche_size"), self.sizes)}

    def coordinates(self) -> dict[str, Array]:
        """Return the sizes N_c."""
        return {"avalanche_size": np.arange(1.0, len(self.sizes) + 1)}
