"""Raw snapshots, for whoever wants to measure something else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.particles.observers.base import (
    Array,
    Integers,
    Observer,
    Plan,
    Snapshots,
    Variables,
)


class Raw(Observer):
    """position and velocity of every chosen particle at every snapshot of every replica.

    16 bytes per particle, snapshot and replica: ask for few snapshots with ``every``. Snapshots
    that a run which was cut short did not come to are NaN. One time of it is a start for another
    run: ``run.isel(time=-1)``.
    """

    accumulated = ("y", "v")

    def __init__(self, plan: Plan) -> None:
        self.schedule = plan.schedule
        self.chosen = plan.chosen
        self.offsets = plan.chain.physical(np.zeros(plan.chain.size))[plan.chosen]
        self.y, self.v = np.full(
            (2, plan.copies, plan.schedule.times.size, plan.chosen.size), np.nan
        )

    @staticmethod
    def memory(plan: Plan) -> float:
        """Return the bytes it keeps."""
        return 16.0 * plan.chosen.size * plan.schedule.snapshots * plan.copies

    def observe(self, seen: Snapshots) -> None:
        """Put the snapshots in their places."""
        place = slice(seen.first, seen.first + len(seen.y))
        self.y[seen.copy, place] = seen.y[:, self.chosen]
        self.v[seen.copy, place] = seen.v[:, self.chosen]

    def join(self, others: Sequence[Self]) -> None:
        """Append other replicas."""
        self.y = np.concatenate([self.y, *(other.y for other in others)])
        self.v = np.concatenate([self.v, *(other.v for other in others)])

    def report(self, counts: Integers) -> Variables:
        """Return position and velocity."""
        dimensions = ("replica", "time", "particle")
        reached = slice(counts.shape[1]) if self.schedule.ensemble else self._reached()
        return {
            "position": (dimensions, self.y[:, reached] + self.offsets),
            "velocity": (dimensions, self.v[:, reached]),
        }

    def coordinates(self) -> dict[str, Array]:
        """Return the times of the snapshots."""
        if self.schedule.ensemble:
            return {}
        return {"time": self.schedule.times[self._reached()]}

    def _reached(self) -> NDArray[np.bool_]:
        return np.asarray(np.isfinite(self.v).any(axis=(0, 2)))
