"""Running the chain: replicas in threads, chunks of snapshots to observers, one result."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import asdict
from threading import Event, Timer
from typing import get_args

import numpy as np
import xarray as xr
from crazybilliards.model import Chain
from crazybilliards.model.chain import check_integer
from crazybilliards.model.vocabulary import result
from crazybilliards.particles.observers import OBSERVERS, Variables
from crazybilliards.particles.replica import Replica, replica_starts
from crazybilliards.particles.schedule import Schedule, make_schedule
from crazybilliards.particles.stepping import Step, Stepper, make_step
from numpy.typing import NDArray
from tqdm import tqdm

Array = NDArray[np.float64]


def simulate(
    chain: Chain,
    *,
    duration: float = 5000.0,
    warmup: float | None = None,
    time_step: float | None = None,
    stepper: Stepper = "splitting",
    seed: int = 0,
    observe: Sequence[str] = ("widths", "density"),
    start: xr.Dataset | None = None,
    replicas: int = 1,
    threads: int | None = None,
    progress: bool = True,
) -> xr.Dataset:
    """Simulate the chain and return what was measured, with standard errors.

    Parameters
    ----------
    chain
        The chain; this version simulates ``restitution=1``.
    duration
        Time measured in each replica [T]; rounded up to whole blocks of snapshots. Good values
        are hundreds of relaxation times 2m/gamma (8.4 for the default chain).
    warmup
        Time before measuring [T]; None: 12 relaxation times, or 0 with a ``start``.
    time_step
        None: 0.05 of the fastest of spring and damping (0.1 for the default chain).
    stepper
        ``"splitting"`` (second order in the time step) or ``"euler"`` (the paper's, first order).
    seed
        Integer >= 0. The same seed gives the same result to the last bit, whatever ``threads``.
    observe
        Any of ``"widths"`` (velocity_width, mean_displacement, displacement_width) and
        ``"density"``.
    start
        A result with ``position`` and ``velocity`` over (replica, particle), such as
        ``equilibrium_states(chain, replicas)``; None: every rod at rest at its anchor.
    replicas
        Independent copies, averaged. ``threads`` of them (None: one per core) run at a time.
    progress
        Show a progress bar with the time left, if standard error is a terminal.

    Returns
    -------
    xarray.Dataset
        In the common vocabulary. ``attrs["status"]`` is ``completed``, ``interrupted`` (Ctrl-C:
        everything measured until then) or ``diverged`` (everything before the chain blew up);
        ``attrs["end_time"]`` is the shortest time any replica reached, warm-up included.

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
    if chain.restitution != 1:
        raise ValueError(f"restitution must be 1 in this version, got {chain.restitution:g}")
    if stepper not in get_args(Stepper):
        raise ValueError(f"stepper must be one of {get_args(Stepper)}, got {stepper!r}")
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
    streams = np.random.SeedSequence(seed).spawn(replicas)
    step = make_step(chain, schedule.time_step, stepper)
    runs = [
        Replica(
            chain.reduced_anchors,
            *starts[replica],
            np.random.Generator(np.random.PCG64(streams[replica])),
            [OBSERVERS[name](chain, schedule.blocks) for name in names],
            np.zeros(schedule.blocks, dtype=np.int64),
        )
        for replica in range(replicas)
    ]
    with _announced(progress):
        _compile_kernels(names)
    interrupted = _run_all(runs, step, schedule, threads, progress)
    return _collect(chain, runs, names, schedule, stepper, seed, interrupted)


def _run_all(
    runs: list[Replica], step: Step, schedule: Schedule, threads: int, progress: bool
) -> bool:
    """Run the replicas in threads; return whether Ctrl-C stopped them."""
    stop = Event()
    total = (schedule.warmup + schedule.duration) * len(runs)
    with (
        tqdm(
            total=total,
            desc="simulating",
            unit=" time units",
            unit_scale=True,
            disable=None if progress else True,
        ) as bar,
        ThreadPoolExecutor(min(threads, len(runs))) as pool,
    ):

        def work(replica: Replica) -> None:
            for steps in replica.run(step, schedule, stop):
                bar.update(steps * schedule.time_step)

        futures = [pool.submit(work, replica) for replica in runs]
        try:
            _finish(futures)
        except BaseException as error:
            stop.set()
            if not isinstance(error, KeyboardInterrupt):
                raise
            _finish(futures)
            return True
    return False


def _finish(futures: list[Future[None]]) -> None:
    """Wait for all, or for the first that fails; look at Ctrl-C twice a second."""
    while True:
        done, pending = wait(futures, timeout=0.5, return_when=FIRST_EXCEPTION)
        for future in done:
            future.result()
        if not pending:
            return


@contextmanager
def _announced(progress: bool) -> Iterator[None]:
    """Say that kernels are being compiled, if it takes long enough to wonder."""
    message = "crazybilliards: compiling the kernels, once (they are cached) ..."
    timer = Timer(0.7, lambda: print(message, file=sys.stderr, flush=True))
    if progress:
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _compile_kernels(names: list[str]) -> None:
    """Compile every kernel, or load it from numba's cache, by running a chain of two rods."""
    chain = Chain(size=2)
    schedule = Schedule(0.1, warmup_steps=1, stride=1, blocks=1, snapshots_per_block=1)
    observers = [OBSERVERS[name](chain, schedule.blocks) for name in names]
    generator = np.random.Generator(np.random.PCG64(0))
    y, v = np.zeros((2, chain.size))
    replica = Replica(
        chain.reduced_anchors, y, v, generator, observers, np.zeros(1, dtype=np.int64)
    )
    for _ in replica.run(make_step(chain, schedule.time_step, "splitting"), schedule, Event()):
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
    names: list[str],
    schedule: Schedule,
    stepper: str,
    seed: int,
    interrupted: bool,
) -> xr.Dataset:
    counts = np.concatenate([run.counts for run in runs])
    diverged = any(run.diverged for run in runs)
    if counts.sum() == 0:
        if interrupted:
            raise KeyboardInterrupt("nothing was measured yet")
        raise ValueError("the chain diverged before anything was measured; lower time_step")
    variables: Variables = {}
    for index in range(len(names)):
        first, *others = (run.observers[index] for run in runs)
        first.join(others)
        variables |= first.report(counts)
    grids = [observer.x for observer in runs[0].observers if observer.x is not None]
    return result(
        chain,
        variables,
        x=grids[0] if grids else None,
        source="simulation",
        status="interrupted" if interrupted else "diverged" if diverged else "completed",
        end_time=min(run.steps for run in runs) * schedule.time_step,
        method={
            "stepper": stepper,
            "seed": seed,
            "replicas": len(runs),
            "schedule": asdict(schedule),
            "duration": schedule.duration,
            "snapshots": int(counts.sum()),
        },
    )
