"""Running the chain: replicas in threads, chunks of snapshots to observers, one result."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from threading import Event

import numpy as np
import xarray as xr

from crazybilliards.model import Chain
from crazybilliards.model.checks import check_integer, check_real
from crazybilliards.model.process import announced, cores
from crazybilliards.particles.laws.law import Method, make_law
from crazybilliards.particles.observers import OBSERVERS, Plan
from crazybilliards.particles.request import Request, make_request
from crazybilliards.particles.running.checkpoint import Checkpoint, run_identity
from crazybilliards.particles.running.collecting import collect
from crazybilliards.particles.running.replica import Dynamics, Replica
from crazybilliards.particles.running.threads import run_all
from crazybilliards.particles.scales import typical_speed
from crazybilliards.particles.schedule import Average, Schedule
from crazybilliards.particles.start import replica_starts
from crazybilliards.particles.stepping import Stepper, make_step

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
    particles: Sequence[int] | None = None,
    replicas: int = 1,
    average: Average = "time",
    every: float | None = None,
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
        Time before measuring [T]; None: 12 relaxation times, or 0 with a ``start`` and for an
        ensemble.
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
        Any of ``"widths"`` (velocity_width, mean_velocity, mean_displacement, displacement_width
        and the autocorrelation_time that tells whether warm-up and duration were long enough),
        ``"density"``, ``"velocities"`` (velocity_density), ``"energy"`` (kinetic_energy in time),
        ``"collisions"`` (collision_rate), ``"avalanches"`` (avalanche_count) and ``"snapshots"``
        (position and velocity as they are).
    start
        A result with ``position`` and ``velocity`` over (replica, particle), such as
        ``equilibrium_states(chain, replicas)`` or ``given_start(chain, position)``; None: every
        rod at rest at its anchor.
    particles
        Numbers, from 1, of the particles to report; None: all. Velocity distributions and
        snapshots of a long chain take much memory.
    replicas
        Independent copies, averaged. ``threads`` of them (None: one per core) run at a time.
    average
        ``"time"``: over the duration, for steady states. ``"ensemble"``: over the replicas at
        equal times, for relaxation: widths, density, energy over (time, ...), the first time
        being the start. Errors are then those of 32 groups of replicas.
    every
        Time between snapshots [T]; None: 10 steps, for an ensemble a hundredth of the duration.
        The time step is shortened to a whole fraction of it.
    checkpoint
        File to keep the state of the run in, written every ``checkpoint_interval`` seconds and
        at Ctrl-C or SIGTERM. The same call again goes on from there, to the same bits; a
        checkpoint of another run, or one that another process is keeping, is refused.
    progress
        Show a progress bar with the time left, if standard error is a terminal.

    Returns
    -------
    xarray.Dataset
        In the common vocabulary. ``attrs["status"]`` is ``completed``, ``interrupted`` (Ctrl-C:
        everything measured until then) or ``diverged`` (everything before the chain blew up);
        ``attrs["end_time"]`` is the shortest time any replica reached, warm-up included, for an
        ensemble the last time reported. A chain that diverged before anything was measured
        (``warmup=0`` measures from the start) has no variables. Off restitution 1
        ``attrs["time_step_error"]`` estimates the relative error of the smallest velocity width
        that the time step causes.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    OSError
        If the checkpoint cannot be written, before any work. Later on that is a warning.
    KeyboardInterrupt
        On Ctrl-C before anything was measured.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> run = simulate(Chain(size=3), duration=500, progress=False)
    >>> run.velocity_width.dims, run.attrs["status"]
    (('particle',), 'completed')
    """
    checkpoint_interval = check_real("checkpoint_interval", checkpoint_interval)
    threads = check_integer("threads", cores() if threads is None else threads, least=1)
    request = make_request(
        chain,
        duration=duration,
        warmup=warmup,
        time_step=time_step,
        method=method,
        stepper=stepper,
        merging=merging,
        seed=seed,
        observe=observe,
        start=start,
        particles=particles,
        replicas=replicas,
        average=average,
        every=every,
    )
    schedule = request.schedule
    dynamics, runs = _dynamics(request), _replicas(request)
    with announced(progress):
        _compile_kernels(request.observe)
    keeper = None
    if checkpoint is not None:
        keeper = Checkpoint(Path(checkpoint), run_identity(request), checkpoint_interval)
    with nullcontext() if keeper is None else keeper.resumed(runs):
        interrupted = run_all(runs, dynamics, schedule, threads, keeper, progress)
    return collect(request, runs, interrupted)


def _dynamics(request: Request) -> Dynamics:
    chain, schedule, settings = request.chain, request.schedule, request.settings
    duration = schedule.warmup + schedule.duration
    speed = max(typical_speed(chain, duration, y, v) for y, v in request.starts)
    return Dynamics(
        chain.reduced_anchors,
        make_step(chain, schedule.time_step, settings["stepper"]),
        make_law(
            chain,
            schedule.time_step,
            settings["method"],
            settings["merging"],
            speed,
            counted=request.counted,
        ),
        _DIVERGED * speed if speed > 0 else np.inf,
    )


def _replicas(request: Request) -> list[Replica]:
    """Deal the replicas out to groups, each with observers of its own."""
    starts = request.starts
    streams = np.random.SeedSequence(request.settings["seed"]).spawn(len(starts))
    runs: list[Replica] = []
    for members in np.array_split(np.arange(len(starts)), request.groups):
        own = request.plan._replace(copies=members.size)
        observers = [OBSERVERS[name](own) for name in request.observe]
        counts = np.zeros(request.schedule.blocks, dtype=np.int64)
        mine = [starts[i] for i in members], [streams[i] for i in members]
        runs.append(Replica(*mine, observers, counts))
    return runs


def _compile_kernels(names: list[str]) -> None:
    """Compile every kernel, or load it from numba's cache, by running a chain of two rods."""
    chain = Chain(size=2)
    schedule = Schedule(0.1, warmup_steps=1, stride=1, blocks=1, snapshots_per_block=1)
    settings = {"method": "event-driven", "stepper": "splitting", "merging": 0.03, "seed": 0}
    plan = Plan(chain, schedule, np.arange(2), swing=0.0, copies=1)
    starts = replica_starts(chain, None, 1)
    request = Request(chain, schedule, names, plan, 1, starts, settings)
    # Counting collisions compiles the heap, and with it all that the other operators need.
    dynamics = _dynamics(request._replace(observe=["collisions"]))
    [replica] = _replicas(request)
    for _ in replica.run(dynamics, schedule, Event()):
        pass
