"""The jobs of a sweep, by name: the simulation, its limit, and every stationary theory.

A job is one entry of ``JOBS``. Every theory in ``THEORIES`` of
:mod:`crazybilliards.comparison.stationary_theories` is a job without further work.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import xarray as xr

from crazybilliards.comparison.stationary_theories import THEORIES, Theory
from crazybilliards.model import Chain
from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.particles import simulate, simulate_limit
from crazybilliards.particles.limit import limit_run
from crazybilliards.particles.simulation import make_run

# Arguments that do not change the numbers, and arguments that are not plain values.
_NO_SETTINGS = {"chain", "start", "threads", "checkpoint", "checkpoint_interval"} | {"progress"}

_STEPS_A_SECOND = 1e8  # particle steps, to compare the work of theories with that of simulations


@dataclass(frozen=True)
class Job:
    """A function of a chain that a sweep can compute."""

    function: Callable[..., xr.Dataset]  #: of a chain and settings, each case with its own seed
    #: The computing time in particle steps, of the same arguments. It raises the ValueError that
    #: the function would raise for a wrong argument, without its work.
    work: Callable[..., float]
    settings: Mapping[str, Any]  #: names and defaults
    #: Fingerprint of the source code that the result depends on. It is computed when this module is
    #: imported, together with that code: an edit during an interactive session does not change it.
    source: str
    #: In what averages over time are too short for the memory of the chain, or nothing.
    too_short: Callable[..., str] = lambda chain, **settings: ""


def _settings(function: Callable[..., Any]) -> dict[str, Any]:
    """Return the arguments of a function that are settings of a job, with their defaults."""
    arguments = inspect.signature(function).parameters.items()
    return {name: each.default for name, each in arguments if name not in _NO_SETTINGS}


def _steps(chain: Chain, **settings: Any) -> float:
    run = make_run(chain, start=None, **settings)
    return float(run.schedule.steps) * chain.size * run.replicas


def _too_short(chain: Chain, **settings: Any) -> str:
    return make_run(chain, start=None, **settings).too_short


def _limit_steps(chain: Chain, **settings: Any) -> float:
    """Return the steps before the measurement plus an estimate of those that are measured."""
    run = limit_run(chain, **settings)
    # W_v in the centre fluctuates by a half per time unit, to a factor of 2 for 10 to 1000 rods.
    measured = 2 * (0.5 / run.accuracy) ** 2 / run.schedule.time_step
    least = next(run.looks()) * run.schedule.stride * run.replicas
    return chain.size * (run.schedule.warmup_steps * run.replicas + max(measured, float(least)))


def _theory_work(theory: Theory, chain: Chain, **settings: Any) -> float:
    theory.check(chain, **settings)
    return _STEPS_A_SECOND * theory.seconds(chain)


JOBS: dict[str, Job] = {
    "simulate": Job(
        function=partial(simulate, progress=False),
        work=_steps,
        too_short=_too_short,
        settings=_settings(simulate),
        source=room_fingerprint("model", "particles"),
    ),
    "simulate_limit": Job(
        function=partial(simulate_limit, progress=False),
        work=_limit_steps,
        settings=_settings(simulate_limit),
        source=room_fingerprint("model", "particles"),
    ),
} | {
    name: Job(
        function=theory.solve,
        work=partial(_theory_work, theory),
        settings=_settings(theory.solve),
        source=room_fingerprint("model", "kinetic"),
    )
    for name, theory in THEORIES.items()
}
