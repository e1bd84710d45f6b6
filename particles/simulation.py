"""Running the chain: replicas in threads, chunks of snapshots to observers, one result."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from threading import Event
from typing import get_args

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.chain import check_integer, check_real
from crazybilliards.model.vocabulary import result
from crazybilliards.particles.checkpoint import Checkpoint, run_identity
from crazybilliards.particles.drift import Method, make_law
from crazybilliards.particles.observers import OBSERVERS, Variables
from crazybilliards.particles.replica import Dynamics, Replica, typical_speed
from crazybilliards.particles.running import announced, run_all
from crazybilliards.particles.schedule import Schedule, make_schedule
from crazybilliards.particles.start import replica_starts
from crazybilliards.particles.stepping import Stepper, make_step

Array = NDArray[np.float64]

_DIVERGED = 1e6  # typical speeds: the steady states of e > 1 stay within some tens of them


def simulate(
    chain: Chain,
    *,
    duration: float = 5000.0,
    warmup: float | None = None,
    time_step: float | None = None,
    method: Method = "event-driven",
    stepper: Stepper = "splitting",
    merging: float = 0.03,
    seed: int = 0,
    observe: Sequence[str] = ("widths", "density"),
    start: xr.Dataset | None = None,
    replicas: int = 1,
    threads: int | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_interval: float = 30.0,
    progress: bool = True,
) -> xr.Dataset:
    """Simulate the chain and return what was measured, with standard errors.

    Parameters
    ----------
    chain
        The chain, with any restitution.
    duration
        Time measured in each replica [T]; rounded up to whole blocks of snapshots. Good values
        are hundreds of relaxation times 2m/gamma (8.4 for the default chain).
    warmup
        Time before measuring [T]; None: 12 relaxation times, or 0 with a ``start``.
    time_step
        None: 0.05 of the fastest of spring and damping (0.1 for the default chain), off
        restitution 1 also short enough for the noise between collisions; see ``schedule``.
    method
        ``"event-driven"``: every collision in its order. ``"contact-dynamics"``: all contacts of
        a step at once, the paper's method; right only where a step sees few collisions.
    stepper
        ``"splitting"`` (second order in the time step) or ``"euler"`` (the paper's, first order).
    merging
        Restitution below 1: rods that would separate more slowly than this many velocity kicks
        of one step's noise move as one until the end of the step. 0.01 to 0.1 give the same.
    seed
        Integer >= 0. The same seed gives the same result to the last bit, whatever ``threads``.
    observe
        Any of ``"widths"`` (velocity_width, mean_displacement, displacement_width and the
        autocorrelation_time that tells whether warm-up and duration were long enough),
        ``"density"``, ``"velocities"`` (velocity_density), ``"energy"`` (kinetic_energy in time),
        ``"collisions"`` (collision_rate) and ``"avalanches"`` (avalanche_count).
    start
        A result with ``position`` and ``velocity`` over (replica, particle), such as
        ``equilibrium_states(chain, replicas)`` or ``given_start(chain, position)``; None: every
        rod at rest at its anchor.
    replicas
        Independent copies, averaged. ``threads`` of them (None: one per core) run at a time.
    checkpoint
        File to keep the state of the run in, written every ``checkpoint_interval`` seconds and
        at Ctrl-C or SIGTERM. The same call again goes on from there, to the same bits; a
        checkpoint of another run is refused.
    progress
        Show a progress bar with the time left, if standard error is a terminal.

    Returns
    -------
    xarray.Dataset
        In the common vocabulary. ``attrs["status"]`` is ``completed``, ``interrupted`` (Ctrl-C:
        everything measured until then) or ``diverged`` (everything before the chain blew up);
        ``attrs["end_time"]`` is the shortest time any replica reached, warm-up included. A chain
        that diverged before anything was measured (``warmup=0`` measures from the start) has no
        variables.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    KeyboardInterrupt
        On Ctrl-C before anything was measured.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> run = simulate(Chain(size=3), duration=500, progress=False)
    >>> run.velocity_width.dims, run.attrs["status"]
    (('particle',), 'completed')
    """
    for name, value, kinds in (("method", method, Method), ("stepper", stepper, Stepper)):
        if value not in get_args(kinds):
            raise ValueError(f"{name} must be one of {get_args(kinds)}, got {value!r}")
    merging = check_real("merging", merging)
    checkpoint_interval = check_real("checkpoint_interval", checkpoint_interval)
    seed = check_integer("seed", seed, least=0)
    replicas = check_integer("replicas", replicas, least=1)
    if threads is None:
        threads = _cores()
    threads = check_integer("threads", threads, least=1)
    names = _check_observers(observe)
    schedule = make_schedule(
        chain,
        duration=duration,
        warmup=warmup,
        time_step=time_step,
        replicas=replicas,
        started=start is not None,
    )
    starts = replica_starts(chain, start, replicas)
    single = {"collisions", "avalanches"} & set(names)
    if single and method != "event-driven":
        raise ValueError(f"observe: {min(single)!r} are only seen by method='event-driven'")
    counted = bool(single)
    dynamics = _dynamics(chain, schedule, method, stepper, merging, counted, starts)
    streams = np.random.SeedSequence(seed).spawn(replicas)
    runs = [
        _replica(chain, *state, stream, names, schedule)
        for state, stream in zip(starts, streams, strict=True)
    ]
    with announced(progress):
        _compile_kernels(names)
    keeper = None
    settings = {"method": method, "stepper": stepper, "merging": merging, "seed": seed}
    if checkpoint is not None:
        identity = run_identity(chain, asdict(schedule), settings, names, starts)
        keeper = Checkpoint(Path(checkpoint), identity, checkpoint_interval)
        keeper.resume(runs)
    interrupted = run_all(runs, dynamics, schedule, threads, keeper, progress)
    return _collect(chain, runs, schedule, settings, interrupted)


def _dynamics(
    chain: Chain,
    schedule: Schedule,
    method: Method,
    stepper: Stepper,
    merging: float,
    counted: bool,
    starts: list[tuple[Array, Array]],
) -> Dynamics:
    duration = schedule.warmup + schedule.duration
    speed = max(typical_speed(chain, duration, y, v) for y, v in starts)
    return Dynamics(
        chain.reduced_anchors,
        make_step(chain, schedule.time_step, stepper),
        make_law(chain, schedule.time_step, method, merging, speed, counted=counted),
        _DIVERGED * speed if speed > 0 else np.inf,
    )


def _replica(
    chain: Chain,
    y: Array,
    v: Array,
    stream: np.random.SeedSequence,
    names: list[str],
    schedule: Schedule,
) -> Replica:
    return Replica(
        y,
        v,
        np.random.Generator(np.random.PCG64(stream)),
        [OBSERVERS[name](chain, schedule) for name in names],
        np.zeros(schedule.blocks, dtype=np.int64),
    )


def _compile_kernels(names: list[str]) -> None:
    """Compile every kernel, or load it from numba's cache, by running a chain of two rods."""
    chain = Chain(size=2)
    schedule = Schedule(0.1, warmup_steps=1, stride=1, blocks=1, snapshots_per_block=1)
    starts = replica_starts(chain, None, 1)
    replica = _replica(chain, *starts[0], np.random.SeedSequence(0), names, schedule)
    dynamics = _dynamics(chain, schedule, "event-driven", "splitting", 0.03, True, starts)
    for _ in replica.run(dynamics, schedule, Event()):
        pass


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _check_observers(observe: Sequence[str]) -> list[str]:
    names = [observe] if isinstance(observe, str) else list(observe)
    for name in names:
        if name not in OBSERVERS:
            raise ValueError(f"observe takes any of {sorted(OBSERVERS)}, got {name!r}")
    if not names:
        raise ValueError(f"observe must name at least one of {sorted(OBSERVERS)}")
    return list(dict.fromkeys(names))


def _collect(
    chain: Chain,
    runs: list[Replica],
    schedule: Schedule,
    settings: Mapping[str, str | int | float],
    interrupted: bool,
) -> xr.Dataset:
    """Join the replicas' measurements into one result."""
    counts = np.concatenate([run.counts for run in runs])
    diverged = any(run.diverged for run in runs)
    if interrupted and counts.sum() == 0:
        raise KeyboardInterrupt("nothing was measured yet")
    variables: Variables = {}
    coordinates: dict[str, Array] = {}
    # A chain that diverged before its first snapshot has a status and a time, but no averages.
    observed = zip(*(run.observers for run in runs), strict=True) if counts.sum() else ()
    for first, *others in observed:
        first.join(others)
        variables |= first.report(counts)
        coordinates |= first.coordinates()
    return result(
        chain,
        variables,
        coordinates=coordinates,
        source="simulation",
        status="interrupted" if interrupted else "diverged" if diverged else "completed",
        end_time=min(run.steps for run in runs) * schedule.time_step,
        method={
            **settings,
            "replicas": len(runs),
            "schedule": asdict(schedule),
            "duration": schedule.duration,
            "snapshots": int(counts.sum()),
        },
    )
