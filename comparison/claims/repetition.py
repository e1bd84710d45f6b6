"""Independent runs of one chain: making their cases, averaging them, and errors from their scatter.

A number drawn from a whole profile, an exponent say, has no simple error bar: neighbouring rods
move together. It is worked out for every run by itself, and the scatter between the runs is its
error. Runs also share the work among processes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import norm, t

from crazybilliards.comparison.claims.study import Cases, Results
from crazybilliards.comparison.claims.verdicts import Estimate
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain
from crazybilliards.model.chain import middle_tenth

_SQUARED = ("velocity_width", "displacement_width")
_COUNTED = ("avalanche_count", "triggered_count")


def repeated(
    name: str, chain: Chain, number: int, job: str = "simulate", /, **settings: Any
) -> Cases:
    """Return cases ``NAME/0``, ``NAME/1``, ... that differ in their random numbers only.

    ``job`` is ``"simulate"``, or ``"simulate_limit"`` for the limit of a vanishing time step.
    """
    return {
        f"{name}/{seed}": Case(job, chain, {**settings, "seed": seed}) for seed in range(number)
    }


def members(results: Results, name: str) -> list[xr.Dataset]:
    """Return the runs of that name."""
    return [run for key, run in results.items() if key.rpartition("/")[0] == name]


def pooled(results: Results, name: str) -> xr.Dataset:
    """Average the runs of that name: widths in the mean square, counts summed."""
    datasets = members(results, name)
    together = xr.concat(datasets, "run", coords="different", compat="equals", join="exact")
    values: dict[str, xr.DataArray] = {}
    for variable in together.data_vars:
        each = together[variable]
        key = str(variable)
        if key.endswith("_error"):
            joined = (each**2).sum("run") ** 0.5 / len(datasets)
        elif key in _SQUARED:
            joined = (each**2).mean("run") ** 0.5
        elif key in _COUNTED:
            joined = each.sum("run")
        else:
            joined = each.mean("run")
        values[key] = joined.assign_attrs(each.attrs)
    run = datasets[0].assign(values)
    if "mean_position" in together.coords and "run" in together.mean_position.dims:
        middle = together.mean_position.mean("run").assign_attrs(together.mean_position.attrs)
        run = run.assign_coords(mean_position=middle)
    return run


def estimate(results: Results, name: str, quantity: Callable[[xr.Dataset], float]) -> Estimate:
    """Return the mean of a quantity over the runs of that name, with the error from its scatter.

    The error is enlarged to mean the same 68 % however few the runs (Student's t).
    """
    values = [quantity(run) for run in members(results, name)]
    number = len(values)
    spread = float(np.std(values, ddof=1)) / number**0.5
    return Estimate(float(np.mean(values)), spread * float(t.ppf(norm.cdf(1), number - 1)))


def normal_deviate(deviation: float, runs: int) -> float:
    """Return how many standard errors of a normal distribution are as unlikely as a deviation.

    ``deviation`` is in units of the error of :func:`estimate` from so many runs. That error is
    itself uncertain: five of those of two runs come about by chance once in thirty times.
    """
    scattered = deviation * float(t.ppf(norm.cdf(1), runs - 1))
    return float(norm.isf(t.sf(scattered, runs - 1)))


def central_width(run: xr.Dataset) -> float:
    """W_v in the centre: root mean square over the middle tenth of the rods."""
    middle = middle_tenth(run.sizes["particle"])
    return float(np.sqrt((run.velocity_width.values[middle] ** 2).mean()))


def border_width(run: xr.Dataset) -> float:
    """W_v of the first and the last rod: root mean square of the two."""
    return float(np.sqrt((run.velocity_width.values[[0, -1]] ** 2).mean()))
