"""What an observer is: it takes buffers of snapshots, keeps sums, and reports variables.

Every replica has observers of its own; they are joined in the order of the replicas, so that
results do not depend on how many threads ran them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.schedule import Schedule

Array = NDArray[np.float64]
Variables = dict[str, tuple[tuple[str, ...], ArrayLike]]


class Snapshots(NamedTuple):
    """What observers are handed: some successive snapshots, all of one block."""

    block: int
    first: int  # number of the first one within the replica, from 0
    y: Array  # (snapshots, L), reduced coordinates
    v: Array  # (snapshots, L)
    collisions: NDArray[np.int64]  # since the last snapshots, by contact; empty if not counted


class Observer(ABC):
    """What the simulation asks of a measurement; made anew, with (chain, schedule), per replica.

    ``accumulated`` names the attributes that change while observing: arrays and plain numbers.
    They are what a checkpoint keeps.
    """

    accumulated: ClassVar[tuple[str, ...]]

    @abstractmethod
    def __init__(self, chain: Chain, schedule: Schedule) -> None: ...

    @abstractmethod
    def observe(self, seen: Snapshots) -> None:
        """Take some snapshots."""

    @abstractmethod
    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas to one's own."""

    @abstractmethod
    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return the variables measured; ``counts``: the snapshots in every block."""

    def coordinates(self) -> dict[str, Array]:
        """Return the values along dimensions of the variables' own: x, time, velocity."""
        return {}
