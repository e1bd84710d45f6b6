"""Anderson's acceleration of a fixed-point iteration, with bounded steps.

scipy.optimize.anderson takes any step that its line search likes, and an evaluation here is a
state of the gas that cannot be found far from where one was found before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from crazybilliards.model.arrays import Array

_KEPT = 5
_MIXED = 0.5  # share of the residual in a step
_LONGEST = 0.4  # change of any unknown in a step
_MOST_HALVINGS = 6
_LEAST_DIRECTION = 1e-3  # singular values below this share of the largest say nothing


class FixedPoint(NamedTuple):
    """Where x = map(x), the largest |map(x) - x|, and the number of evaluations."""

    x: Array
    residual: float
    evaluations: int


class NoFixedPointError(ValueError):
    """The iteration did not come to an end."""


def find_fixed_point(
    image: Callable[[Array], Array], start: Array, tolerance: float, most: int
) -> FixedPoint:
    """Find x = image(x), to ``tolerance`` in its largest component.

    Where ``image`` raises a ValueError, half the step is tried, as far as six times.
    """
    points: list[Array] = []
    residuals: list[Array] = []
    x, size, halvings = start, np.nan, 0
    for evaluation in range(1, most + 1):
        try:
            residual = image(x) - x
        except ValueError:
            halvings += 1
            if not points or halvings > _MOST_HALVINGS:
                raise
            x = (x + points[-1]) / 2
            continue
        size, halvings = float(np.abs(residual).max()), 0
        if size < tolerance:
            return FixedPoint(x, size, evaluation)
        points, residuals = [*points, x][-_KEPT:], [*residuals, residual][-_KEPT:]
        x = x + _step(points, residuals)
    raise NoFixedPointError(
        f"no agreement after {most} iterations: what is looked for still changes by {size:.2g}"
    )


def _step(points: list[Array], residuals: list[Array]) -> Array:
    """Return the step from the last point, from the way the residuals changed on the last few."""
    step = _MIXED * residuals[-1]
    if len(points) > 1:
        moves, changes = (np.diff(np.array(each), axis=0).T for each in (points, residuals))
        shares = np.linalg.lstsq(changes, residuals[-1], rcond=_LEAST_DIRECTION)[0]
        step = step - (moves + _MIXED * changes) @ shares
    return np.clip(step, -_LONGEST, _LONGEST)
