"""Collisions at every contact."""

from __future__ import annotations

import numpy as np

from crazybilliards.particles.observers.base import Averaged, Integers, Plan, Snapshots, Variables


class Collisions(Averaged):
    """collision_rate: collisions of each particle with its right neighbour, per time.

    The last particle has none. Rods that have merged into a cluster do not collide again until
    the next step: below e = 1 the rate depends on the time step, as it is infinite without one.
    """

    ensemble = False

    def __init__(self, plan: Plan) -> None:
        self.schedule = plan.schedule
        self.sums = np.zeros((plan.schedule.blocks, plan.chain.size))

    @staticmethod
    def memory(plan: Plan) -> float:
        """Return the bytes it keeps."""
        return 8.0 * plan.chain.size * plan.schedule.blocks

    def observe(self, seen: Snapshots) -> None:
        """Add the collisions since the last snapshots."""
        self.sums[seen.block, :-1] += seen.collisions

    def report(self, counts: Integers) -> Variables:
        """Return the rate and its standard error."""
        interval = self.schedule.stride * self.schedule.time_step
        rate = {"collision_rate": lambda average: average / interval}
        return self.averages(rate, counts, "particle")
