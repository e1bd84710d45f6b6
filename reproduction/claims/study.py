"""A study, a figure of the paper computed anew: what it needs, its picture, its claims.

A number drawn from a whole profile, an exponent say, has no simple error bar: neighbouring rods
move together. It is worked out for every independent run by itself, and the scatter between the
runs is its error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import ArrayLike
from scipy.stats import norm, t

from crazybilliards.comparison.combining import combine
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Array, Chain
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate

Quality = Literal["quick", "full"]
Results = Mapping[str, xr.Dataset]  # of the cases, by the same names
#: By quality: the number of runs, and the settings that are those of this quality alone.
Effort = Mapping[Quality, tuple[int, Mapping[str, Any]]]


def effort(quick: tuple[float, ...], full: tuple[float, ...]) -> Effort:
    """Return by quality the number of runs, their duration, and their warm-up unless left out."""
    names = ("duration", "warmup")
    return {
        "quick": (int(quick[0]), dict(zip(names, quick[1:], strict=False))),
        "full": (int(full[0]), dict(zip(names, full[1:], strict=False))),
    }


@dataclass(frozen=True)
class Runs:
    """Runs of one chain that differ in their random numbers, and what they give together."""

    name: str  #: their cases go by NAME/0, NAME/1, ...
    chain: Chain
    effort: Effort  #: of each quality, see :func:`effort`
    settings: Mapping[str, Any]  #: which are the same at both qualities

    def at_step(self, step: float, effort: Effort) -> Runs:
        """Return runs of the same chain at a fixed time step."""
        return replace(
            self,
            name=f"{self.name} dt={step:g}",
            effort=effort,
            settings={**self.settings, "time_step": step},
        )

    def cases(self, quality: Quality) -> dict[str, Case]:
        """Return the cases ``NAME/0``, ``NAME/1``, ..."""
        number, own = self.effort[quality]
        return {
            f"{self.name}/{i}": Case("simulate", self.chain, {**own, **self.settings, "seed": i})
            for i in range(number)
        }

    def members(self, results: Results) -> list[xr.Dataset]:
        """Return those of the results that are theirs."""
        return [run for key, run in results.items() if key.rpartition("/")[0] == self.name]

    def mean(self, results: Results) -> xr.Dataset:
        """Return :func:`crazybilliards.comparison.combine` of them."""
        return combine(self.members(results))

    def estimate(self, results: Results, quantity: Callable[[xr.Dataset], float]) -> Estimate:
        """Return the mean of a quantity over them, with the error from its scatter."""
        return self.estimates(results, lambda run: [quantity(run)])[0]

    def estimates(
        self, results: Results, quantities: Callable[[xr.Dataset], ArrayLike]
    ) -> list[Estimate]:
        """Return :meth:`estimate` of each of several quantities."""
        values = np.array([quantities(run) for run in self.members(results)])
        return list(map(Estimate, values.mean(axis=0).tolist(), error_of_mean(values).tolist()))

    def estimate_together(
        self, results: Results, quantity: Callable[[Sequence[xr.Dataset]], float]
    ) -> Estimate:
        """Return a quantity of all runs together, with the error from that of single runs."""
        scatter = self.estimate(results, lambda run: quantity([run]))
        return Estimate(quantity(self.members(results)), scatter.error)


class Solution(NamedTuple):
    """The steady state of the gas of one chain, the same at both qualities."""

    name: str
    chain: Chain
    settings: Mapping[str, Any]

    def cases(self, quality: Quality) -> dict[str, Case]:
        """Return its case, which has its name."""
        return {self.name: Case("steady_state", self.chain, self.settings)}


@dataclass(frozen=True, kw_only=True, eq=False)
class Study:
    """A question put to simulations and theories, answered by a picture and by checked claims."""

    number: int  #: of the figure in the paper, arXiv:1404.7460
    name: str  #: short, for the command line and for files
    title: str  #: one line
    caption: str  #: what a reader needs to understand the picture
    needs: Sequence[Runs | Solution] = ()  #: the simulations and theories
    draw: Callable[[Results], Figure]  #: the picture, from the results of all cases by their names
    claims: Callable[[Results], list[Claim]] | None = None  #: beside what was found

    def cases(self, quality: Quality) -> dict[str, Case]:
        """Return the cases of all that it needs, by their names."""
        return {name: case for need in self.needs for name, case in need.cases(quality).items()}

    @property
    def heading(self) -> str:
        """The heading of its part of the page."""
        return f"{self.number}. {self.title}"

    @property
    def stem(self) -> str:
        """The name of its picture without the ending."""
        return f"fig{self.number:02d}_{self.name}"


def error_of_mean(values: ArrayLike) -> Array:
    """Return the standard error of the mean of independent runs, along the first axis.

    It comes from their scatter, which few runs do not show well. It is therefore enlarged by
    Student's factor, so that 68 % of all means lie within one error: by 1.20 for four runs, 1.08
    for eight. With fewer than four runs it is not known, and infinity is returned.
    """
    values = np.asarray(values, dtype=float)
    number = len(values)
    if number < 4:
        return np.full(values.shape[1:], np.inf)
    factor = float(t.ppf(norm.cdf(1), number - 1))
    return np.asarray(factor * values.std(axis=0, ddof=1) / number**0.5)


def share_of_runs(outcomes: Sequence[bool]) -> Estimate:
    """Return what share of all runs has an outcome, as far as these show it: Laplace's rule.

    The error is not zero even if all runs are alike: 4 of 4 give 0.83 +- 0.14.
    """
    share = (sum(outcomes) + 1) / (len(outcomes) + 2)
    return Estimate(share, (share * (1 - share) / (len(outcomes) + 3)) ** 0.5)
