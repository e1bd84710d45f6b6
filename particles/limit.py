r"""The limit of a vanishing time step: :func:`simulate_limit`.

It is one run at one step, as :func:`simulate` makes it.

**Step.** It is the longest one whose expected errors are a quarter of the accuracy. The error of
velocities is that of ``scales.time_step_error``, which was measured in simulations. Displacements
on linear springs are off by (w0 dt)^2/8 besides. Where the motion is known exactly
(``laws/exact_flight.py``) there is no error.

**Duration.** The run goes on for at least 320 correlation times, and then by a quarter of its
duration at a time, until the standard error s of W_v in the centre and the expected error b of the
step have the wanted accuracy, sqrt(s^2 + b^2). How long it goes on is looked at so seldom because
each look may end it by chance, where s seems small.

**Check.** A second run at twice the step, a quarter as long, shows whether W_v in the centre
changes as expected. If it changes by five standard errors more than that, the change is the stated
error of the step, and a warning says so.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from loky import cpu_count
import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.model import Chain
from crazybilliards.model.warn import warn_user
from crazybilliards.model.checks import check_integer, check_path, check_real
from crazybilliards.model.process import announced, interrupts_noted
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.particles.laws.exact_flight import independent_rods
from crazybilliards.particles.observers import Observer, find_observers
from crazybilliards.particles.observers.centre import CENTRAL, Centre
from crazybilliards.particles.observers.error_bars import jackknife
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.checkpoint import Checkpoint, identity
from crazybilliards.particles.running.collecting import collect
from crazybilliards.particles.running.replica import Replica
from crazybilliards.particles.running.threads import run_all
from crazybilliards.particles.scales import (
    centre_width,
    correlation_time,
    default_time_step,
    spring_rate,
    time_step_error,
)
from crazybilliards.particles.schedule import STRIDE
from crazybilliards.particles.simulation import ShortRunWarning, compile_kernels, make_replicas

_EXPECTED = 0.25  # error of the step, in units of the accuracy
_LONGEST = 0.5  # step, over the times of spring and damping
_LEAST = 320.0  # duration, in correlation times, of all replicas together
_GROWTH = 1.25  # of the duration from look to look
_MOST = 2**30  # snapshots: how many there will be turns out later
_CHECK = 0.25  # duration of the check over that of the run
_SIGNIFICANT = 5.0  # standard errors
# Variables that linear springs do not make wrong.
_VELOCITIES = {CENTRAL, "velocity_width"}


@dataclass(frozen=True, kw_only=True, eq=False)
class LimitRun(Run):
    """A run that is as long as the accuracy requires."""

    accuracy: float

    def provenance(self) -> dict[str, Any]:
        """Return that of the run and the accuracy, on which a checkpoint depends too."""
        return super().provenance() | {"accuracy": self.accuracy}

    @property
    def interval(self) -> float:
        """Time from snapshot to snapshot."""
        return self.schedule.stride * self.schedule.time_step

    def looks(self) -> Iterator[int]:
        """Yield the snapshots that a replica has at every look, without an end."""
        snapshots = _LEAST * correlation_time(self.chain) / self.interval / self.replicas
        while True:
            yield math.ceil(snapshots)
            snapshots *= _GROWTH

    def biases(self, width: float) -> tuple[float, float]:
        """Relative errors of velocities and of displacements that the step is expected to cause."""
        return (0.0, 0.0) if self.exact else _biases(self.chain, self.schedule.time_step, width)

    def accurate(self, width: float, error: float) -> bool:
        """Return whether W_v in the centre has the wanted accuracy."""
        bias, wanted = self.biases(width)[0], self.accuracy
        # The statistics must not be required without limit where the bias is a large part.
        return (error / width) ** 2 <= max(wanted**2 - bias**2, wanted**2 / 4)


def simulate_limit(
    chain: Chain,
    *,
    accuracy: float = 0.01,
    warmup: float | None = None,
    merging: float | None = None,
    seed: Seed = 0,
    observe: str | Observer | Sequence[str | Observer] = ("widths", "density"),
    particles: ArrayLike | None = None,
    replicas: int = 1,
    threads: int | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_interval: float = 30.0,
    progress: bool = True,
) -> xr.Dataset:
    """Simulate the steady state of the chain in the limit of a vanishing time step.

    The step is so short that its error is small beside the accuracy. The run goes on until W_v in
    the centre has the wanted accuracy. ``limit.py`` explains how both are chosen.

    Parameters
    ----------
    chain
        The chain. It needs a steady state, and therefore damping and noise.
    accuracy
        Wanted relative error of the velocity width in the centre (root of the mean <v^2> of the
        middle tenth of the rods), standard error and bias together; 1e-4 to 0.1. The work grows
        a little faster than 1/accuracy^2.
    warmup, merging, seed, particles, replicas, threads
        As in :func:`simulate`.
    observe
        As in :func:`simulate`. Refused are ``"snapshots"``, ``"time-correlations"`` and what
        needs single collisions: they are not known to have a limit.
    checkpoint, checkpoint_interval, progress
        As in :func:`simulate`.

    Returns
    -------
    xarray.Dataset
        What :func:`simulate` returns, and ``central_velocity_width``, to which ``accuracy``
        applies. Every NAME_error is the root of the sum of the squares of the standard error and
        of the remaining bias. An interrupted run has the errors reached so far.
        ``attrs["time_step_error"]`` is the relative bias in the centre.
        ``attrs["double_step_change"]`` is by which fraction W_v in the centre changed at twice the
        step, and ``attrs["double_step_change_error"]`` its standard error. A chain that diverged
        has no central width, and its errors hold no bias.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    OSError
        If the checkpoint cannot be written at the start. Later this is only a warning.
    KeyboardInterrupt
        On Ctrl-C before anything was measured.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> limit = simulate_limit(Chain(size=3, restitution=0), accuracy=0.05, progress=False)
    >>> bool(limit.central_velocity_width_error < 0.06 * limit.central_velocity_width)
    True
    """
    threads = check_integer("threads", cpu_count() if threads is None else threads, least=1)
    interval = check_real("checkpoint_interval", checkpoint_interval)
    kept = None if checkpoint is None else check_path("checkpoint", checkpoint)
    run = limit_run(
        chain,
        accuracy=accuracy,
        warmup=warmup,
        observe=observe,
        replicas=replicas,
        seed=seed_of(seed),
        merging=merging,
        particles=particles,
    )
    if run.too_short:
        warn_user(run.too_short, ShortRunWarning)
    copies = make_replicas(run)
    checks = [] if run.exact else make_replicas(_at_twice_the_step(run))
    with announced(progress):
        compile_kernels([run])
    keeper = None if kept is None else Checkpoint(kept, identity(run), interval)
    resumed = nullcontext() if keeper is None else keeper.resumed([*copies, *checks])
    with interrupts_noted() as signals, resumed:  # between two looks as well
        for target in run.looks():
            if target < max(copy.snapshots for copy in copies):
                continue  # the checkpoint is of a later look
            for copy in copies:
                copy.extend(target)
            for copy in checks:
                copy.extend(math.ceil(_CHECK * target))
            run_all([*copies, *checks], threads, keeper, progress)
            width, error = _centre(copies)
            diverged = any(copy.diverged for copy in copies)
            if signals or diverged or run.accurate(width, error):
                break
        final = replace(run, duration=target * run.interval)
        limit = collect(final, copies, bool(signals))
    return limit if diverged else _with_bias(run, limit, checks)


def limit_run(chain: Chain, *, accuracy: float, observe: Any, **arguments: Any) -> LimitRun:
    """Check all arguments of :func:`simulate_limit` and choose the step, without any work."""
    # A new parameter is refused: nobody has measured the error of its step.
    chain.require_known("simulate_limit")
    accuracy = check_real("accuracy", accuracy, positive=True)
    if not 1e-4 <= accuracy <= 0.1:
        raise ValueError(f"accuracy must lie between 1e-4 and 0.1, got {accuracy:g}")
    if chain.damping == 0 or chain.amplitude == 0:
        raise ValueError("the limit of a steady state needs damping and amplitude above 0")
    observers = find_observers(observe)
    for observer in observers:
        if observer.single_collisions or not observer.limit:
            raise ValueError(
                f"observe: {observer.name!r} is not known to have a limit of a vanishing time step"
            )
    step, every = None, STRIDE * default_time_step(chain)
    if not independent_rods(chain):
        step = _step(chain, accuracy)
        every = max(every, 2 * step)  # a step of the check
    return LimitRun(
        chain=chain,
        duration=_MOST * every,
        time_step=step,
        every=every,
        observers=(*observers, Centre()),
        accuracy=accuracy,
        **arguments,
    )


def _step(chain: Chain, accuracy: float) -> float:
    """Return the longest step whose errors are a quarter of the accuracy."""
    width = centre_width(chain) * chain.free_velocity_width
    step = _LONGEST / max(spring_rate(chain), chain.damping / chain.mass)
    while max(_biases(chain, step, width)) > _EXPECTED * accuracy:
        step *= 0.98
    return step


def _biases(chain: Chain, step: float, width: float) -> tuple[float, float]:
    """Relative errors of velocities and of displacements at a step, W_v being ``width``."""
    bias = time_step_error(chain, step, width)
    springs = (spring_rate(chain) * step) ** 2 / 8 if chain.spring == "linear" else 0.0
    return bias, bias + springs


def _at_twice_the_step(run: LimitRun) -> Run:
    """Return the check: at twice the step, with noise of its own."""
    step = 2 * run.schedule.time_step
    seed = seed_of(np.random.SeedSequence(run.seed, spawn_key=(1,)))
    return replace(run, time_step=step, seed=seed, observers=(Centre(),), particles=None)


def _centre(copies: Sequence[Replica]) -> tuple[float, float]:
    """Return W_v in the centre and its standard error; NaN and infinity if nothing is measured."""
    counts = np.concatenate([copy.counts for copy in copies])
    if not counts.any():
        return math.nan, math.inf
    observers = [observer for copy in copies for observer in copy.observers]
    sums = [observer.sums for observer in observers if isinstance(observer, Centre)]
    width, error = jackknife(np.sqrt, np.concatenate(sums), counts)
    return float(width), float(error)


def _with_bias(run: LimitRun, limit: xr.Dataset, checks: Sequence[Replica]) -> xr.Dataset:
    """Add the error of the step to all standard errors, and what the check found."""
    width, error = float(limit[CENTRAL]), float(limit[f"{CENTRAL}_error"])
    velocities, others = run.biases(width)
    if checks:
        other, other_error = _centre(checks)
        change, uncertain = other / width - 1, math.hypot(error, other_error) / width
        limit.attrs |= {"double_step_change": change, "double_step_change_error": uncertain}
        expected = velocities + _biases(run.chain, 2 * run.schedule.time_step, width)[0]
        if abs(change) > expected + _SIGNIFICANT * uncertain:
            warn_user(
                f"W_v in the centre changed by {change:.1%} at twice the time step, where "
                f"{expected:.1%} was expected: the change is stated as the error of the step"
            )
            velocities, others = abs(change), others - velocities + abs(change)
    for name in [str(each) for each in limit if f"{each}_error" in limit]:
        bias = (velocities if name in _VELOCITIES else others) * abs(limit[name])
        bar = limit[f"{name}_error"]
        limit[f"{name}_error"] = bar.copy(data=np.hypot(bar.values, bias.values))
    return limit.assign_attrs(time_step_error=velocities)
