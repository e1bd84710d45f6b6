"""One copy of the chain: its start, its state, its random numbers and its measurements."""

from collections.abc import Iterator, Mapping
from threading import Event, Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Array
from crazybilliards.model.arrays import merge_pairs
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.law import Scratch, make_scratch
from crazybilliards.particles.noise import STATE, make_noise
from crazybilliards.particles.observers.base import Snapshots
from crazybilliards.particles.run import Run
from crazybilliards.particles.stepping import advance, record

_CHUNK = 2**20  # particle steps between two checks for Ctrl-C, about 20 ms
_ROOM = 2**17  # positions in the snapshots between them, which stay in a processor's cache
_LINE = 8  # numbers in a line of the cache, 64 bytes

NEVER = 2**62


class Replica:
    """State and measurements of one copy of the chain, or of several, one after another.

    In an ensemble groups of replicas share their observers, which saves memory. ``members``: the
    numbers of the replicas of the group, from 0.
    """

    # Attributes that a checkpoint keeps.
    changing = ("copy", "y", "v", "counts", "length", "steps", "snapshots", "over", "reached")

    def __init__(self, run: Run, members: NDArray[np.int64]) -> None:
        self.run, self.members, self.dynamics = run, members, run.dynamics
        self.observers = [observer.prepared(run, members.size) for observer in run.observers]
        self.counts = np.zeros(run.blocks, dtype=np.int64)  # snapshots taken, block by block
        self.length = run.block  # of a block, in snapshots
        self.copy = 0  # the one under way
        self.reached = NEVER  # the first block that a diverged copy did not fill
        self.lock = Lock()  # held while a chunk is under way
        self.patience = np.full(1, NEVER)  # see ``Scratch``
        self.broken = False  # a step was given up, and the state is that of no time
        self._start()

    def _start(self) -> None:
        """Set the chain to the start of the present copy."""
        number = self.members[self.copy]
        self.y, self.v = (_aligned(values) for values in self.run.starts[number])
        self.noise = make_noise(self.run.streams[number])
        self.steps = self.snapshots = 0  # that it has taken
        self.over = False  # it diverged

    def _kept(self) -> Iterator[tuple[str, Any, str]]:
        """Yield everything that changes during the run: a name, its owner and the attribute."""
        yield from ((name, self, name) for name in self.changing)
        yield from ((f"noise {name}", self.noise, name) for name in STATE)
        for number, observer in enumerate(self.observers):
            yield from ((f"observer {number} {name}", observer, name) for name in observer.state())

    def state(self) -> dict[str, ArrayLike]:
        """Return what a checkpoint keeps."""
        return {key: getattr(owner, name) for key, owner, name in self._kept()}

    def restore(self, state: Mapping[str, NDArray[Any]], prefix: str) -> None:
        """Restore what :meth:`state` returned, from keys with a prefix."""
        for key, owner, name in self._kept():
            restore(owner, name, state[prefix + key])

    @property
    def total(self) -> float:
        """Time that the replica has to simulate, warm-up included."""
        return self.members.size * self.run.steps * self.run.time_step

    @property
    def done(self) -> float:
        """Time that the replica has simulated."""
        return (self.copy * self.run.steps + self.steps) * self.run.time_step

    def work(self, stop: Event) -> None:
        """Run to the end, or until ``stop`` is set; hold the lock during each chunk."""
        chunks, going = self._run(stop), True
        while going:
            with self.lock:
                going = next(chunks, False)

    def _run(self, stop: Event) -> Iterator[bool]:
        """Warm up and measure, copy by copy; yield after every chunk."""
        run, size = self.run, self.y.size
        chunk = max(_CHUNK // size, 1)
        buffers = np.empty((2, max(min(chunk // run.stride, _ROOM // size), 1), size))
        scratch = make_scratch(size, self.dynamics.inverse, self.patience)
        tally, uncounted = (
            make_tally(size, contacts=counted) for counted in (run.recorded["counted"], False)
        )
        for observer in self.observers:
            tally = observer.tally(tally)
        while not stop.is_set():
            if self.over or self.snapshots == run.snapshots:
                if self.copy + 1 == self.members.size:
                    return
                self.copy += 1
                self._start()
            elif self.steps < run.warmup_steps:
                self._advance(min(chunk, run.warmup_steps - self.steps), scratch, uncounted)
            else:
                self._measure(chunk, scratch, tally, *buffers)
            yield True

    def _advance(self, steps: int, scratch: Scratch, tally: Tally) -> bool:
        """Take steps without snapshots; return False if the chain diverged."""
        if advance(self.y, self.v, self.noise, self.dynamics, scratch, tally, steps) < 0:
            self._diverge()
            return False
        self.steps += steps
        return True

    def _measure(
        self, chunk: int, scratch: Scratch, tally: Tally, y_buffer: Array, v_buffer: Array
    ) -> None:
        """Let observers take the next snapshots, all of one block, after the steps due to them."""
        block, left = self._block()
        n = min(len(y_buffer), left, self.run.snapshots - self.snapshots)
        due = self.run.step_of(self.snapshots) - self.steps
        tally.contacts[:] = 0
        if due > chunk:  # no snapshot yet, because Ctrl-C must not wait
            if self._advance(chunk, scratch, tally):
                self._observe(block, y_buffer[:0], v_buffer[:0], tally)
            return
        if due == 0:  # the start of an ensemble
            y_buffer[0], v_buffer[0], good = self.y, self.v, 1
        else:
            state = self.y, self.v, self.noise, self.dynamics
            good, _ = record(*state, scratch, tally, due, y_buffer[:n], v_buffer[:n])
        self._observe(block, y_buffer[:good], v_buffer[:good], tally)
        self.counts[block] += good
        self.snapshots += good
        self.steps += good * due
        if good < n:
            self._diverge()

    def _block(self) -> tuple[int, int]:
        """Return the block of the next snapshot, and how many it still needs; make room for it."""
        if self.snapshots == self.run.blocks * self.length:
            self.length *= 2
            merge_pairs(self.counts)
            for observer in self.observers:
                observer.merge()
        block, taken = divmod(self.snapshots, self.length)
        return block, self.length - taken

    def _observe(self, block: int, y: Array, v: Array, tally: Tally) -> None:
        """Give snapshots of a block to the observers."""
        shared = y, v, tally.contacts.view()
        for array in shared:  # an observer that changed them would spoil what others measure
            array.flags.writeable = False
        snapshots = Snapshots(block, self.snapshots, self.copy, *shared)
        for observer in self.observers:
            observer.observe(snapshots)

    def _diverge(self) -> None:
        self.broken = self.patience[0] < NEVER
        if not self.broken:
            self.over, self.reached = True, min(self.reached, self.snapshots // self.length)


def make_replicas(run: Run) -> list[Replica]:
    """Distribute the replicas of a run over groups, each with observers of its own."""
    return [Replica(run, each) for each in np.array_split(np.arange(run.replicas), run.groups)]


def restore(owner: Any, name: str, value: NDArray[Any]) -> None:
    """Set an attribute to a restored value; an array stays an array, a number a number."""
    current = getattr(owner, name)
    if isinstance(current, np.ndarray):
        if current.shape != value.shape or current.dtype != value.dtype:
            raise ValueError(f"the checkpoint's {name} does not fit this run")
        current[...] = value  # in place: kernels write into the same array
    else:
        setattr(owner, name, type(current)(value))


def _aligned(values: Array) -> Array:
    """Return a copy that begins with a line of the cache; others slow a short chain by a third."""
    room = np.empty(values.size + _LINE - 1)
    first = -room.ctypes.data // room.itemsize % _LINE
    copy = room[first : first + values.size]
    copy[:] = values
    return copy
