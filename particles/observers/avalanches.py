"""Avalanche sizes by origin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.observers.base import (
    Array,
    Integers,
    Observer,
    Plan,
    Snapshots,
    Variables,
)


class Avalanches(Observer):
    """avalanche_count: rightward waves started by each particle that triggered N_c collisions.

    Counted by the collision kernel itself (see ``particles/laws/avalanche.py``) while measuring. By
    symmetry leftward waves are those of the mirrored particles. In a dissipative chain the counts
    depend on the time step: rods in contact are kicked anew in every step. 16 L^2 bytes.
    """

    accumulated = ("heads", "following", "origins", "unused", "sizes")
    ensemble = False

    def __init__(self, plan: Plan) -> None:
        tally = make_tally(plan.chain.size, contacts=False, waves=True)
        _, self.heads, self.following, self.origins, self.unused, self.sizes = tally

    @staticmethod
    def memory(plan: Plan) -> float:
        """Return the bytes it keeps."""
        return 16.0 * plan.chain.size**2

    def observe(self, seen: Snapshots) -> None:
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
