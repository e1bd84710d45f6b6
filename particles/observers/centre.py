"""The velocity width in the centre of the chain, for limits of a vanishing time step."""

from __future__ import annotations

import numpy as np

from crazybilliards.model.arrays import middle_tenth
from crazybilliards.particles.observers.base import Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run

CENTRAL = "central_velocity_width"


class Centre(Averaged):
    """central_velocity_width: the root of the mean <v^2> of the middle tenth of the rods."""

    name = "centre"
    gives = (CENTRAL,)
    reads_chain = False

    def shape(self, run: Run) -> tuple[int, ...]:
        return ()

    def observe(self, snapshots: Snapshots) -> None:
        middle = snapshots.v[:, middle_tenth(snapshots.v.shape[1])]
        self.sums[snapshots.block] += np.square(middle).mean(axis=1).sum()

    def report(self, counts: Integers) -> Variables:
        return self.averages({CENTRAL: np.sqrt}, counts)
