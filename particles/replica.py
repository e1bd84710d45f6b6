"""One copy of the chain: its start, its state, its random numbers and its measurements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from threading import Event, Lock
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.avalanche import Tally, make_tally
from crazybilliards.particles.drift import HEAP, Law, make_scratch
from crazybilliards.particles.observers import Avalanches, Observer, Snapshots
from crazybilliards.particles.schedule import Schedule
from crazybilliards.particles.stepping import Step, advance, bounded, record

Array = NDArray[np.float64]

# Between two looks at Ctrl-C a replica takes about this many particle steps (some 20 ms).
_CHUNK = 2**20

_CHANGING = ("y", "v", "counts", "steps", "diverged")


class Dynamics(NamedTuple):
    """What moves a chain: the numbers its kernels need, the same for all replicas."""

    anchors: Array
    step: Step
    law: Law
    fastest: float  # a rod that is faster has left every steady state: the chain diverged


@dataclass
class Replica:
    """State and measurements of one copy of the chain."""

    y: Array
    v: Array
    generator: np.random.Generator
    observers: list[Observer]
    counts: NDArray[np.int64]  # snapshots taken, block by block
    steps: int = 0
    diverged: bool = False
    lock: Any = field(default_factory=Lock)  # held while a chunk is under way

    def state(self) -> dict[str, ArrayLike]:
        """Return all that changes while running, but the generator's state."""
        state: dict[str, ArrayLike] = {name: getattr(self, name) for name in _CHANGING}
        for number, observer in enumerate(self.observers):
            for name in observer.accumulated:
                state[f"observer {number} {name}"] = getattr(observer, name)
        return state

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take over what :meth:`state` returned."""
        for name in _CHANGING:
            _put(self, name, state[name])
        for number, observer in enumerate(self.observers):
            for name in observer.accumulated:
                _put(observer, name, state[f"observer {number} {name}"])

    def work(self, dynamics: Dynamics, schedule: Schedule, stop: Event) -> Iterator[int]:
        """Run, holding the lock during each chunk; yield the steps of every chunk."""
        chunks = self.run(dynamics, schedule, stop)
        while True:
            with self.lock:
                steps = next(chunks, None)
            if steps is None:
                return
            yield steps

    def run(self, dynamics: Dynamics, schedule: Schedule, stop: Event) -> Iterator[int]:
        """Warm up, then measure; yield the number of steps after every chunk."""
        if self.diverged:
            return
        size = self.y.size
        anchors, step, law, fastest = dynamics
        kernel = (self.y, self.v, anchors, self.generator, step, law, make_scratch(size))
        unseen = make_tally(size, contacts=False, waves=False)
        chunk = max(_CHUNK // size, 1)
        while self.steps < schedule.warmup_steps and not stop.is_set():
            steps = min(chunk, schedule.warmup_steps - self.steps)
            met = advance(*kernel, unseen, steps)
            self.diverged = met < 0 or not bounded(self.y, self.v, fastest)
            if self.diverged:
                return
            yield self._count(steps)
        tally = self._tally(counted=law.operator == HEAP)
        rows = min(max(chunk // schedule.stride, 1), schedule.snapshots_per_block)
        y_buffer, v_buffer = np.empty((2, rows, size))
        for block in range(schedule.blocks):
            while self.counts[block] < schedule.snapshots_per_block and not stop.is_set():
                n = min(rows, schedule.snapshots_per_block - int(self.counts[block]))
                tally.contacts[:] = 0
                good = record(*kernel, tally, schedule.stride, fastest, y_buffer[:n], v_buffer[:n])
                first = block * schedule.snapshots_per_block + int(self.counts[block])
                chunk_seen = Snapshots(
                    block, first, y_buffer[:good], v_buffer[:good], tally.contacts
                )
                for observer in self.observers:
                    observer.observe(chunk_seen)
                self.counts[block] += good
                # Before the yield, where a checkpoint may be taken.
                self.diverged = good < n
                yield self._count(good * schedule.stride)
                if self.diverged:
                    return

    def _tally(self, *, counted: bool) -> Tally:
        """Collisions at each contact if they are counted at all; waves if they are observed."""
        tally = make_tally(self.y.size, contacts=counted, waves=False)
        for observer in self.observers:
            if isinstance(observer, Avalanches):
                waves = {name: getattr(observer, name) for name in observer.accumulated}
                tally = tally._replace(**waves)
        return tally

    def _count(self, steps: int) -> int:
        self.steps += steps
        return steps


def _put(owner: object, name: str, value: NDArray[Any]) -> None:
    """Set an attribute to a restored value, keeping its kind: an array or a plain number."""
    current = getattr(owner, name)
    if isinstance(current, np.ndarray):
        if current.shape != value.shape or current.dtype != value.dtype:
            raise ValueError(f"the checkpoint's {name} does not fit this run")
        current[...] = value
    else:
        setattr(owner, name, type(current)(value))


def typical_speed(chain: Chain, duration: float, y: Array, v: Array) -> float:
    """Upper estimate of the speed that noise and the start's own energy give a rod [R/T]."""
    heating = min(duration, chain.mass / (2 * chain.damping) if chain.damping else np.inf)
    noise = chain.amplitude / chain.mass * np.sqrt(heating)
    spring = np.sqrt(2 * chain.potential(y - chain.reduced_anchors).max() / chain.mass)
    return float(noise + spring + np.abs(v).max())
