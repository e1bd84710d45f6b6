"""What an observer is: it takes buffers of snapshots, keeps sums, and reports variables.

Every replica (in an ensemble every group of replicas) has observers of its own; they are joined
in order, so that results do not depend on how many threads ran them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.observers.error_bars import jackknife
from crazybilliards.particles.schedule import Schedule

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Variables = dict[str, tuple[tuple[str, ...], ArrayLike]]


class Snapshots(NamedTuple):
    """What observers are handed: some successive snapshots, all of one block."""

    block: int
    first: int  # number of the first one within the replica, from 0
    copy: int  # which of the replicas that share this observer
    y: Array  # (snapshots, L), reduced coordinates
    v: Array  # (snapshots, L)
    collisions: Integers  # since the last snapshots, by contact; empty if not counted


class Plan(NamedTuple):
    """What an observer is made for."""

    chain: Chain
    schedule: Schedule
    chosen: Integers  # the particles asked for, from 0
    swing: float  # how far the start's energy takes a rod from its anchor
    copies: int  # replicas that share the observer


class Observer(ABC):
    """What the simulation asks of a measurement; made anew for every replica, or group of them.

    ``accumulated`` names the attributes that change while observing, arrays and plain numbers:
    what a checkpoint keeps.
    """

    accumulated: ClassVar[tuple[str, ...]]
    ensemble: ClassVar[bool] = True  # whether it can be averaged over replicas at equal times

    @abstractmethod
    def __init__(self, plan: Plan) -> None: ...

    @staticmethod
    @abstractmethod
    def memory(plan: Plan) -> float:
        """Return the bytes that one made for this plan would keep."""

    @abstractmethod
    def observe(self, seen: Snapshots) -> None:
        """Take some snapshots."""

    @abstractmethod
    def join(self, others: Sequence[Self]) -> None:
        """Append what other replicas or groups measured to one's own."""

    @abstractmethod
    def report(self, counts: Integers) -> Variables:
        """Return the variables measured.

        ``counts``: the snapshots in every block, shape (blocks of all replicas,), in an ensemble
        at every time, shape (groups, times).
        """

    def coordinates(self) -> dict[str, Array]:
        """Return the values along dimensions of the variables' own: x, velocity."""
        return {}


class Averaged(Observer):
    """An observer that keeps ``sums``, shape (blocks, ...), and reports averages of them.

    Joined, the blocks of all replicas stand one after another; in an ensemble, where a block is
    a time, the groups are put side by side: (groups, times, ...), and averages are over groups.
    """

    accumulated: ClassVar[tuple[str, ...]] = ("sums",)
    schedule: Schedule
    sums: Array

    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas, or the groups."""
        parts = [self.sums, *(other.sums for other in others)]
        self.sums = np.stack(parts) if self.schedule.ensemble else np.concatenate(parts)

    def averages(
        self,
        quantities: Mapping[str, Callable[[Array], Array]],
        counts: Integers,
        dimension: str,
    ) -> Variables:
        """Return every quantity, a function of the average of the sums, and its error."""
        dimensions: tuple[str, ...] = (dimension,)
        sums = self.sums
        if self.schedule.ensemble:
            # Times that not all came to, at the end, are not asked for.
            dimensions, sums = ("time", dimension), sums[:, : counts.shape[1]]
        variables: Variables = {}
        for name, quantity in quantities.items():
            value, error = jackknife(quantity, sums, counts)
            variables[name] = (dimensions, value)
            variables[f"{name}_error"] = (dimensions, error)
        return variables
