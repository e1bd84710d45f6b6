"""Collisions at every contact, and what they do to walls."""

import math

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES
from crazybilliards.model.warn import warn_user
from crazybilliards.particles.laws.avalanche import Tally
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run
from crazybilliards.particles.scales import centre_width

_MANY = 0.05  # share of slow collisions of which a warning tells


class Collisions(Averaged):
    """collision_rate: collisions of each particle with its right neighbour, per time.

    The last particle has no such rate. Rods that have merged into a cluster do not collide again
    until the next step, so for e < 1 slow collisions are missing; a warning says how many if they
    are more than a few per cent. For e < 0.163 the rate is infinite.
    """

    name = "collisions"
    gives = ("collision_rate",)
    single_collisions = True
    ensemble = False
    reads_chain = False

    def observe(self, snapshots: Snapshots) -> None:
        self.sums[snapshots.block, :-1] += snapshots.collisions

    def report(self, counts: Integers) -> Variables:
        rate = {"collision_rate": lambda average: average / self.run.every}
        variables = self.averages(rate, counts, "particle")
        return checked_rate(self.run, "collision_rate", self.run.chain.restitution, variables)


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
        chain, interval = self.run.chain, self.run.every
        quantities = {
            "wall_force": lambda sums: chain.mass / interval * sums[0],
            "wall_collision_rate": lambda sums: sums[1] / interval,
        }
        variables = self.averages(quantities, counts, "wall")
        if self._keeps_energy():
            ends = self.sums[:, 2].sum(axis=0) / counts.sum()
            error = np.sqrt(2 * ends * self.run.replicas) / (counts.sum() * interval)
            variables["wall_force_error"] = ("wall",), error
        return checked_rate(self.run, "wall_collision_rate", chain.wall_restitution, variables)

    def _keeps_energy(self) -> bool:
        chain = self.run.chain
        free = chain.amplitude == chain.damping == chain.stiffness == 0
        elastic = chain.restitution == chain.wall_restitution == 1
        known = chain.unknown().keys() <= WALLS_AND_MASSES
        return free and elastic and known and self.run.method == "event-driven"

    def coordinates(self) -> dict[str, Array]:
        return {"wall": np.array([1.0, 2.0])}


def checked_rate(run: Run, name: str, e: float, variables: Variables) -> Variables:
    """Make a rate at restitution e infinite if it is; warn if slow collisions are many.

    Two noisy rods that meet at a speed v meet again at u v with the density
    (3/2 pi) u^(3/2)/(1 + u^3) of u/e (H. P. McKean, J. Math. Kyoto Univ. 2, 227, 1963). Slow
    collisions then have speeds of the density v^(-1 - s) with e^s = 2 sin(pi (2 s + 5)/6), and
    -2 < s < 0. Those below the threshold of merging, a part r of a typical speed, are the share
    r^(-s) of all.
    """
    chain = run.chain
    if e >= 1 or chain.amplitude == 0:
        return variables
    if e < CRITICAL_RESTITUTION:
        warn_user(
            f"{name} is infinite: with noise, rods that meet collide again without end at a "
            f"restitution below {CRITICAL_RESTITUTION:.3f}, as e={e:g} here",
            RuntimeWarning,
        )
        (dimensions, rates), (_, errors) = variables[name], variables[f"{name}_error"]
        none = np.equal(rates, 0)
        variables[name] = dimensions, np.where(none, rates, np.inf)
        variables[f"{name}_error"] = dimensions, np.where(none, errors, np.nan)
    elif chain.damping > 0:
        width = centre_width(chain) * chain.free_velocity_width
        threshold = run.merging * chain.amplitude / chain.mass * math.sqrt(run.time_step) / width
        missing = min(threshold, 1.0) ** _decay_of_speeds(e)
        if missing > _MANY:
            warn_user(
                f"{name} is too small, by about {missing:.0%} at this time step: slow collisions "
                "are not counted, of which there are many at a small restitution",
                RuntimeWarning,
            )
    return variables


def _decay_of_speeds(e: float) -> float:
    """Return -s of :func:`checked_rate`."""
    from scipy.optimize import brentq  # takes .1 s, and few runs count collisions

    def balance(s: float) -> float:
        return s * math.log(e) - math.log(2 * math.sin(math.pi * (2 * s + 5) / 6))

    beside_the_other_root = -math.log(e / CRITICAL_RESTITUTION) / 4.4
    return -float(brentq(balance, -2.0, beside_the_other_root))
