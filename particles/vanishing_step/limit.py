"""The limit of the simulation for a vanishing time step: :func:`simulate_limit`."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.model import Chain
from crazybilliards.model.calls import public, warn_user
from crazybilliards.model.checks import check_integer, check_path, check_real
from crazybilliards.model.memory import require_memory
from crazybilliards.model.process import announced, cores, interrupts_noted
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.model.vocabulary import result
from crazybilliards.particles.observers import Observer, find_observers
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.checkpoint import Checkpoint, identity
from crazybilliards.particles.running.collecting import only_chosen
from crazybilliards.particles.running.threads import run_all
from crazybilliards.particles.scales import relaxation_time
from crazybilliards.particles.schedule import Schedule, too_short
from crazybilliards.particles.simulation import ShortRunWarning, compile_kernels
from crazybilliards.particles.start import MOST_REPLICAS
from crazybilliards.particles.vanishing_step.level_steps import GROUPS, Steps, plan_steps
from crazybilliards.particles.vanishing_step.level_terms import CENTRAL
from crazybilliards.particles.vanishing_step.multilevel import Levels
from crazybilliards.particles.vanishing_step.sampler import Sampler, compile_pair

_OPEN = 2**40  # snapshots: how many a group gets turns out later
_JOINED = 3  # copies of what observers keep, while they are joined


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelRun(Run):
    """The run of one level, with steps and snapshots in whole numbers and one unlimited block."""

    warmup_steps: int
    stride: int

    @cached_property
    def schedule(self) -> Schedule:
        """The steps of the level; the number of snapshots is not limited."""
        assert self.time_step is not None
        return Schedule(self.time_step, self.warmup_steps, self.stride, 1, _OPEN)


@public
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

    The method is multilevel Monte Carlo. Averages of a run at a long step are corrected by those of
    coupled runs at shorter and shorter steps, until W_v in the centre has the wanted accuracy.
    ``multilevel.py`` explains how steps, levels and durations are chosen.

    Parameters
    ----------
    chain
        The chain. It needs a steady state, and therefore damping and noise.
    accuracy
        Wanted relative error of the velocity width in the centre (root of the mean <v^2> of the
        middle tenth of the rods), standard error and bias together; 1e-4 to 0.1. The work grows
        a little faster than 1/accuracy^2.
    warmup
        Time before measuring [T], at every level; None: 12 relaxation times.
    merging, seed, particles
        As in :func:`simulate`.
    observe
        As in :func:`simulate`, with ``"widths"``. Refused are ``"snapshots"``, which are no
        averages, collisions and avalanches, which have no limit, and impacts, which it cannot see.
    replicas
        Independent trajectories at every level, each with a warm-up. ``threads`` of them (None:
        one per core) run at a time.
    checkpoint, checkpoint_interval, progress
        As in :func:`simulate`.

    Returns
    -------
    xarray.Dataset
        In the common vocabulary. Every NAME has a NAME_error, the root of the sum of the squares
        of one standard error and of the remaining bias. ``accuracy`` applies to
        ``central_velocity_width``. Energies have no time. ``mean_velocity`` is left out,
        because it is 0. Densities are sums of differences. Where hardly any rod comes they may be
        negative by about one error.
        ``attrs["status"]`` is as in :func:`simulate`; an interrupted run has the errors reached
        so far. ``attrs["time_step_error"]`` is the remaining relative bias in the centre.
        ``attrs["coupling"]`` is ``strong``, ``weak`` if plain runs at the shortest step were
        cheaper, or ``one step`` if one was enough from the beginning. ``attrs["correlation"]``, if
        there are several, is that of the widths at the last two. ``attrs["saving"]``, if the
        coupling is strong, estimates how many times the work of the levels a plain run at the
        shortest step would take. The error of a density is NaN at nodes (of a velocity density in
        bins) that so few rods visited that it is not known. The provenance describes every level.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    OSError
        If the checkpoint cannot be written at the start. Later this is only a warning.
    KeyboardInterrupt
        On Ctrl-C before every level has two measurements.

    Examples
    --------
    >>> from crazybilliards.model import Chain
    >>> limit = simulate_limit(Chain(size=3, restitution=0), accuracy=0.05, progress=False)
    >>> bool(limit.central_velocity_width_error < 0.06 * limit.central_velocity_width)
    True
    """
    threads = check_integer("threads", cores() if threads is None else threads, least=1)
    checkpoint_interval = check_real("checkpoint_interval", checkpoint_interval)
    kept = None if checkpoint is None else check_path("checkpoint", checkpoint)
    seed = seed_of(seed)
    steps, runs = make_runs(
        chain,
        accuracy=accuracy,
        warmup=warmup,
        observe=observe,
        replicas=replicas,
        seed=seed,
        merging=merging,
        particles=particles,
    )
    given = math.inf if warmup is None else warmup
    if short := too_short(chain, math.inf, given, replicas, at_rest=True):
        warn_user(short, ShortRunWarning)
    groups = -(-GROUPS // replicas)
    by_level = [
        [
            Sampler(run, longer, np.random.SeedSequence(seed, spawn_key=(level, replica)), groups)
            for replica in range(replicas)
        ]
        for level, (run, longer) in enumerate(zip(runs, [None, *runs[:-1]], strict=True))
    ]
    levels = Levels(chain, float(accuracy), steps, by_level)
    samplers = [sampler for level in by_level for sampler in level]
    with announced(progress):
        compile_kernels()
        compile_pair()
    keeper = None
    if kept is not None:
        own = {"accuracy": levels.accuracy, "replicas": replicas, "levels": levels.steps}
        keeper = Checkpoint(kept, identity(samplers[0].finer) | own, checkpoint_interval)
    with (
        interrupts_noted() as signals,  # between two rounds as well
        nullcontext() if keeper is None else keeper.resumed(samplers),
    ):
        while True:
            run_all(samplers, threads, keeper, progress, " rod steps")
            diverged = any(sampler.diverged for sampler in samplers)
            if signals or diverged or not levels.extend():
                break
        return _collect(levels, bool(signals), progress)


def make_runs(
    chain: Chain,
    *,
    accuracy: float,
    warmup: float | None,
    observe: Any,
    replicas: int,
    **arguments: Any,
) -> tuple[Steps, list[LevelRun]]:
    """Check all arguments of :func:`simulate_limit` and plan its levels, without any work."""
    # A new parameter is refused: noise with a memory, for example, needs another sum of kicks.
    chain.require_known("simulate_limit")
    accuracy = check_real("accuracy", accuracy, positive=True)
    if not 1e-4 <= accuracy <= 0.1:
        raise ValueError(f"accuracy must lie between 1e-4 and 0.1, got {accuracy:g}")
    if warmup is not None:
        warmup = check_real("warmup", warmup)
    replicas = check_integer("replicas", replicas, least=1, most=MOST_REPLICAS)
    if chain.damping == 0 or chain.amplitude == 0:
        raise ValueError("the limit of a steady state needs damping and amplitude above 0")
    observers = find_observers(observe)
    if not any(observer.name == "widths" for observer in observers):
        raise ValueError("observe must name 'widths', whose accuracy is asked for")
    for observer in observers:
        if not observer.limit:
            raise ValueError(f"observe: {observer.name!r} has no limit of a vanishing time step")
        if observer.single_collisions:
            raise ValueError(f"observe: {observer.name!r} needs single collisions, unrecorded here")
    steps = plan_steps(chain, accuracy, warmup)
    runs = [
        LevelRun(
            chain=chain,
            duration=math.inf,
            time_step=time_step,
            observers=observers,
            **arguments,
            warmup_steps=steps.warmup * steps.per_step(level),
            stride=steps.stride * steps.per_step(level),
        )
        for level, time_step in enumerate(steps.time_steps)
    ]
    kept = sum(observer.memory(runs[0]) for observer in observers)
    copies = replicas * -(-GROUPS // replicas) * (2 * len(runs) - 1 + _JOINED)
    require_memory("observe (ask for fewer particles)", copies * kept)
    return steps, runs


def _collect(levels: Levels, interrupted: bool, progress: bool) -> xr.Dataset:
    """Add the levels up to one result."""
    used = [sampler for level in levels.used for sampler in levels.samplers[level]]
    diverged = any(sampler.diverged for samplers in levels.samplers for sampler in samplers)
    finest = used[-1].finer
    method = finest.provenance() | {"accuracy": levels.accuracy}
    method["replicas"] = len(levels.samplers[0])
    del method["schedule"]
    collected = partial(
        result,
        levels.chain,
        source="simulation",
        status="interrupted" if interrupted else "diverged" if diverged else "completed",
        end_time=min(sampler.steps * sampler.schedule.time_step for sampler in used),
        particles=finest.chosen + 1,
        vocabulary=finest.vocabulary,
    )
    if diverged:  # an average at long steps alone is not the limit
        return collected({}, method=method)
    if not levels.measured:
        raise KeyboardInterrupt("not every level was measured yet")
    terms = levels.terms()
    bias = levels.bias(terms)
    variables: dict[str, Any] = {}
    for name, dimensions in terms[0].dimensions.items():
        value = sum(term.values[name] for term in terms)
        error = np.sqrt(sum(term.variances[name] for term in terms) + bias[name] ** 2)
        for each, values in ((name, value), (f"{name}_error", error)):
            variables[each] = only_chosen(finest.chosen, levels.chain.size, dimensions, values)
    coordinates: dict[str, Any] = {}
    for observer in used[-1].measured[0][0]:
        coordinates |= observer.coordinates()
    coordinates.pop("time", None)  # there is none
    method["levels"] = levels.described(terms)
    limit = collected(variables, coordinates=coordinates, method=method)
    limit.attrs |= {
        "flight": finest.flight,
        "relaxation_time": relaxation_time(levels.chain),
        "time_step_error": float(bias[CENTRAL] / limit[CENTRAL]),
        **levels.coupling(terms),
    }
    if progress and limit.attrs.get("coupling") == "weak":
        long, short = levels.steps.time_steps[levels.used[-1] - 1 : levels.used[-1] + 1]
        print(
            f"crazybilliards: runs at the steps {long:.2g} and {short:.2g} are correlated by "
            f"{limit.attrs['correlation']:.2f} only: plain runs at {short:.2g} were cheaper",
            file=sys.stderr,
        )
    return limit
