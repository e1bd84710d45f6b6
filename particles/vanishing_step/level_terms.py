"""One term of the sum over levels: averages of a chain, or differences of two coupled ones.

The value of a term is that of all its groups of snapshots together, and its standard error is the
jackknife over the groups (``sampler.py``).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from copy import deepcopy
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, stdtrit

from crazybilliards.model.arrays import Array
from crazybilliards.model.chain import middle_tenth
from crazybilliards.particles.observers.base import Averaged, Observer
from crazybilliards.particles.observers.error_bars import jackknife_error
from crazybilliards.particles.vanishing_step.sampler import Sampler

CENTRAL = "central_velocity_width"
# The one follows from an error bar and is no average. The other is zero, and the error of a
# derivative's mean is not that of groups: what one group has too much of, the next one lacks.
_LEFT_OUT = ("autocorrelation_time", "mean_velocity")
_ONE_SIGMA = ndtr(1.0)
# Relative error from which on that of a histogram is not trusted. The visits of about eight groups
# then decide, and a place that no rod visited would have no error at all.
_RARE = 0.3


class Estimate(NamedTuple):
    """One term of the sum: every variable, its variance, and W_v in the centre in detail."""

    values: dict[str, Array]
    dimensions: dict[str, tuple[str, ...]]
    variances: dict[str, Array]
    snapshots: int
    correlation: float  # of the widths of both chains; 0 if there is one

    @property
    def spread(self) -> float:
        """Variance of W_v in the centre, times the number of snapshots."""
        return float(self.variances[CENTRAL]) * self.snapshots


def _reported(
    groups: Sequence[Sequence[Sequence[Observer]]], chain: int, counts: NDArray[np.int64]
) -> dict[str, tuple[tuple[str, ...], Array]]:
    """Return the joint measurements of some groups, of the finer or the coarser chain."""
    found: dict[str, tuple[tuple[str, ...], Array]] = {}
    for first, *others in zip(*(group[chain] for group in groups), strict=True):
        joined, snapshots = deepcopy(first), counts
        joined.join(others)
        if isinstance(joined, Averaged):  # else it works out an error, each time
            joined.pool()
            snapshots = counts.sum(keepdims=True)
        for name, (dimensions, values) in joined.report(snapshots).items():
            array = np.asarray(values, dtype=float)
            if name in _LEFT_OUT or name.endswith("_error") or "block" in dimensions:
                continue
            if "time" in dimensions:  # of a steady state: all times are the same
                array = array.mean(axis=dimensions.index("time"))
                dimensions = tuple(each for each in dimensions if each != "time")
            found[name] = dimensions, array
    rods = found["velocity_width"][1]
    found[CENTRAL] = (), np.sqrt(np.mean(rods[middle_tenth(rods.size)] ** 2))
    return found


def estimate(samplers: Sequence[Sampler], *, difference: bool, only: str | None = None) -> Estimate:
    """Return the finer chain's averages, or by how much they exceed the coarser one's.

    ``only``: name of the only observer to ask, which is quicker.
    """
    counts = np.array([n for sampler in samplers for n in sampler.counts if n])
    groups = [
        [[each for each in chain if only in (None, each.name)] for chain in group]
        for sampler in samplers
        for group, n in zip(sampler.measured, sampler.counts, strict=True)
        if n
    ]
    whole = [_reported(groups, chain, counts) for chain in range(1 + difference)]
    left_out: list[dict[str, list[Array]]] = [{name: [] for name in whole[0]} for _ in whole]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said already, of all of them together
        for out in range(len(groups)):
            rest = groups[:out] + groups[out + 1 :]
            for chain, each in enumerate(left_out):
                for name, (_, found) in _reported(rest, chain, np.delete(counts, out)).items():
                    each[name].append(found)
    # So few groups: with Student's factor 68 % of the values lie within one error.
    student = float(stdtrit(counts.size - 1, _ONE_SIGMA)) if counts.size > 1 else 1.0
    values: dict[str, Array] = {}
    variances: dict[str, Array] = {}
    for name in whole[0]:
        values[name] = np.subtract.reduce([each[name][1] for each in whole])
        without = np.subtract.reduce([each[name] for each in left_out])
        variances[name] = (student * jackknife_error(values[name], without, counts)) ** 2
    for name in {each for observer in groups[0][0] for each in observer.histograms}:
        for part, rest_of in zip(whole, left_out, strict=True):
            share = part[name][1]
            error = jackknife_error(share, np.array(rest_of[name]), counts)
            variances[name][~(error < _RARE * share)] = np.nan
    widths = np.array([each[CENTRAL] for each in left_out])
    correlation = float(np.corrcoef(widths)[0, 1]) if difference else 0.0
    dimensions = {name: each[0] for name, each in whole[0].items()}
    return Estimate(values, dimensions, variances, int(counts.sum()), correlation)
