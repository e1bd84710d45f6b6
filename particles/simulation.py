"""Running the chain: replicas in threads, chunks of snapshots to observers, one result."""

import os
from collections.abc import Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from contextlib import nullcontext
from signal import SIGINT
from threading import Event
from typing import Any

import xarray as xr
from loky import cpu_count
from numpy.typing import ArrayLike

from crazybilliards.model import Chain
from crazybilliards.model.checks import check_integer, check_path, check_real, with_hints
from crazybilliards.model.kernels import announced
from crazybilliards.model.process import interrupts_noted
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.model.warn import warn_user
from crazybilliards.particles.dynamics import Stepper
from crazybilliards.particles.laws.law import Method
from crazybilliards.particles.observers import Observer, check_observers, find_observers
from crazybilliards.particles.run import Average, Run
from crazybilliards.particles.running.checkpoint import Checkpoint
from crazybilliards.particles.running.collecting import collect
from crazybilliards.particles.running.replica import Replica, make_replicas
from crazybilliards.particles.stepping import compile_kernels

# Collisions of each rod after which a step is given up at Ctrl-C; others take seconds in all.
_PATIENCE = 64


class ShortRunWarning(UserWarning):
    """An average over time is too short for the memory of the chain."""


@with_hints
def simulate(
    chain: Chain,
    *,
    duration: float = 5000.0,
    warmup: float | None = None,
    time_step: float | None = None,
    method: Method = "event-driven",
    stepper: Stepper = "splitting",
    merging: float | None = None,
    seed: Seed = 0,
    observe: str | Observer | Sequence[str | Observer] = ("widths", "density"),
    start: xr.Dataset | None = None,
    particles: ArrayLike | None = None,
    replicas: int = 1,
    average: Average = "time",
    every: float | None = None,
    threads: int | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_interval: float = 30.0,
    progress: bool | str = True,
) -> xr.Dataset:
    """Simulate the chain and return what was measured, with standard errors.

    Parameters
    ----------
    chain
        The chain, with any restitution.
    duration
        Time measured in each replica [t_0]; rounded up to whole snapshots. Good values are hundreds
        of relaxation times (:func:`relaxation_time`, 8.4 for the default chain). In less than some
        twenty of them error bars would be too small, which a warning says.
    warmup
        Time before measuring [t_0]; None: 12 relaxation times, or 0 with a ``start`` and for an
        ensemble.
    time_step
        None: 0.05 of the shorter of the times of spring and damping (0.1 for the default chain).
        For e != 1 it is also short enough to resolve the noise between collisions; see ``scales``.
        Elastic rods on linear springs without a gap, without springs in a box, and a single rod,
        are flown exactly, unless single collisions or walls are observed. Any step is right then;
        None: the time between snapshots. Any is right without springs, damping and noise, too;
        None: the time in which rods cross the mean room between them.
    method
        ``"event-driven"``: every collision in its order in time. ``"contact-dynamics"``: all
        contacts of a step at once, the paper's method. At e > 0 it takes energy in every step in
        which a rod touches both neighbours, and such steps add up, with a wide gap too.
    stepper
        ``"splitting"`` (of second order if event-driven) or ``"euler"`` (the paper's, first order).
    merging
        For e < 1: rods that would separate more slowly than this many velocity kicks of one
        step's noise (at least 1e-9 of a typical speed) move as one until the end of the step.
        None: 0.1, and 0.03 for e < 0.163, where 0.1 would make W_v 0.2 % larger.
    seed
        Integer >= 0, a ``SeedSequence`` or a ``Generator`` of numpy, from which a number is drawn;
        the number stands in the provenance. The same one gives the same result to the last bit for
        all ``threads``. A run that continues another one has new random numbers: its ``start``
        belongs to the seed.
    observe
        Any of ``"widths"`` (velocity_width, mean_velocity, mean_displacement, displacement_width
        and autocorrelation_time, which is infinite, thus not known, in a run of a single block),
        ``"density"``, ``"velocities"`` (velocity_density, velocity_skewness, velocity_kurtosis),
        ``"energy"`` (kinetic_energy, spring_energy and total_energy in time), ``"covariances"``
        (velocity_covariance, gap_covariance, mean_gap, neighbour_covariance, relative_temperature),
        ``"modes"`` (mode_velocity_variance), ``"time-correlations"`` (velocity_autocorrelation,
        displacement_autocorrelation, mean_squared_displacement, velocity_spectrum, each also of
        waves and of the centre), ``"collisions"`` (collision_rate), ``"impacts"`` (contact_force,
        contact_loss, contact_temperature, rebound_temperature, impact_speed_density), in a box
        ``"walls"`` (wall_force, wall_collision_rate), ``"avalanches"`` (avalanche_count),
        ``"triggered-collisions"`` (triggered_count) and ``"snapshots"`` (position and velocity as
        they are). Objects are taken, too: ``cb.observers.Velocities(bins=801)`` or your own.
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
        being the start or the end of a ``warmup``. Errors are then those of 32 groups of replicas.
    every
        Time between snapshots [t_0]; None: 10 steps, less where ``"time-correlations"`` needs it,
        for an ensemble a hundredth of the duration (with exact flight as far apart as 10 steps of a
        chain with a gap would be). The time step is shortened to a whole fraction of it. At most a
        million steps may be shorter than a thousandth of what they would be without it.
    checkpoint
        File for the state of the run, written every ``checkpoint_interval`` seconds and at
        Ctrl-C, SIGTERM or SIGHUP. The same call again continues from there and gives the same
        bits. A checkpoint of another call, or one that another process is using, is refused.
        SIGTERM and SIGHUP then end the program, unless it ignores or handles them; with the handler
        ``signal.default_int_handler`` they act like Ctrl-C.
    progress
        Show a progress bar with the time left, on a terminal or in a notebook, elsewhere a line
        every half minute. A text stands in front of it, to tell runs apart.

    Returns
    -------
    xarray.Dataset
        In the common vocabulary. ``attrs["status"]`` is ``completed``, ``interrupted`` (Ctrl-C:
        everything measured until then) or ``diverged`` (everything before the divergence, with a
        ``DivergedWarning``). ``attrs["end_time"]`` is the shortest time that any replica reached,
        warm-up included, or the last time reported for an ensemble. ``attrs["flight"]`` is
        ``exact`` or ``in steps``. ``attrs["time_step_error"]`` is the estimated relative error of
        the smallest velocity width above 0 due to the time step: 0 if the flight was exact, NaN
        where it is not known, as for a collision law of your own. ``attrs["relaxation_time"]`` is
        that of the chain.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    OSError
        If the checkpoint cannot be written at the start. Later this is only a warning.
    DivergedError
        If the chain diverged before anything was measured, a ``RuntimeError``.
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
    path = None if checkpoint is None else check_path("checkpoint", checkpoint)
    threads = check_integer("threads", cpu_count() if threads is None else threads, least=1)
    run = make_run(
        chain,
        duration=duration,
        warmup=warmup,
        time_step=time_step,
        method=method,
        stepper=stepper,
        merging=merging,
        seed=seed_of(seed),
        observe=observe,
        start=start,
        particles=particles,
        replicas=replicas,
        average=average,
        every=every,
    )
    if run.stays_at_rest:
        warn_user("amplitude=0 and a start at rest: nothing will move")
    elif run.too_short:
        warn_user(run.too_short, ShortRunWarning)
    copies = make_replicas(run)
    with announced(bool(progress)):
        compile_kernels({run.exact})
    state = None if path is None else Checkpoint(path, run, checkpoint_interval, copies)
    with nullcontext() if state is None else state.resumed():
        interrupted = _run_all(copies, threads, state, progress)
    return collect(run, copies, interrupted)


def _run_all(
    replicas: list[Replica], threads: int, checkpoint: Checkpoint | None, progress: bool | str
) -> bool:
    """Run the replicas in threads; return whether Ctrl-C, or a signal like it, stopped them."""
    stop, futures = Event(), list[Future[None]]()
    with (
        interrupts_noted() as signals,
        progress_bar(
            progress,
            total=sum(replica.total for replica in replicas),
            initial=sum(replica.done for replica in replicas),
            desc=progress if isinstance(progress, str) else "simulating",
            unit=" time units",
            unit_scale=True,
            bar_format="{l_bar}{bar}| {elapsed}<{remaining}, {rate_fmt}",
        ) as bar,
    ):
        try:
            with ThreadPoolExecutor(min(threads, len(replicas))) as pool:
                try:
                    futures.extend(pool.submit(replica.work, stop) for replica in replicas)
                    while not signals and _go_on(futures, checkpoint):
                        bar.update(sum(replica.done for replica in replicas) - bar.n)
                except KeyboardInterrupt:  # from a handler that is not ours
                    signals.append(SIGINT)
                finally:
                    stop.set()  # otherwise leaving the block would wait for the end of the run
                    for replica in replicas:
                        replica.patience[0] = _PATIENCE * replica.y.size
            bar.update(sum(replica.done for replica in replicas) - bar.n)
        finally:  # also where such a handler ends the program
            whole = not any(replica.broken for replica in replicas)  # else the last one stays
            if checkpoint and whole and not any(future.exception() for future in futures):
                checkpoint.save()
        for future in futures:
            future.result()
    return bool(signals)


def _go_on(futures: list[Future[None]], checkpoint: Checkpoint | None) -> bool:
    """Wait a moment; return whether there is work and no failure; save a checkpoint that is due."""
    timeout = min(max(0.02, 1e-4 * len(futures)), 0.5)  # to look at many futures takes time
    if checkpoint is not None:
        timeout = min(timeout, checkpoint.interval)
    done, pending = wait(futures, timeout=timeout, return_when=FIRST_EXCEPTION)
    going = bool(pending) and not any(future.exception() for future in done)
    if going and checkpoint is not None:
        checkpoint.save_if_due()
    return going


def make_run(chain: Chain, *, observe: Any, **arguments: Any) -> Run:
    """Check all arguments of :func:`simulate` that determine its numbers, without any work.

    A wrong one is a ValueError, and so is a run that would not fit into memory.
    """
    run = Run(chain=chain, observers=find_observers(observe), **arguments)
    check_observers(run)
    return run
