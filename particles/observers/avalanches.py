"""Avalanche sizes by origin, in two counts."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

import numpy as np

from crazybilliards.particles.laws.avalanche import Tally, Waves, make_waves
from crazybilliards.particles.observers.base import Array, Integers, Observer, Snapshots, Variables
from crazybilliards.particles.run import Run


class _CountedWaves(Observer):
    """Base of both counts: the kernel counts, and this class keeps and reports its counts."""

    single_collisions = True
    ensemble = False
    smallest: ClassVar[int]  # least N_c
    record: ClassVar[str]  # name of the waves in the tally

    def prepare(self, run: Run, copies: int) -> None:
        waves = make_waves(run.chain.size)
        self.heads, self.following, self.origins, self.unused, self.sizes = waves

    def tally(self, tally: Tally) -> Tally:
        waves: Any = Waves(self.heads, self.following, self.origins, self.unused, self.sizes)
        return tally._replace(**{self.record: waves})

    def memory(self, run: Run) -> float:
        return 16.0 * run.chain.size**2

    def observe(self, snapshots: Snapshots) -> None:
        """Do nothing, because the kernel has counted already."""

    def join(self, others: Sequence[Self]) -> None:
        self.sizes = self.sizes + sum(other.sizes for other in others)

    def report(self, counts: Integers) -> Variables:
        return {self.gives[0]: (("particle", self.along[0]), self.sizes)}

    def coordinates(self) -> dict[str, Array]:
        return {self.along[0]: np.arange(len(self.sizes), dtype=np.float64) + self.smallest}


class Avalanches(_CountedWaves):
    """avalanche_count: rightward waves started by each particle that triggered N_c collisions.

    The first hit counts and must have a momentum that points right. Rods that stick together pass a
    push on. This count is our extension; the paper's is :class:`TriggeredCollisions`. Leftward
    waves are those of the mirrored particles. In a dissipative chain the counts depend on the time
    step. In a chain that diverges they include the diverging steps. They take 16 L^2 bytes.
    """

    name = "avalanches"
    gives = ("avalanche_count",)
    along = ("avalanche_size",)
    smallest = 1
    record = "pushes"


class TriggeredCollisions(_CountedWaves):
    """triggered_count: hits of each particle on its right neighbour that triggered N_c collisions.

    The paper's count, word for word (section ``seq:e_0``). Every hit of i on i + 1 starts a wave,
    and N_c = 0, 1, 2, ... is the number of collisions after it. Each of them is with the right
    neighbour of the front, and the momentum of the two rods points right. Rods that stick together
    pass nothing on. See :class:`Avalanches`.
    """

    name = "triggered-collisions"
    gives = ("triggered_count",)
    along = ("triggered_collisions",)
    smallest = 0
    record = "triggered"
