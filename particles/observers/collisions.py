"""Collisions at every contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.blocks import block_means, jackknife
from crazybilliards.particles.observers.base import Observer, Snapshots, Variables
from crazybilliards.particles.schedule import Schedule


class Collisions(Observer):
    """collision_rate: collisions of each particle with its right neighbour, per time.

    The last particle has none. Rods that have merged into a cluster do not collide again until
    the next step: below e = 1 the rate depends on the time step, as it is infinite without one.
    """

    accumulated = ("sums",)

    def __init__(self, chain: Chain, schedule: Schedule) -> None:
        self.interval = schedule.stride * schedule.time_step
        self.sums = np.zeros((schedule.blocks, chain.size))

    def observe(self, seen: Snapshots) -> None:
        """Add the collisions since the last snapshots."""
        self.sums[seen.block, :-1] += seen.collisions

    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas."""
        self.sums = np.concatenate([self.sums, *(other.sums for other in others)])

    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return the rate and its standard error."""
        mean, blocks = block_means(self.sums / self.interval, counts)
        rate, error = jackknife(lambda average: average, mean, blocks)
        return {
            "collision_rate": (("particle",), rate),
            "collision_rate_error": (("particle",), error),
        }
