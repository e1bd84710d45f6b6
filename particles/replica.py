"""One copy of the chain: its start, its state, its random numbers and its measurements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from threading import Event

import numpy as np
import xarray as xr
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import require
from crazybilliards.particles.observers import Observer
from crazybilliards.particles.schedule import Schedule
from crazybilliards.particles.stepping import Step, advance, record
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Between two looks at Ctrl-C a replica takes about this many particle steps (some 20 ms).
_CHUNK = 2**20


@dataclass
class Replica:
    """State and measurements of one copy of the chain."""

    anchors: Array
    y: Array
    v: Array
    generator: np.random.Generator
    observers: list[Observer]
    counts: NDArray[np.int64]  # snapshots taken, block by block
    steps: int = 0
    diverged: bool = False

    def run(self, step: Step, schedule: Schedule, stop: Event) -> Iterator[int]:
        """Warm up, then measure; yield the number of steps after every chunk."""
        size = self.y.size
        chunk = max(_CHUNK // size, 1)
        while self.steps < schedule.warmup_steps and not stop.is_set():
            steps = min(chunk, schedule.warmup_steps - self.steps)
            advance(self.y, self.v, self.anchors, self.generator, step, steps)
            yield self._count(steps)
        rows = min(max(chunk // schedule.stride, 1), schedule.snapshots_per_block)
        y_buffer, v_buffer = np.empty((2, rows, size))
        for block in range(schedule.blocks):
            while self.counts[block] < schedule.snapshots_per_block and not stop.is_set():
                n = min(rows, schedule.snapshots_per_block - int(self.counts[block]))
                buffers = y_buffer[:n], v_buffer[:n]
                record(
                    self.y, self.v, self.anchors, self.generator, step, schedule.stride, *buffers
                )
                # NaN and inf reach every later state, so looking at the last one is enough.
                self.diverged = not (np.isfinite(self.y).all() and np.isfinite(self.v).all())
                if self.diverged:
                    return
                for observer in self.observers:
                    observer.observe(block, *buffers)
                self.counts[block] += n
                yield self._count(n * schedule.stride)

    def _count(self, steps: int) -> int:
        self.steps += steps
        return steps


def replica_starts(
    chain: Chain, start: xr.Dataset | None, replicas: int
) -> list[tuple[Array, Array]]:
    """Return each replica's own reduced positions and velocities, checked."""
    if start is None:
        rest = (chain.reduced_anchors, np.zeros(chain.size))
        return [(rest[0].copy(), rest[1].copy()) for _ in range(replicas)]
    require(start, ("position", "velocity"))
    shape = (replicas, chain.size)
    y = chain.reduced(start.position.transpose("replica", "particle").values)
    v = start.velocity.transpose("replica", "particle").values
    if y.shape != shape or v.shape != shape:
        raise ValueError(
            f"start must hold {replicas} replicas of {chain.size} particles, got {y.shape}"
        )
    if not (np.isfinite(y).all() and np.isfinite(v).all()):
        raise ValueError("start must be finite")
    # Rounding of x -> y may leave touching rods out of order by an ulp of x.
    tolerance = 1e-12 * max(float(np.abs(start.position).max()), chain.radius)
    if (np.diff(y, axis=1) < -tolerance).any():
        raise ValueError("start must hold rods in order that do not overlap")
    y = np.maximum.accumulate(y, axis=1)
    return [(np.array(y[i]), np.array(v[i], dtype=float)) for i in range(replicas)]
