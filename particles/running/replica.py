"""One copy of the chain: its start, its state, its random numbers and its measurements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from threading import Event, Lock
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model.arrays import Array
from crazybilliards.particles.dynamics import Dynamics
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import STATE, make_noise
from crazybilliards.particles.observers.base import (
    Observer,
    Snapshots,
    leading,
    merge_pairs,
    restore,
)
from crazybilliards.particles.run import Run
from crazybilliards.particles.schedule import Schedule
from crazybilliards.particles.stepping import advance, record

# Number of particle steps between two checks for Ctrl-C (about 20 ms), and the most positions in
# the snapshots between them, which then stay in a processor's cache.
_CHUNK, _ROOM = 2**20, 2**17

NEVER = 2**62


@dataclass
class Replica:
    """State and measurements of one copy of the chain, or of several, one after another.

    In an ensemble the replicas form groups that share their observers, so that a thousand replicas
    take no more memory than a few.
    """

    schedule: Schedule
    dynamics: Dynamics
    starts: Sequence[tuple[Array, Array]]
    streams: Sequence[np.random.SeedSequence]
    observers: list[Observer]
    counts: NDArray[np.int64]  # snapshots taken, block by block
    copy: int = 0  # the one under way
    steps: int = 0  # that it has taken
    snapshots: int = 0  # taken of it
    over: bool = False  # it diverged
    reached: int = NEVER  # the first block that a diverged copy did not fill
    # Attributes that a checkpoint keeps.
    changing: ClassVar[Any] = (
        *("copy", "y", "v", "counts", "length", "steps", "snapshots", "over", "reached"),
    )
    lock: Any = field(default_factory=Lock)  # held while a chunk is under way

    def __post_init__(self) -> None:
        self.length = self.schedule.block  # of a block, in snapshots
        self.before_the_end: dict[str, ArrayLike] | None = None  # a state, see ``_measure``
        self._start()

    def _start(self) -> None:
        """Set the chain to the start of the present copy."""
        self.y, self.v = (np.array(each) for each in self.starts[self.copy])
        self.noise = make_noise(self.streams[self.copy])
        self.steps, self.snapshots, self.over = 0, 0, False

    @property
    def diverged(self) -> bool:
        """Return whether any copy diverged so far."""
        return self.reached < NEVER

    def state(self) -> dict[str, ArrayLike]:
        """Return everything that changes during the run, from which a longer one can go on too."""
        if self.before_the_end is not None:
            return self.before_the_end
        state: dict[str, ArrayLike] = {name: getattr(self, name) for name in self.changing}
        state |= {f"noise {name}": getattr(self.noise, name) for name in STATE}
        for number, observer in enumerate(self.observers):
            for name, value in observer.state().items():
                state[f"observer {number} {name}"] = value
        return state

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Restore the state that :meth:`state` returned."""
        for name in self.changing:
            restore(self, name, state[name])
        for name in STATE:
            getattr(self.noise, name)[...] = state[f"noise {name}"]
        for number, observer in enumerate(self.observers):
            for name in observer.state():
                restore(observer, name, state[f"observer {number} {name}"])

    def extend(self, snapshots: int) -> None:
        """Go on up to this number of snapshots, to the bits of one run of this length."""
        self.restore({name: np.array(value) for name, value in self.state().items()})
        self.before_the_end = None
        self.schedule = replace(self.schedule, snapshots=snapshots)

    def require_continuing(self, shorter: Run) -> None:
        """Raise unless the observers, which have seen nothing, continue those of a shorter run.

        What both begin with may differ in the number of places for snapshots, and in nothing else.
        Nor may the speeds at which rods merge and, for e > 1, at which they count as diverged.
        """
        now, before = self.dynamics, shorter.dynamics()
        diverges = now.law.restitution > 1 and now.fastest != before.fastest
        if diverges or now.law != before.law:
            speed = "above which it has diverged" if diverges else "below which its rods merge"
            raise ValueError(
                f"the run cannot be made longer: the speed {speed} depends on the duration, "
                "because the chain has so little damping"
            )
        for own, other in zip(self.observers, shorter.observers, strict=True):
            for name, value in other.prepared(shorter, copies=1).state().items():
                place = leading(np.asarray(own.state()[name]), np.asarray(value))
                if place is None or place.tobytes() != np.asarray(value).tobytes():
                    raise ValueError(
                        f"observe: {own.name!r} cannot continue, because its {name} depends on the "
                        "duration"
                    )

    @property
    def total(self) -> float:
        """Time that the replica has to simulate, warm-up included."""
        return len(self.starts) * self.schedule.steps * self.schedule.time_step

    @property
    def done(self) -> float:
        """Time that the replica has simulated."""
        return (self.copy * self.schedule.steps + self.steps) * self.schedule.time_step

    def work(self, stop: Event) -> Iterator[float]:
        """Run and hold the lock during each chunk; yield the work ``done`` in every chunk."""
        chunks = self.run(stop)
        while True:
            with self.lock:
                before = self.done
                if next(chunks, None) is None:
                    return
                after = self.done
            yield after - before

    def run(self, stop: Event) -> Iterator[int]:
        """Warm up and measure, copy by copy; yield the number of steps after every chunk."""
        while True:
            yield from self._warm_up(stop)
            yield from self._measure(stop)
            if stop.is_set() or self.copy + 1 == len(self.starts):
                return
            self.copy += 1
            self._start()

    def _warm_up(self, stop: Event) -> Iterator[int]:
        scratch = self._scratch()
        uncounted = make_tally(self.y.size, contacts=False)
        while self.steps < self.schedule.warmup_steps and not (self.over or stop.is_set()):
            steps = min(self._chunk(), self.schedule.warmup_steps - self.steps)
            if not self._advance(scratch, uncounted, steps):
                self._diverge(0)
                return
            self.steps += steps
            yield steps

    def _measure(self, stop: Event) -> Iterator[int]:
        schedule, chunk = self.schedule, self._chunk()
        scratch, tally = self._scratch(), self._tally()
        rows = max(min(chunk // schedule.stride, _ROOM // self.y.size), 1)
        y_buffer, v_buffer = np.empty((2, rows, self.y.size))
        while self.snapshots < schedule.snapshots and not (self.over or stop.is_set()):
            block, left = self._block()
            n = min(rows, left)
            if schedule.snapshots - self.snapshots < n:
                # A longer run would take this chunk as a whole, and add it up to other bits.
                self.before_the_end = {name: np.array(each) for name, each in self.state().items()}
                n = schedule.snapshots - self.snapshots
            due = schedule.step_of(self.snapshots) - self.steps
            tally.contacts[:] = 0
            if due == 0:  # the start of an ensemble
                y_buffer[0], v_buffer[0], good, steps = self.y, self.v, 1, 0
            elif due > chunk:  # no snapshot is due, but Ctrl-C must not wait
                n, good, steps = 0, 0, chunk
                if not self._advance(scratch, tally, steps):
                    self._diverge(block)
                    return
            else:
                good = self._record(scratch, tally, due, n, y_buffer, v_buffer)
                steps = good * due
            self._observe(block, y_buffer[:good], v_buffer[:good], tally)
            # All updates come before the yield, where a checkpoint may be saved.
            self.counts[block] += good
            self.snapshots += good
            self.steps += steps
            if good < n:
                self._diverge(block)
            yield steps

    def _chunk(self) -> int:
        """Return the steps between two checks for Ctrl-C."""
        return max(_CHUNK // self.y.size, 1)

    def _scratch(self) -> Any:
        """Return the arrays that the kernels work in."""
        return make_scratch(self.y.size, self.dynamics.inverse)

    def _advance(self, scratch: Any, tally: Tally, steps: int) -> bool:
        """Take steps without snapshots; return False if the chain diverged."""
        return advance(self.y, self.v, self.noise, self.dynamics, scratch, tally, steps) >= 0

    def _record(self, scratch: Any, tally: Tally, due: int, n: int, y: Array, v: Array) -> int:
        """Fill ``n`` rows of the buffers, ``due`` steps apart; return the number of valid rows."""
        state = self.y, self.v, self.noise, self.dynamics, scratch, tally
        return record(*state, due, y[:n], v[:n])[0]

    def _block(self) -> tuple[int, int]:
        """Return the block of the next snapshot, and how many it still needs; make room for it."""
        if self.snapshots == self.schedule.blocks * self.length:
            self.length *= 2
            merge_pairs(self.counts)
            for observer in self.observers:
                observer.merge()
        block, taken = divmod(self.snapshots, self.length)
        return block, self.length - taken

    def _observe(self, block: int, y: Array, v: Array, tally: Tally) -> None:
        """Give snapshots of a block to the observers."""
        shared = y, v, tally.contacts.view()
        for each in shared:  # an observer that changed them would spoil what others measure
            each.flags.writeable = False
        snapshots = Snapshots(block, self.snapshots, self.copy, *shared)
        for observer in self.observers:
            observer.observe(snapshots)

    def _diverge(self, block: int) -> None:
        self.over, self.reached = True, min(self.reached, block)

    def _tally(self) -> Tally:
        """Return the record of collisions: counts, and the arrays that observers add."""
        counted = any(observer.single_collisions for observer in self.observers)
        tally = make_tally(self.y.size, contacts=counted)
        for observer in self.observers:
            tally = observer.tally(tally)
        return tally
