"""The energies of the rods and of the springs in time."""

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import WALLS_AND_MASSES
from crazybilliards.model.arrays import merge_pairs
from crazybilliards.particles.observers.base import Array, Integers, Observer, Snapshots, Variables
from crazybilliards.particles.observers.error_bars import jackknife
from crazybilliards.particles.run import Run

_MOST_TIMES = 1000


class Energy(Observer):
    """kinetic_energy, spring_energy and total_energy against time, averaged over the replicas.

    They are the sums over the rods of m v^2/2, of the potential U(x - x0) of their springs, and of
    both. On linear springs without a gap each of the first two is L T/2 at e = 1.

    Of 2, 4, 8, ... successive snapshots the average is kept, so that there are at most 1000 times;
    an ensemble, and a run that observes the snapshots too, keep all. With two or more replicas each
    has its _error, the standard error of their mean. Times that not every replica reached are left
    out, or NaN beside snapshots.
    """

    name = "energy"
    gives = ("kinetic_energy", "spring_energy", "total_energy")
    along = ("time",)
    shares_time = True
    knows = WALLS_AND_MASSES

    def prepare(self, run: Run, copies: int) -> None:
        self.run, self.together = run, 1
        times = run.snapshots if _keeps_every(run) else _MOST_TIMES
        self.sums = np.zeros((1, times, 2))  # of the rods and of the springs
        self.counts = np.zeros((1, times), dtype=np.int64)

    def memory(self, run: Run) -> float:
        return 24.0 * (run.snapshots if _keeps_every(run) else _MOST_TIMES)

    def observe(self, snapshots: Snapshots) -> None:
        chain, v = self.run.chain, snapshots.v
        kinetic = chain.mass / 2 * np.einsum("sp,sp->s", chain.rod_masses / chain.mass * v, v)
        springs = chain.potential(snapshots.y - chain.reduced_anchors).sum(axis=1)
        while snapshots.first + kinetic.size > self.sums.shape[1] * self.together:
            merge_pairs(self.sums[0])
            merge_pairs(self.counts[0])
            self.together *= 2
        place = (snapshots.first + np.arange(kinetic.size)) // self.together
        np.add.at(self.sums[0], place, np.stack([kinetic, springs], axis=1))
        np.add.at(self.counts[0], place, 1)

    def join(self, others: Sequence[Self]) -> None:
        self.sums = np.concatenate([self.sums, *(other.sums for other in others)])
        self.counts = np.concatenate([self.counts, *(other.counts for other in others)])

    def report(self, counts: Integers) -> Variables:
        if self.run.ensemble:
            energies, numbers = self.sums[:, : counts.shape[1]], counts
        else:
            reached = self._reached()
            energies, numbers = self.sums[:, reached], self.counts[:, reached]
        value, error = jackknife(
            lambda both: np.concatenate([both, both.sum(axis=-1, keepdims=True)], axis=-1),
            energies,
            numbers,
        )
        if not self.run.ensemble:
            unknown = (numbers == 0).any(axis=0)
            value[unknown] = error[unknown] = np.nan
        variables: Variables = {}
        for place, name in enumerate(self.gives):
            variables[name] = (("time",), value[:, place])
            if len(numbers) > 1:
                variables[f"{name}_error"] = (("time",), error[:, place])
        return variables

    def coordinates(self) -> dict[str, Array]:
        first = np.arange(self.counts.shape[1]) * self.together
        # run.times would take too much memory in a long run.
        together = self.counts.sum(axis=0) / np.maximum((self.counts > 0).sum(axis=0), 1)
        return {"time": self.run.time(first + (together - 1) / 2)[self._reached()]}

    def _reached(self) -> NDArray[np.bool_]:
        """Return which times are reported."""
        counted = self.counts > 0
        return np.asarray(counted.any(axis=0) if _keeps_every(self.run) else counted.all(axis=0))


def _keeps_every(run: Run) -> bool:
    return run.ensemble or sum(observer.shares_time for observer in run.observers) > 1
