"""Kinetic energy in time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.observers.base import Array, Observer, Snapshots, Variables
from crazybilliards.particles.schedule import Schedule

_MOST_TIMES = 1000


class Energy(Observer):
    """kinetic_energy: sum over the rods of m v^2/2 against time, averaged over the replicas.

    Successive snapshots are averaged so that at most 1000 times are kept. With two or more
    replicas kinetic_energy_error is the standard error of their mean. Times that not every
    replica reached are left out.
    """

    accumulated = ("sums", "counts")

    def __init__(self, chain: Chain, schedule: Schedule) -> None:
        snapshots = schedule.blocks * schedule.snapshots_per_block
        self.together = -(-snapshots // _MOST_TIMES)
        self.mass = chain.mass
        self.begin = schedule.warmup
        self.interval = schedule.stride * schedule.time_step
        times = -(-snapshots // self.together)
        self.sums, self.counts = np.zeros((2, 1, times))

    def observe(self, seen: Snapshots) -> None:
        """Add the energies of snapshots to their times."""
        energies = self.mass / 2 * np.einsum("sp,sp->s", seen.v, seen.v)
        place = (seen.first + np.arange(energies.size)) // self.together
        np.add.at(self.sums[0], place, energies)
        np.add.at(self.counts[0], place, 1)

    def join(self, others: Sequence[Self]) -> None:
        """Append other replicas."""
        self.sums = np.concatenate([self.sums, *(other.sums for other in others)])
        self.counts = np.concatenate([self.counts, *(other.counts for other in others)])

    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return kinetic_energy and, with replicas, its error."""
        reached = self._reached()
        energies = self.sums[:, reached] / self.counts[:, reached]
        variables: Variables = {"kinetic_energy": (("time",), energies.mean(axis=0))}
        n = len(energies)
        if n > 1:
            error = energies.std(axis=0, ddof=1) / np.sqrt(n)
            variables["kinetic_energy_error"] = (("time",), error)
        return variables

    def coordinates(self) -> dict[str, Array]:
        """Return the mean time of the snapshots in each average."""
        first = np.arange(self.counts.shape[1]) * self.together
        last = first + np.mean(self.counts, axis=0)
        return {"time": (self.begin + (first + last + 1) / 2 * self.interval)[self._reached()]}

    def _reached(self) -> NDArray[np.bool_]:
        return np.asarray((self.counts > 0).all(axis=0))
