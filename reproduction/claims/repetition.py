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
from numpy.typing import ArrayLike, NDArray
from scipy.stats import norm, t

from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.study import Cases, Results
from crazybilliards.reproduction.claims.verdicts import Estimate

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


def error_of_mean(values: ArrayLike) -> NDArray[np.float64]:
    """Return the standard error of the mean of independent runs, along the first axis.

    It comes from their scatter, which few runs do not show well. It is therefore enlarged by
    Student's factor, so that 68 % of all means lie within one error however few the runs: by 1.84
    for two runs, 1.20 for four, 1.08 for eight.
    """
    values = np.asarray(values, dtype=float)
    number = len(values)
    factor = float(t.ppf(norm.cdf(1), number - 1))
    return np.asarray(factor * values.std(axis=0, ddof=1) / number**0.5)


def estimate(results: Results, name: str, quantity: Callable[[xr.Dataset], float]) -> Estimate:
    """Return the mean of a quantity over the runs of that name, with the error from its scatter."""
    return estimates(results, name, lambda run: [quantity(run)])[0]


def estimates(
    results: Results, name: str, quantities: Callable[[xr.Dataset], ArrayLike]
) -> list[Estimate]:
    """Return :func:`estimate` of each of several quantities."""
    values = np.array([quantities(run) for run in members(results, name)])
    return [
        Estimate(*map(float, each))
        for each in zip(values.mean(axis=0), error_of_mean(values), strict=True)
    ]


def share_of_runs(of_them: int, number: int) -> Estimate:
    """Return what share of all runs it is, if it is ``of_them`` of ``number``: Laplace's rule.

    The error is not zero even if all runs are alike: 4 of 4 give 0.83 +- 0.14.
    """
    share = (of_them + 1) / (number + 2)
    return Estimate(share, (share * (1 - share) / (number + 3)) ** 0.5)
