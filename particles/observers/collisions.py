"""Collisions at every contact."""

from __future__ import annotations

from crazybilliards.particles.observers.base import Averaged, Integers, Snapshots, Variables


class Collisions(Averaged):
    """collision_rate: collisions of each particle with its right neighbour, per time.

    The last particle has no such rate. Rods that have merged into a cluster do not collide again
    until the next step. For e < 1 the rate depends on the time step. For e < 0.163 it is
    infinite for dt -> 0.
    """

    name = "collisions"
    gives = ("collision_rate",)
    single_collisions = True
    ensemble = False
    reads_chain = False

    def observe(self, snapshots: Snapshots) -> None:
        self.sums[snapshots.block, :-1] += snapshots.collisions

    def report(self, counts: Integers) -> Variables:
        interval = self.run.every
        rate = {"collision_rate": lambda average: average / interval}
        return self.averages(rate, counts, "particle")
