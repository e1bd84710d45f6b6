"""What a run is asked for: every argument checked, and the plan made, before any work."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, get_args

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.chain import check_integer, check_real
from crazybilliards.particles.drift import Method
from crazybilliards.particles.observers import OBSERVERS, Plan
from crazybilliards.particles.replica import start_swing
from crazybilliards.particles.schedule import Average, Schedule, make_schedule
from crazybilliards.particles.start import replica_starts
from crazybilliards.particles.stepping import Stepper

Array = NDArray[np.float64]

_GROUPS = 32  # of an ensemble: enough for an error bar good to an eighth
_MOST_BYTES = 8e9


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
        For a wrong argument, or if the measurements would not fit into memory.
    """
    for name, value, kinds in (
        ("method", method, Method),
        ("stepper", stepper, Stepper),
        ("average", average, Average),
    ):
        if value not in get_args(kinds):
            raise ValueError(f"{name} must be one of {get_args(kinds)}, got {value!r}")
    settings = {
        "method": method,
        "stepper": stepper,
        "merging": check_real("merging", merging),
        "seed": check_integer("seed", seed, least=0),
    }
    replicas = check_integer("replicas", replicas, least=1)
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
        started=start is not None,
    )
    starts = replica_starts(chain, start, replicas)
    groups = min(replicas, _GROUPS) if schedule.ensemble else replicas
    swing = max(start_swing(chain, y, v) for y, v in starts)
    plan = Plan(chain, schedule, chosen, swing, copies=-(-replicas // groups))
    needed = groups * sum(OBSERVERS[name].memory(plan) for name in names)
    if needed > _MOST_BYTES:
        raise ValueError(
            f"observe: {', '.join(names)} would take {needed / 1e9:.0f} GB; ask for fewer "
            "particles, replicas or times"
        )
    return Request(chain, schedule, names, plan, groups, starts, settings)


def _check_observers(observe: Sequence[str], method: Method, average: Average) -> list[str]:
    names = [observe] if isinstance(observe, str) else list(dict.fromkeys(observe))
    for name in names:
        if name not in OBSERVERS:
            raise ValueError(f"observe takes any of {sorted(OBSERVERS)}, got {name!r}")
        if average == "ensemble" and not OBSERVERS[name].ensemble:
            able = sorted(name for name, observer in OBSERVERS.items() if observer.ensemble)
            raise ValueError(f"observe takes any of {able} for an ensemble, got {name!r}")
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
    chosen = [check_integer("particles", particle, least=1) for particle in particles]
    if not chosen or max(chosen) > chain.size or sorted(set(chosen)) != chosen:
        raise ValueError(f"particles must ascend within 1..{chain.size}, got {particles!r}")
    return np.array(chosen) - 1
