"""What the rods of a gas in a box do to its walls."""

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

    Elastic rods without springs, damping and noise keep their energy E. With the half room b, the
    virial G = sum_i m_i y_i v_i and the momentum P, the walls then receive in a time t exactly
    (2E t - Delta G)/2b +- Delta P/2, and the errors are those of the differences at the ends.
    """

    name = "walls"
    gives = ("wall_force", "wall_collision_rate")
    along = ("wall",)
    meets_walls = True
    ensemble = False
    knows = WALLS_AND_MASSES

    def shape(self, run: Run) -> tuple[int, ...]:
        return 3, 2

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.mass = run.chain.mass
        self.current = np.zeros((2, 2))

    def tally(self, tally: Tally) -> Tally:
        return tally._replace(struck=self.current)

    def observe(self, snapshots: Snapshots) -> None:
        chain, sums = self.run.chain, self.sums[snapshots.block]
        sums[:2] += self.current
        self.current[...] = 0  # in place: kernels write into the same array
        momenta = snapshots.v * chain.rod_masses
        virial = (momenta * snapshots.y).sum(axis=1) / chain.walls[1]
        for wall, sign in enumerate((1, -1)):
            sums[2, wall] += ((virial - sign * momenta.sum(axis=1)) ** 2).sum() / 4

    def report(self, counts: Integers) -> Variables:
        interval = self.run.every
        quantities = {
            "wall_force": lambda sums: self.mass / interval * sums[0],
            "wall_collision_rate": lambda sums: sums[1] / interval,
        }
        variables = self.averages(quantities, counts, "wall")
        if self._keeps_energy():
            ends = self.sums[:, 2].sum(axis=0) / counts.sum()
            error = np.sqrt(2 * ends * self.run.replicas) / (counts.sum() * interval)
            variables["wall_force_error"] = ("wall",), error
        e = self.run.chain.wall_restitution
        return checked_rate(self.run, "wall_collision_rate", e, variables)

    def _keeps_energy(self) -> bool:
        chain = self.run.chain
        free = chain.amplitude == chain.damping == chain.stiffness == 0
        elastic = chain.restitution == chain.wall_restitution == 1
        known = chain.unknown().keys() <= WALLS_AND_MASSES
        return free and elastic and known and self.run.method == "event-driven"

    def coordinates(self) -> dict[str, Array]:
        return {"wall": np.array([1.0, 2.0])}
