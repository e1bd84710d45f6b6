"""What the rods of a gas in a box do to its walls."""

from __future__ import annotations

import numpy as np

from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.particles.laws.avalanche import Tally
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.observers.collisions import checked_rate
from crazybilliards.particles.run import Run


class Walls(Averaged):
    """wall_force and wall_collision_rate: the momentum that each wall receives, and collisions.

    Both are per time. In one dimension the force is the pressure of the gas. Without springs, and
    if rods and walls are elastic, it is exactly L T/(X - 2RL), for any masses. A hit on rods that
    rest at a wall pushes the wall, too, but does not count as a collision with it.
    """

    name = "walls"
    gives = ("wall_force", "wall_collision_rate")
    along = ("wall",)
    meets_walls = True
    ensemble = False
    knows = WALLS_AND_MASSES

    def shape(self, run: Run) -> tuple[int, ...]:
        return 2, 2

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.mass = run.chain.mass
        self.current = np.zeros((2, 2))

    def tally(self, tally: Tally) -> Tally:
        return tally._replace(struck=self.current)

    def observe(self, snapshots: Snapshots) -> None:
        self.sums[snapshots.block] += self.current
        self.current[...] = 0  # in place: kernels write into the same array

    def report(self, counts: Integers) -> Variables:
        interval = self.run.every
        quantities = {
            "wall_force": lambda sums: self.mass / interval * sums[0],
            "wall_collision_rate": lambda sums: sums[1] / interval,
        }
        variables = self.averages(quantities, counts, "wall")
        e = self.run.chain.wall_restitution
        return checked_rate(self.run, "wall_collision_rate", e, variables)

    def coordinates(self) -> dict[str, Array]:
        return {"wall": np.array([1.0, 2.0])}
