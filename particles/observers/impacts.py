"""What collisions exchange and take at every contact."""

from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES
from crazybilliards.model.checks import check_integer
from crazybilliards.particles.laws.avalanche import Tally
from crazybilliards.particles.laws.impacts import Speeds, make_impacts
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.observers.velocities import FINEST, LAST, MOST_BINS
from crazybilliards.particles.run import Run
from crazybilliards.particles.scales import typical_speed


class Impacts(Averaged):
    """Force, loss, relative temperatures and speeds at each contact, from every single collision.

    ``contact_force`` is the momentum that crosses a contact per time, and ``contact_loss`` the
    energy that collisions there take per time. With w the speed at which rods meet, and means over
    the collisions of a contact,

        contact_temperature = (pi/16) (<w^2>/<w>)^2,

    and ``rebound_temperature`` is the same of the speeds at which they separate, 0 where all rods
    that met merged. Gaussian relative velocities with the relative temperature Theta give w the
    density w exp(-w^2/4 Theta). contact_temperature is Theta then, and rebound_temperature e^2
    Theta. At e = 1 Theta is the temperature. Below it

        contact_loss = (2/sqrt(pi)) (1 - e) contact_force sqrt(contact_temperature),

    exactly as long as no rods merge, and ``steady_state`` has F sqrt(Theta) for the root.

    The means of w and w^2 alone depend on the time step, because rods that noise holds together
    collide ever more often, at ever smaller speeds. Their ratio has a limit. Clusters count as
    ``laws/impacts.py`` says. Below the restitution 0.163 the loss contains the energy of the
    stronger kicks that open closed contacts (``laws/closed_contacts.py``): at e = 0 and 20 rods
    11 % of the loss at the default step, 5 and 2 % at a fourth and a sixteenth of it.

    ``impact_speed_density`` is the probability density of w at each contact. At e = 1 it is
    w exp(-w^2/4 W^2)/2 W^2. Below it depends on the time step as the means do. The bins are those
    of :class:`Velocities` for v > 0, in units of the start's speed if there is no W. The few
    impacts above 1000 W are left out. Those of steps in which a chain diverges are included.
    A bin and contact take 8 bytes. Without any collisions densities and temperatures are NaN.

    Parameters
    ----------
    bins
        Number of bins of ``impact_speed``.
    """

    name = "impacts"
    gives = (
        *("contact_force", "contact_loss", "contact_temperature", "rebound_temperature"),
        "impact_speed_density",
    )
    along = ("impact_speed",)
    least_rods = 2
    single_collisions = True
    ensemble = False
    knows = WALLS_AND_MASSES

    def __init__(self, bins: int = 200) -> None:
        self.bins = check_integer("bins", bins, least=1, most=MOST_BINS)

    def shape(self, run: Run) -> tuple[int, ...]:
        return 4, run.chain.size - 1

    def memory(self, run: Run) -> float:
        return super().memory(run) + 8.0 * (4 + self.bins) * (run.chain.size - 1)

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.current = make_impacts(run.chain.size)
        scale = run.chain.free_velocity_width
        if not 0 < scale < np.inf:
            scale = max(typical_speed(run.chain, run.time_step, *one) for one in run.starts) or 1.0
        self.edges = FINEST * scale * np.sinh(np.linspace(0, LAST, self.bins + 1))
        self.numbers = np.zeros((run.chain.size - 1, self.bins), dtype=np.int64)

    def tally(self, tally: Tally) -> Tally:
        return tally._replace(impacts=self.current, speeds=Speeds(self.edges, self.numbers))

    def observe(self, snapshots: Snapshots) -> None:
        self.sums[snapshots.block] += self.current
        self.current[...] = 0  # in place: kernels write into the same array

    def join(self, others: Sequence[Self]) -> None:
        super().join(others)
        self.numbers = self.numbers + sum(other.numbers for other in others)

    def report(self, counts: Integers) -> Variables:
        per_time = self.run.chain.mass / self.run.every

        def rebound(sums: Array) -> Array:
            merged = (sums[2] == 0) & (sums[0] > 0)
            return np.where(merged, 0.0, _temperature(*sums[2:]))

        # The rows of ``laws/impacts.py``: momentum and energy before, momentum and energy after.
        quantities = {
            "contact_force": lambda sums: per_time * (sums[0] + sums[2]),
            "contact_loss": lambda sums: per_time * (sums[1] - sums[3]),
            "contact_temperature": lambda sums: _temperature(*sums[:2]),
            "rebound_temperature": rebound,
        }
        collisions = self.numbers.sum(axis=1, keepdims=True)
        density = self.numbers / np.where(collisions > 0, collisions, np.nan) / np.diff(self.edges)
        return {
            "impact_speed_density": (("contact", "impact_speed"), density),
            **self.averages(quantities, counts, "contact"),
        }

    def coordinates(self) -> dict[str, Array]:
        return {"impact_speed": (self.edges[1:] + self.edges[:-1]) / 2}


def _temperature(momentum: Array, energy: Array) -> Array:
    """Return (pi/16) (<w^2>/<w>)^2 = (pi/4) (energy/momentum)^2, NaN without any collision."""
    ratio = np.divide(energy, momentum, out=np.full_like(momentum, np.nan), where=momentum > 0)
    return np.asarray(np.pi / 4 * ratio**2)
