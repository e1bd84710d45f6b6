"""Fixed points by Anderson's acceleration."""

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from scipy import optimize

from crazybilliards.kinetic.gas.mean_state import NoSteadyStateError
from crazybilliards.model import Array

_KEPT = 5
_MIXED = 0.5  # share of the residual in a step
_MOST_ITERATIONS = 60

State = TypeVar("State")


class FixedPoint(NamedTuple, Generic[State]):
    """Where x = image(x), what was found there, the largest |image(x) - x|, and evaluations."""

    x: Array
    state: State
    residual: float
    evaluations: int


def find_fixed_point(
    image: Callable[[Array], tuple[Array, State]], start: Array, tolerance: float
) -> FixedPoint[State]:
    """Find x = image(x), to ``tolerance`` in its largest component; an image comes with a state."""
    found: list[FixedPoint[State]] = []

    def off(x: Array) -> Array:
        other, state = image(x)
        evaluations = found.pop().evaluations if found else 0
        found.append(FixedPoint(x, state, _largest(other - x), evaluations + 1))
        return other - x

    try:
        agreed = optimize.root(
            off,
            start,
            method="anderson",
            options={
                "fatol": tolerance,
                "tol_norm": _largest,
                "maxiter": _MOST_ITERATIONS - 1,  # after the first
                "line_search": None,  # it would try states far from the last one
                "jac_options": {"alpha": _MIXED, "M": _KEPT},
            },
        ).success
    except ValueError:  # also of arrays that are not finite
        if not found:
            raise
        agreed = False  # a step to where there is no image
    if not agreed:
        raise NoSteadyStateError(
            f"no agreement after {found[-1].evaluations} iterations: what is looked for still "
            f"changes by {found[-1].residual:.2g}"
        )
    return found[-1]


def _largest(residual: Array) -> float:
    return float(np.abs(residual).max())
