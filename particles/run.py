"""The description of a run: the checked arguments of ``simulate`` that determine its numbers.

It is made once, before any work, and counts the run in whole steps, snapshots and blocks.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import (
    check_chain,
    check_choice,
    check_integer,
    check_real,
    is_list,
    require_memory,
    shown,
)
from crazybilliards.model.grid import require_resolved
from crazybilliards.particles import dynamics, scales
from crazybilliards.particles.dynamics import Dynamics, Stepper, default_merging, make_dynamics
from crazybilliards.particles.laws.law import EXACT, Method, choose_operator
from crazybilliards.particles.scales import start_swing, typical_speed
from crazybilliards.particles.start import MOST_REPLICAS, digest, replica_starts
from crazybilliards.particles.timing import choose_step, count_blocks, default_warmup, too_short

_GROUPS = 32  # of an ensemble: enough for an error bar good to an eighth
_OUTPUTS = 100  # times of an ensemble, unless ``every`` is given

# Measured peak memory: copies of sums while they are joined and averaged, and bytes of the rest.
_COPIES = 7
_ROD, _REPLICA, _CHUNKS = 200.0, 10_000, 4e7

Average = Literal["time", "ensemble"]


@dataclass(kw_only=True, eq=False)
class Run:
    """A checked run: steps of warm-up, then snapshots ``stride`` steps apart.

    The snapshots are counted in up to ``blocks`` blocks, the first ones of ``block`` snapshots
    each. In an ensemble every block is one snapshot, at one output time, the first after the
    warm-up. The other fields are the arguments of ``simulate``. Where these are None, or no whole
    number of steps, the run chooses or rounds them. A run takes 200 bytes a rod and 10 kB a
    replica, 40 MB for the snapshots under way, and seven times what the observers keep, while they
    are joined and averaged; it is a ValueError if this does not fit into memory.
    """

    chain: Chain
    observers: tuple[Any, ...]  # an ``Observer`` reads the run, and its module stands on this one
    duration: float
    warmup: float
    time_step: float
    every: float
    method: Method
    stepper: Stepper
    merging: float
    seed: int
    particles: ArrayLike | None
    replicas: int
    average: Average
    start: xr.Dataset | None = None
    warmup_steps: int = field(init=False)
    stride: int = field(init=False)
    snapshots: int = field(init=False)  # of each replica
    blocks: int = field(init=False)
    block: int = field(init=False)
    # In what it is too short for an average over time.
    too_short: str = field(init=False, default="")

    def __post_init__(self) -> None:
        for name, kinds in (("method", Method), ("stepper", Stepper), ("average", Average)):
            check_choice(name, getattr(self, name), get_args(kinds))
        check_chain(self.chain)
        if not self.exact:  # which refuses by itself what it does not know, as the start does
            self.chain.require_known("simulate (springs, damping and noise)", dynamics.knows)
        self.chain.require_known("simulate (its time scales)", scales.knows)
        for observer in self.observers:
            if observer.reads_chain:
                by = f"observe: {observer.name!r} (by knows and reads_chain of its class)"
                self.chain.require_known(by, observer.knows)
        merging = default_merging(self.chain) if self.merging is None else self.merging
        self.merging = check_real("merging", merging)
        self.seed = check_integer("seed", self.seed, least=0)
        self.replicas = check_integer("replicas", self.replicas, least=1, most=MOST_REPLICAS)
        rest = self.replicas * (_ROD * self.chain.size + _REPLICA) + _CHUNKS
        require_memory(f"replicas={self.replicas} of {self.chain.size} rods", rest)
        _ = self.chosen, self.starts
        self._count_steps()
        require_resolved(self.chain, float(self.chain.reduced_anchors[-1]))
        sums = self.groups * sum(observer.memory(self) for observer in self.observers)
        names = ", ".join(observer.name for observer in self.observers)
        require_memory(
            "observe (ask for less, such as 'widths' alone, or fewer particles, replicas or times)"
            f": {names}",
            rest + _COPIES * sums,
        )

    def _count_steps(self) -> None:
        """Check the times, choose those that are not given, and count steps and snapshots."""
        duration = check_real("duration", self.duration, positive=True)
        every = duration / _OUTPUTS if self.every is None and self.ensemble else self.every
        warmup = self.warmup
        if warmup is None:
            no_warmup = self.ensemble or self.start is not None
            warmup = 0.0 if no_warmup else default_warmup(self.chain)
        warmup = check_real("warmup", warmup)
        self.time_step, self.stride = choose_step(
            self.chain,
            self.time_step,
            every,
            warmup,
            duration,
            stepper=self.stepper,
            exact=self.exact,
            crossing=self._crossing_time(),
            finest=min(observer.interval(self.chain) for observer in self.observers),
        )
        self.every = self.stride * self.time_step
        self.warmup_steps = math.ceil(warmup / self.time_step - 1e-9)
        if self.ensemble:
            intervals = duration / self.every
            if intervals < 1 - 1e-9:
                raise ValueError(f"every must be at most the duration {duration:g}, got {every:g}")
            self.snapshots = self.blocks = math.ceil(intervals - 1e-9) + 1
            self.block = 1
        else:
            self.snapshots, self.blocks, self.block = count_blocks(
                self.chain, duration, self.every, self.replicas
            )
        at_rest = self.start is None or self.start.attrs.get("source") == "start"
        timed = self.ensemble or all(observer.shares_time for observer in self.observers)
        if not timed:
            self.too_short = too_short(self.chain, duration, warmup, self.replicas, at_rest)
        self.warmup = self.warmup_steps * self.time_step
        self.duration = (self.snapshots - self.ensemble) * self.stride * self.time_step

    def _crossing_time(self) -> float:
        """Time in which rods without springs, damping and noise cross a mean room; else inf."""
        chain, speed = self.chain, max(float(np.sqrt(np.mean(v**2))) for _, v in self.starts)
        free = chain.stiffness == chain.damping == chain.amplitude == 0 < speed
        if not free or self.method != "event-driven":
            return math.inf
        apart = 2 * chain.walls[1] if chain.box else max(np.ptp(y) for y, _ in self.starts)
        return float(apart or chain.radius) / (chain.size * speed)

    @property
    def ensemble(self) -> bool:
        """Whether averages are over the replicas at equal times."""
        return self.average == "ensemble"

    @property
    def steps(self) -> int:
        """Steps that a replica takes, warm-up included."""
        return self.step_of(self.snapshots - 1)

    def step_of(self, snapshot: int) -> int:
        """Return the number of steps before a snapshot, which is counted from 0."""
        return self.warmup_steps + (snapshot + (not self.ensemble)) * self.stride

    @property
    def times(self) -> Array:
        """Time of every snapshot of a replica, shape (snapshots,)."""
        return self.time(np.arange(float(self.snapshots)))

    def time(self, snapshot: Any) -> Any:
        """Time of snapshots by their numbers from 0; a half number is the middle of two."""
        return self.warmup + (snapshot + (not self.ensemble)) * self.every

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

    @property
    def stays_at_rest(self) -> bool:
        """Whether there is neither noise nor a velocity nor a stretched spring."""
        if self.chain.amplitude > 0 or any(v.any() for _, v in self.starts):
            return False
        stretched = (np.abs(y - self.chain.reduced_anchors).max() for y, _ in self.starts)
        return self.chain.stiffness == 0 or max(stretched) <= 1e-9 * self.chain.radius

    @cached_property
    def swing(self) -> float:
        """Largest distance from its anchor that the energy of the start gives a rod [R]."""
        return max(
            start_swing(self.chain, self.warmup + self.duration, *one) for one in self.starts
        )

    @cached_property
    def fastest_start(self) -> float:
        """Upper estimate of the speed that noise and the start's energy give a rod [R/t_0]."""
        return max(
            typical_speed(self.chain, self.warmup + self.duration, *one) for one in self.starts
        )

    @cached_property
    def streams(self) -> list[np.random.SeedSequence]:
        """The random numbers of every replica. One that continues another must not repeat them."""
        start = [] if self.start is None else list(digest(self.starts))
        return np.random.SeedSequence([self.seed, *start]).spawn(self.replicas)

    @property
    def groups(self) -> int:
        """Number of groups of replicas; those of a group share their observers."""
        return min(self.replicas, _GROUPS) if self.ensemble else self.replicas

    @property
    def operator(self) -> int:
        """The operator that lets the rods of this run collide."""
        halves = self.stepper == "splitting"
        return choose_operator(self.chain, self.method, halves=halves, **self.recorded)

    @property
    def exact(self) -> bool:
        """Whether every step is exact, whatever its length (``laws/exact_flight.py``)."""
        return self.operator == EXACT

    @property
    def recorded(self) -> dict[str, bool]:
        """Whether observers need every single collision, and every impulse on a wall."""
        return {
            "counted": any(observer.single_collisions for observer in self.observers),
            "struck": any(observer.meets_walls for observer in self.observers),
        }

    @cached_property
    def dynamics(self) -> Dynamics:
        """The numbers and arrays that the kernels need."""
        return make_dynamics(
            self.chain,
            self.time_step,
            speed=self.fastest_start,
            method=self.method,
            stepper=self.stepper,
            merging=self.merging,
            **self.recorded,
        )

    @property
    def provenance(self) -> dict[str, Any]:
        """Everything except the chain that determines the numbers, in a form for JSON."""
        same = ("method", "stepper", "merging", "seed", "replicas")
        steps = ("time_step", "warmup_steps", "stride", "blocks", "snapshots", "block", "ensemble")
        return {
            **{name: getattr(self, name) for name in same},
            "observe": [str(observer) for observer in self.observers],
            "particles": "all" if self.particles is None else (self.chosen + 1).tolist(),
            "start": "at rest" if self.start is None else f"sha256 {digest(self.starts).hex()}",
            "schedule": {name: getattr(self, name) for name in steps},
        }

    @property
    def attributes(self) -> dict[str, Any]:
        """What a result says of its run beside the provenance."""
        return {
            "flight": "exact" if self.exact else "in steps",
            "relaxation_time": scales.relaxation_time(self.chain),
        }
