"""Independent runs of one chain: making their cases, averaging them, and errors from their scatter.

A number drawn from a whole profile, an exponent say, has no simple error bar: neighbouring rods
move together. It is worked out for every run by itself, and the scatter between the runs is its
error. Runs also share the work among processes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.stats import norm, t

from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.reproduction.claims.study import Cases, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Estimate

_SQUARED = ("velocity_width", "displacement_width")
_FEWEST = 4  # runs that show their scatter
_COUNTED = ("avalanche_count", "triggered_count")


# By quality: the number of runs, and settings that are those of this quality alone.
Granted = Mapping[Quality, tuple[int, Mapping[str, Any]]]


@dataclass(frozen=True)
class Runs:
    """Independent runs of one chain: their cases, and what their results give together.

    They differ in their random numbers only. Methods that take ``results`` look for their own runs
    among them.
    """

    name: str  #: their cases go by NAME/0, NAME/1, ...
    chain: Chain
    #: By quality: the number of runs and their settings, {"quick": (4, {"duration": 500.0}),
    #: "full": (8, {"duration": 2e4})} say.
    granted: Granted
    settings: Mapping[str, Any]  #: which are the same at both qualities

    def at_step(self, step: float, granted: Granted) -> Runs:
        """Return runs of the same chain at a fixed time step."""
        settings = {**self.settings, "time_step": step}
        return replace(self, name=f"{self.name} dt={step:g}", granted=granted, settings=settings)

    def cases(self, quality: Quality) -> Cases:
        """Return the cases ``NAME/0``, ``NAME/1``, ..."""
        number, own = self.granted[quality]
        return {
            f"{self.name}/{seed}": Case(
                "simulate", self.chain, {**own, **self.settings, "seed": seed}
            )
            for seed in range(number)
        }

    def members(self, results: Results) -> list[xr.Dataset]:
        """Return their results, as many as there are."""
        return [run for key, run in results.items() if key.rpartition("/")[0] == self.name]

    def pooled(self, results: Results) -> xr.Dataset:
        """Average them: widths in the mean square, counts summed."""
        datasets = self.members(results)
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

    def estimate(self, results: Results, quantity: Callable[[xr.Dataset], float]) -> Estimate:
        """Return the mean of a quantity over them, with the error from its scatter."""
        return self.estimates(results, lambda run: [quantity(run)])[0]

    def estimates(
        self, results: Results, quantities: Callable[[xr.Dataset], ArrayLike]
    ) -> list[Estimate]:
        """Return :meth:`estimate` of each of several quantities."""
        values = np.array([quantities(run) for run in self.members(results)])
        return [
            Estimate(*map(float, each))
            for each in zip(values.mean(axis=0), error_of_mean(values), strict=True)
        ]


def error_of_mean(values: ArrayLike) -> Array:
    """Return the standard error of the mean of independent runs, along the first axis.

    It comes from their scatter, which few runs do not show well. It is therefore enlarged by
    Student's factor, so that 68 % of all means lie within one error: by 1.20 for four runs, 1.08
    for eight. With fewer than four runs it is not known, and infinity is returned.
    """
    values = np.asarray(values, dtype=float)
    number = len(values)
    if number < _FEWEST:
        return np.full(values.shape[1:], np.inf)
    factor = float(t.ppf(norm.cdf(1), number - 1))
    return np.asarray(factor * values.std(axis=0, ddof=1) / number**0.5)


def share_of_runs(of_them: int, number: int) -> Estimate:
    """Return what share of all runs it is, if it is ``of_them`` of ``number``: Laplace's rule.

    The error is not zero even if all runs are alike: 4 of 4 give 0.83 +- 0.14.
    """
    share = (of_them + 1) / (number + 2)
    return Estimate(share, (share * (1 - share) / (number + 3)) ** 0.5)
