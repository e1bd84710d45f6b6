"""Anderson's acceleration of a fixed-point iteration, with bounded steps.

scipy.optimize.anderson takes any step that its line search likes, and an evaluation here is a
kinetic equation that cannot be solved far from where it was solved before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_KEPT = 5
_MIXED = 0.5  # share of the residual in a step
_LONGEST = 0.4  # change of any unknown in a step
_LEAST_DIRECTION = 1e-3  # singular values below this share of the largest say nothing


class FixedPoint(NamedTuple):
    """Where x = map(x), the largest |map(x) - x|, and the number of evaluations."""

    x: Array
    residual: float
    evaluations: int


class NoFixedPointError(ValueError):
    """The iteration did not come to an end."""


def fixed_point(
    image: Callable[[Array], Array], start: Array, tolerance: float, most: int
) -> FixedPoint:
    """Find x = image(x), to ``tolerance`` in its largest component."""
    x, points, residuals = start, [], []  # type: Array, list[Array], list[Array]
    for evaluation in range(1, most + 1):
        residual = image(x) - x
        size = float(np.abs(residual).max())
        if not np.isfinite(size):
            break
        if size < tolerance:
            return FixedPoint(x, size, evaluation)
        points, residuals = [*points, x][-_KEPT:], [*residuals, residual][-_KEPT:]
        step = _MIXED * residual
        if len(points) > 1:
            moves, changes = (np.diff(np.array(each), axis=0).T for each in (points, residuals))
            shares = np.linalg.lstsq(changes, residual, rcond=_LEAST_DIRECTION)[0]
            step = step - (moves + _MIXED * changes) @ shares
        x = x + np.clip(step, -_LONGEST, _LONGEST)
    raise NoFixedPointError(
        f"one rod and pairs do not agree after {evaluation} iterations: they differ by {size:.2g}"
    )
