"""The description of a run: the checked arguments of ``simulate`` that determine its numbers.

It is made once, before any work. Observers, kernels, checkpoints and the provenance read it.
"""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_choice, check_integer, check_real, is_list, shown
from crazybilliards.model.grid import require_resolved
from crazybilliards.model.memory import require_memory
from crazybilliards.particles import dynamics, scales
from crazybilliards.particles.dynamics import Dynamics, Stepper, default_merging, make_dynamics
from crazybilliards.particles.laws.law import EXACT, Method, choose_operator
from crazybilliards.particles.scales import start_swing, typical_speed
from crazybilliards.particles.schedule import Average, Schedule, make_schedule, too_short
from crazybilliards.particles.start import MOST_REPLICAS, replica_starts

_GROUPS = 32  # of an ensemble: enough for an error bar good to an eighth

# Measured peak memory: copies while observers are joined and averaged, and chunks of snapshots.
_COPIES = 7
_BYTES_PER_ROD = 200
_BYTES_PER_REPLICA = 10_000
_CHUNKS = 4e7


@dataclass(frozen=True, kw_only=True, eq=False)
class Run:
    """A checked run; its fields are the arguments of ``simulate``.

    Raises
    ------
    ValueError
        For a wrong argument, or if the run would not fit into memory: it takes 200 bytes a rod
        and 10 kB a replica, 40 MB for the snapshots under way, and seven times what the
        observers keep, while they are joined and averaged.
    """

    chain: Chain
    duration: float
    observers: tuple[Any, ...]  # an ``Observer`` reads the run, and its module stands on this one
    seed: int
    time_step: float | None
    merging: float | None
    particles: ArrayLike | None
    warmup: float | None = None
    method: Method = "event-driven"
    stepper: Stepper = "splitting"
    start: xr.Dataset | None = None
    replicas: int = 1
    average: Average = "time"
    every: float | None = None

    def __post_init__(self) -> None:
        for name, kinds in (("method", Method), ("stepper", Stepper), ("average", Average)):
            check_choice(name, getattr(self, name), get_args(kinds))
        self._require_known()
        merging = default_merging(self.chain) if self.merging is None else self.merging
        object.__setattr__(self, "merging", check_real("merging", merging))
        object.__setattr__(self, "seed", check_integer("seed", self.seed, least=0))
        replicas = check_integer("replicas", self.replicas, least=1, most=MOST_REPLICAS)
        object.__setattr__(self, "replicas", replicas)
        # Each of these properties checks its own arguments and raises if they are wrong.
        own = self.replicas * (_BYTES_PER_ROD * float(self.chain.size) + _BYTES_PER_REPLICA)
        require_memory(f"replicas={self.replicas} of {self.chain.size} rods", own + _CHUNKS)
        _check_observers(self)
        _ = self.chosen, self.schedule
        require_resolved(self.chain, float(self.chain.reduced_anchors[-1]))
        _ = self.starts
        kept = self.groups * sum(observer.memory(self) for observer in self.observers)
        names = ", ".join(observer.name for observer in self.observers)
        few = "ask for fewer particles, replicas or times"
        require_memory(f"observe ({few}): {names}", own + _CHUNKS + _COPIES * kept)

    def _require_known(self) -> None:
        """Raise a ValueError if anything that reads the chain does not know a parameter of it.

        The start refuses by itself, see :attr:`starts`.
        """
        if self.operator != EXACT:  # which refuses by itself, too
            self.chain.require_known("simulate (springs, damping and noise)", dynamics.knows)
        self.chain.require_known("simulate (its time scales)", scales.knows)
        for observer in self.observers:
            if observer.reads_chain:
                by = f"observe: {observer.name!r} (by knows and reads_chain of its class)"
                self.chain.require_known(by, observer.knows)

    @cached_property
    def schedule(self) -> Schedule:
        """The run in whole numbers of steps and snapshots."""
        return make_schedule(
            self.chain,
            duration=self.duration,
            warmup=self.warmup,
            time_step=self.time_step,
            every=self.every,
            average=self.average,
            replicas=self.replicas,
            stepper=self.stepper,
            exact=self.exact,
            started=self.start is not None,
            finest=min(observer.interval(self.chain) for observer in self.observers),
        )

    @cached_property
    def chosen(self) -> NDArray[np.int64]:
        """The particles to report, counted from 0."""
        size, particles = self.chain.size, self.particles
        if particles is None:
            return np.arange(size)
        if not is_list(particles):
            raise ValueError(f"particles must be a list of numbers, got {shown(particles)}")
        chosen = [check_integer("particles", particle, least=1) for particle in particles]
        if not chosen or max(chosen) > size or sorted(set(chosen)) != chosen:
            raise ValueError(f"particles must ascend within 1..{size}, got {shown(particles)}")
        return np.array(chosen) - 1

    @cached_property
    def starts(self) -> list[tuple[Array, Array]]:
        """Reduced positions and velocities at the start, one pair a replica."""
        return replica_starts(self.chain, self.start, self.replicas)

    @cached_property
    def swing(self) -> float:
        """Largest distance from its anchor that the energy of the start gives a rod [R]."""
        duration = self.schedule.warmup + self.schedule.duration
        return max(start_swing(self.chain, duration, y, v) for y, v in self.starts)

    def streams(self) -> list[np.random.SeedSequence]:
        """Return the random numbers of every replica; a given start is a part of their seed.

        Otherwise a run that continues another one would repeat its noise.
        """
        given = [] if self.start is None else list(self._digest_of_starts)
        return np.random.SeedSequence([self.seed, *given]).spawn(self.replicas)

    @cached_property
    def _digest_of_starts(self) -> bytes:
        states = (state.tobytes() for start in self.starts for state in start)
        return hashlib.sha256(b"".join(states)).digest()

    @property
    def groups(self) -> int:
        """Number of groups of replicas; those of a group share their observers."""
        return min(self.replicas, _GROUPS) if self.schedule.ensemble else self.replicas

    @property
    def copies(self) -> int:
        """Number of replicas in the largest group."""
        return -(-self.replicas // self.groups)

    @property
    def operator(self) -> int:
        """The operator that lets the rods of this run collide."""
        halves = self.stepper == "splitting"
        counted = {"counted": self.counted, "struck": self.struck}
        return choose_operator(self.chain, self.method, halves=halves, **counted)

    @property
    def exact(self) -> bool:
        """Whether every step is exact, whatever its length (``laws/exact_flight.py``)."""
        return self.operator == EXACT

    @property
    def flight(self) -> str:
        """How rods move between collisions: "exact", or "in steps" of kicks and drifts."""
        return "exact" if self.exact else "in steps"

    @property
    def counted(self) -> bool:
        """Whether an observer needs every single collision."""
        return any(observer.single_collisions for observer in self.observers)

    @property
    def struck(self) -> bool:
        """Whether an observer needs every impulse on a wall."""
        return any(observer.meets_walls for observer in self.observers)

    @property
    def too_short(self) -> str:
        """In what averages over time are too short for the memory of the chain, or nothing."""
        shared = all(observer.shares_time for observer in self.observers)
        if self.average != "time" or shared or self.stays_at_rest:
            return ""
        at_rest = self.start is None or self.start.attrs.get("source") == "start"
        warmup = self.schedule.warmup if self.warmup is None else float(self.warmup)
        return too_short(self.chain, float(self.duration), warmup, self.replicas, at_rest)

    @property
    def stays_at_rest(self) -> bool:
        """Whether there is neither noise nor a velocity nor a stretched spring."""
        if self.chain.amplitude > 0 or any(v.any() for _, v in self.starts):
            return False
        stretched = (np.abs(y - self.chain.reduced_anchors).max() for y, _ in self.starts)
        return self.chain.stiffness == 0 or max(stretched) <= 1e-9 * self.chain.radius

    def dynamics(self) -> Dynamics:
        """Return the numbers and arrays that the kernels need."""
        duration = self.schedule.warmup + self.schedule.duration
        return make_dynamics(
            self.chain,
            self.schedule.time_step,
            speed=max(typical_speed(self.chain, duration, y, v) for y, v in self.starts),
            method=self.method,
            stepper=self.stepper,
            merging=self.merging,
            counted=self.counted,
            struck=self.struck,
        )

    @property
    def vocabulary(self) -> dict[str, tuple[str, str]]:
        """Meanings and units that the observers bring; of what one gives, those that it says."""
        said = {name: said for each in self.observers for name, said in each.vocabulary.items()}
        for each in self.observers:
            given = {name.removesuffix("_error") for name in (*each.along, *each.gives)}
            said |= {name: own for name, own in each.vocabulary.items() if name in given}
        return said

    def provenance(self) -> dict[str, Any]:
        """Return everything except the chain that determines the numbers, in a form for JSON."""
        return {
            "method": self.method,
            "stepper": self.stepper,
            "merging": self.merging,
            "seed": self.seed,
            "replicas": self.replicas,
            "observe": [str(observer) for observer in self.observers],
            "particles": "all" if self.particles is None else (self.chosen + 1).tolist(),
            "start": "at rest" if self.start is None else f"sha256 {self._digest_of_starts.hex()}",
            "schedule": asdict(self.schedule),
        }


def _check_observers(run: Run) -> None:
    """Raise if an observer cannot work in this run, or if two report the same variable."""
    given: dict[str, Any] = {}
    for observer in run.observers:
        if run.chain.size < observer.least_rods:
            raise ValueError(
                f"observe: {observer.name!r} needs a chain of at least {observer.least_rods} rods"
            )
        if run.average == "ensemble" and not observer.ensemble:
            raise ValueError(
                f"observe: {observer.name!r} is averaged over time only, not over an ensemble"
            )
        if observer.meets_walls and not run.chain.box:
            raise ValueError(
                f"observe: {observer.name!r} needs a chain between walls, Chain(box=...)"
            )
        if (observer.single_collisions or observer.meets_walls) and run.method != "event-driven":
            raise ValueError(
                f"observe: {observer.name!r} needs single collisions, which only "
                "method='event-driven' sees"
            )
        # The times of an ensemble are the same for all observers.
        own = set(observer.along) - ({"time"} if run.average == "ensemble" else set())
        for name in sorted(own | set(observer.gives)):
            other = given.setdefault(name, observer)
            common = name == "time" and observer.shares_time and other.shares_time
            if other is not observer and not common:
                raise ValueError(
                    f"observe: {other.name!r} and {observer.name!r} would both give {name!r}; "
                    "take one of them"
                )
