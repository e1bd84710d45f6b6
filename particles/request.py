"""What a run is asked for: every argument checked, and the plan made, before any work."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple, get_args

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.checks import check_choice, check_integer, check_real, shown
from crazybilliards.model.grid import require_resolved
from crazybilliards.model.memory import require_memory
from crazybilliards.particles.laws.law import Method
from crazybilliards.particles.observers import OBSERVERS, Plan
from crazybilliards.particles.scales import start_swing
from crazybilliards.particles.schedule import Average, Schedule, make_schedule
from crazybilliards.particles.start import replica_starts
from crazybilliards.particles.stepping import Stepper

Array = NDArray[np.float64]

_GROUPS = 32  # of an ensemble: enough for an error bar good to an eighth

# Peak memory, measured: observers are joined and averaged in copies; chunks of snapshots.
_COPIES = 7
_BYTES_PER_ROD = 100
_BYTES_PER_REPLICA = 10_000
_CHUNKS = 4e7


class Request(NamedTuple):
    """A run that can be carried out: everything its numbers follow from."""

    chain: Chain
    schedule: Schedule
    observe: list[str]
    plan: Plan  # for the observers of one replica, or of one group of an ensemble's
    groups: int  # of replicas that share observers
    starts: list[tuple[Array, Array]]  # reduced positions and velocities, one a replica
    settings: dict[str, Any]  # method, stepper, merging, seed

    @property
    def counted(self) -> bool:
        """Whether single collisions are counted."""
        return bool({"collisions", "avalanches"} & set(self.observe))


def make_request(
    chain: Chain,
    *,
    duration: float,
    warmup: float | None,
    time_step: float | None,
    method: Method,
    stepper: Stepper,
    merging: float,
    seed: int,
    observe: Sequence[str],
    start: xr.Dataset | None,
    particles: Sequence[int] | None,
    replicas: int,
    average: Average,
    every: float | None,
) -> Request:
    """Check the arguments of ``simulate`` that its numbers follow from.

    Raises
    ------
    ValueError
        For a wrong argument, or if the run would not fit into memory: it takes 100 bytes a rod
        and 10 kB a replica, 40 MB for the snapshots under way, and seven times what the
        observers keep, while they are joined and averaged.
    """
    for name, value, kinds in (
        ("method", method, Method),
        ("stepper", stepper, Stepper),
        ("average", average, Average),
    ):
        check_choice(name, value, get_args(kinds))
    settings = {
        "method": method,
        "stepper": stepper,
        "merging": check_real("merging", merging),
        "seed": check_integer("seed", seed, least=0),
    }
    replicas = check_integer("replicas", replicas, least=1)
    own = replicas * (_BYTES_PER_ROD * float(chain.size) + _BYTES_PER_REPLICA) + _CHUNKS
    require_memory(f"replicas={replicas} of {chain.size} rods", own)
    names = _check_observers(observe, method, average)
    chosen = _check_particles(particles, chain)
    schedule = make_schedule(
        chain,
        duration=duration,
        warmup=warmup,
        time_step=time_step,
        every=every,
        average=average,
        replicas=replicas,
        stepper=stepper,
        started=start is not None,
    )
    require_resolved(chain, float(chain.reduced_anchors[-1]))
    starts = replica_starts(chain, start, replicas)
    groups = min(replicas, _GROUPS) if schedule.ensemble else replicas
    swing = max(start_swing(chain, y, v) for y, v in starts)
    plan = Plan(chain, schedule, chosen, swing, copies=-(-replicas // groups))
    kept = groups * sum(OBSERVERS[name].memory(plan) for name in names)
    few = "ask for fewer particles, replicas or times"
    require_memory(f"observe ({few}): {', '.join(names)}", own + _COPIES * kept)
    return Request(chain, schedule, names, plan, groups, starts, settings)


def _check_observers(observe: Sequence[str], method: Method, average: Average) -> list[str]:
    if isinstance(observe, str):
        observe = [observe]
    elif not isinstance(observe, Collection):
        raise ValueError(f"observe takes a list of {sorted(OBSERVERS)}, got {shown(observe)}")
    for name in observe:
        if not isinstance(name, str) or name not in OBSERVERS:
            raise ValueError(f"observe takes any of {sorted(OBSERVERS)}, got {shown(name)}")
        if average == "ensemble" and not OBSERVERS[name].ensemble:
            able = sorted(name for name, observer in OBSERVERS.items() if observer.ensemble)
            raise ValueError(f"observe takes any of {able} for an ensemble, got {name!r}")
    names = list(dict.fromkeys(observe))
    if not names:
        raise ValueError(f"observe must name at least one of {sorted(OBSERVERS)}")
    single = {"collisions", "avalanches"} & set(names)
    if single and method != "event-driven":
        raise ValueError(f"observe: {min(single)!r} are only seen by method='event-driven'")
    # Both would be called velocity, or have other times.
    clash = {"velocities"} | ({"energy"} if average == "time" else set())
    if "snapshots" in names and clash & set(names):
        raise ValueError(f"observe: take {min(clash & set(names))!r} from the 'snapshots' or alone")
    return names


def _check_particles(particles: Sequence[int] | None, chain: Chain) -> NDArray[np.int64]:
    """Return the chosen particles, counted from 0."""
    if particles is None:
        return np.arange(chain.size)
    if isinstance(particles, str) or not isinstance(particles, Collection):
        raise ValueError(f"particles must be a list of numbers, got {shown(particles)}")
    chosen = [check_integer("particles", particle, least=1) for particle in particles]
    if not chosen or max(chosen) > chain.size or sorted(set(chosen)) != chosen:
        raise ValueError(f"particles must ascend within 1..{chain.size}, got {shown(particles)}")
    return np.array(chosen) - 1
