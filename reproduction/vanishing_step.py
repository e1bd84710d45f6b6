"""Dissipative chains in the limit of a vanishing time step, beside the runs at a time step.

The error bar of a limit holds its statistics and the remaining error of the step. Independent
limits of one chain have the second part in common: the mean of many does not make it smaller.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import xarray as xr

from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.repetition import Granted, Runs
from crazybilliards.reproduction.claims.study import Results
from crazybilliards.reproduction.claims.verdicts import Estimate

LABEL = r"limit $dt \to 0$"

# Number of limits, and the accuracy of each: at e = 0, where exponents have their errors from the
# scatter between them, and at larger restitutions, where they cost ten times as much.
_INELASTIC: Granted = {
    "quick": (4, {"accuracy": 0.1, "warmup": 20.0}),
    "full": (5, {"accuracy": 0.01}),
}
_DISSIPATIVE: Granted = {
    "quick": (1, {"accuracy": 0.1, "warmup": 20.0}),
    "full": (1, {"accuracy": 0.035}),
}


def limits(size: int, restitution: float = 0.0) -> Runs:
    """Return limits of a dissipative chain."""
    return Runs(
        f"limit L={size} e={restitution:g}",
        Chain(size=size, restitution=restitution),
        _DISSIPATIVE if restitution else _INELASTIC,
        {"observe": ["widths"]},
        "simulate_limit",
    )


def central_limit(results: Results, size: int, restitution: float = 0.0) -> Estimate:
    """Return W_v in the centre for dt -> 0, with one error for statistics and time step."""
    runs = limits(size, restitution).members(results)
    value = float(np.mean([central_width(run) for run in runs]))
    bias = common_bias(runs)
    squares = 0.0
    for run in runs:
        error = float(run.central_velocity_width_error / run.central_velocity_width)
        squares += max(error**2 - float(run.attrs["time_step_error"]) ** 2, 0.0)
    statistics = math.sqrt(squares) / len(runs)
    return Estimate(value, value * math.hypot(statistics, bias))


def common_bias(runs: list[xr.Dataset]) -> float:
    """Return the remaining relative error of the step in W_v of the centre, mean of the limits."""
    return float(np.mean([run.attrs["time_step_error"] for run in runs]))


def limit_estimate(
    results: Results, size: int, quantity: Callable[[xr.Dataset], float]
) -> Estimate:
    """Return a number drawn from W_v(i) for dt -> 0 at e = 0, an exponent say.

    Its statistics are the scatter between the limits. Its bias is by how much it moves if W_v is
    off by the remaining error of the step: in the centre by that share, elsewhere by less, as r^3,
    r being the velocity kick of a step over W_v.
    """
    found = limits(size).estimate(results, quantity)
    moved = float(np.mean([quantity(_with_a_step(run)) for run in limits(size).members(results)]))
    return Estimate(found.value, math.hypot(found.error, moved - found.value))


def _with_a_step(run: xr.Dataset) -> xr.Dataset:
    width = run.velocity_width
    share = float(run.attrs["time_step_error"]) * (central_width(run) / width) ** 3
    return run.assign(velocity_width=width * (1 + share))
