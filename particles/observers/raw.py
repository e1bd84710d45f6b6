"""Raw snapshots, for measurements that no other observer makes."""

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.particles.observers.base import Array, Integers, Observer, Snapshots, Variables
from crazybilliards.particles.run import Run


class Raw(Observer):
    """position and velocity of every chosen particle at every snapshot of every replica.

    It takes 16 bytes per particle, snapshot and replica, so ask for few snapshots with ``every``.
    Snapshots that an interrupted run did not reach are NaN. A single time of all particles can be
    the start of another run, ``run.isel(time=-1)``, which has other noise with the same ``seed``,
    too. The energy beside it is that of every snapshot.
    """

    name = "snapshots"
    gives = ("position", "velocity")
    along = ("time",)
    shares_time = True
    reads_chain = False

    def prepare(self, run: Run, copies: int) -> None:
        self.run = run
        self.offsets = run.chain.physical(np.zeros(run.chain.size))[run.chosen]
        self.y, self.v = np.full((2, copies, run.snapshots, run.chosen.size), np.nan)

    def memory(self, run: Run) -> float:
        return 16.0 * run.chosen.size * run.snapshots * -(-run.replicas // run.groups)

    def observe(self, snapshots: Snapshots) -> None:
        place = slice(snapshots.first, snapshots.first + len(snapshots.y))
        self.y[snapshots.copy, place] = snapshots.y[:, self.run.chosen]
        self.v[snapshots.copy, place] = snapshots.v[:, self.run.chosen]

    def join(self, others: Sequence[Self]) -> None:
        self.y = np.concatenate([self.y, *(other.y for other in others)])
        self.v = np.concatenate([self.v, *(other.v for other in others)])

    def report(self, counts: Integers) -> Variables:
        dimensions = ("replica", "time", "particle")
        reached = slice(counts.shape[1]) if self.run.ensemble else self._reached()
        return {
            "position": (dimensions, self.y[:, reached] + self.offsets),
            "velocity": (dimensions, self.v[:, reached]),
        }

    def coordinates(self) -> dict[str, Array]:
        return {"time": self.run.times[self._reached()]}

    def _reached(self) -> NDArray[np.bool_]:
        return np.asarray(np.isfinite(self.v).any(axis=(0, 2)))
