"""A trajectory that is measured in rounds, of one chain or of two at coupled time steps.

It is a replica whose observers form groups, each with its own sums. In every round the trajectory
continues and gives each group the same number of snapshots, one group after the other. There is
therefore only one warm-up, and no measurement is thrown away. Leaving out one group at a time gives
the standard error of everything that the observers report.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.observers.base import Observer, Snapshots
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.replica import Replica
from crazybilliards.particles.vanishing_step.coupling import record_pair


class Sampler(Replica):
    """One trajectory at the step of ``finer``, or coupled to one at the longer step of ``coarser``.

    It takes no steps until :meth:`extend` requests snapshots.
    """

    changing = (*Replica.changing, "before", "target", "correlation", "collisions")

    def __init__(
        self, finer: Run, coarser: Run | None, stream: np.random.SeedSequence, groups: int
    ) -> None:
        self.finer, self.coarser = finer, coarser
        self.correlation = 0.0
        self.collisions = np.zeros(2, dtype=np.int64)  # measured ones, of the finer chain first
        self.before = self.target = 0  # snapshots of a group, at the begin and end of a round
        self.measured: list[list[list[Observer]]] = []  # by group and chain, the finer chain first
        counts = np.zeros(groups, dtype=np.int64)
        super().__init__(finer.schedule, finer.dynamics(), finer.starts, [stream], [], counts)
        self._set_steps()

    def _start(self) -> None:
        super()._start()
        if self.coarser is not None:
            self.y, self.v = (np.array([each, each]) for each in (self.y, self.v))

    def _set_steps(self) -> None:
        """Compute the quantities that follow from the chains and the requested snapshots."""
        schedule = (self.coarser or self.finer).schedule
        self.schedule = replace(
            schedule, blocks=self.counts.size, snapshots=self.counts.size * self.target
        )
        self.observers = [each for chains in self.measured for some in chains for each in some]
        # Number of rods that move in every counted step.
        self.weight = self.finer.chain.size
        if self.coarser is not None:
            self.both = self.dynamics, self.coarser.dynamics()
            self.ratio = round(schedule.time_step / self.finer.schedule.time_step)
            self.weight *= 1 + self.ratio

    def extend(self, target: int) -> None:
        """Request this number of snapshots in every group, including the existing ones."""
        if not self.measured:
            runs = [run for run in (self.finer, self.coarser) if run is not None]
            self.measured = [
                [[each.prepared(run, 1) for each in run.observers] for run in runs]
                for _ in self.counts
            ]
        self.before, self.target = self.target, target
        self._set_steps()

    def uncouple(self, correlation: float) -> None:
        """Continue with the finer chain alone; ``correlation`` is recorded.

        The measurements of the coarser chain are not used any more.
        """
        self.correlation = correlation
        self.steps *= self.ratio
        self.coarser = None
        self.y, self.v = self.y[0].copy(), self.v[0].copy()
        self.measured = [chains[:1] for chains in self.measured]
        self._set_steps()

    @property
    def total(self) -> float:
        """Total number of rod steps up to the end of the round."""
        return float(self.schedule.steps * self.weight if self.target else 0)

    @property
    def done(self) -> float:
        """Number of rod steps taken."""
        return float(self.steps * self.weight)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Restore the state that :meth:`state` returned, of both chains or of the finer one."""
        if self.coarser is not None and state["y"].ndim == 1:
            self.uncouple(0.0)
        if state["target"]:
            self.extend(int(state["target"]))
        super().restore(state)

    def run(self, stop: Event) -> Iterator[int]:
        """Continue to the end of the round; yield the number of steps after every chunk."""
        if self.target:
            yield from super().run(stop)

    def _chunk(self) -> int:
        return max(super()._chunk() * self.finer.chain.size // self.weight, 1)

    def _scratch(self) -> Any:
        if self.coarser is None:
            return super()._scratch()
        return super()._scratch(), super()._scratch()

    def _record(self, scratch: Any, tally: Tally, due: int, n: int, y: Array, v: Array) -> int:
        if self.coarser is None:
            return super()._record(scratch, tally, due, n, y, v)
        pair = self.y, self.v, self.noise, self.both, self.ratio
        return int(record_pair(*pair, scratch, tally, due, n, y, v))

    def _block(self) -> tuple[int, int]:
        room = self.target - self.before
        group, taken = divmod(self.snapshots - self.counts.size * self.before, room)
        return group, room - taken

    def _observe(self, block: int, y: Array, v: Array, tally: Tally) -> None:
        if self.coarser is None:
            y, v = y[np.newaxis], v[np.newaxis]
        self.collisions += tally.collisions
        tally.collisions[:] = 0
        first = int(self.counts[block])
        for observers, own_y, own_v in zip(self.measured[block], y, v, strict=True):
            for observer in observers:
                observer.observe(Snapshots(0, first, 0, own_y, own_v, tally.contacts))


def compile_pair() -> None:
    """Compile the kernels of a pair, or load them from numba's cache."""
    dynamics = tuple(make_dynamics(Chain(size=2), step, speed=1.0) for step in (0.1, 0.3))
    y, v = np.zeros((2, 2, 2))
    scratch = make_scratch(2), make_scratch(2)
    noise, tally = make_noise(np.random.SeedSequence(0)), make_tally(2, contacts=False)
    record_pair(y, v, noise, dynamics, 3, scratch, tally, 1, 1, *np.zeros((2, 2, 1, 2)))
