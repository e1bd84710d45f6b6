"""What the fits share: their result, the check of their points, least squares."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeWarning, curve_fit

from crazybilliards.model.arrays import Array, check_numbers
from crazybilliards.model.checks import refuse_units, shown


@dataclass(frozen=True)
class Fit:
    """A fitted curve: call it with x to get its values.

    Every number is an attribute too, a standard error as ``NAME_error``: ``fit.exponent``,
    ``fit.exponent_error``, ``fit.misfit``.

    Attributes
    ----------
    parameters, errors
        The parameters of the curve and their standard errors, by name.
    curve
        The function of x and the parameters, by name.
    quality
        How well the curve agrees with the points, and other numbers of the fit, by name.
    """

    parameters: Mapping[str, float]
    errors: Mapping[str, float]
    curve: Callable[..., Array] = field(repr=False)
    quality: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Make every number an attribute."""
        of_errors = {f"{name}_error": error for name, error in self.errors.items()}
        vars(self).update({**self.parameters, **of_errors, **self.quality})

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __call__(self, x: ArrayLike) -> Array:
        """Return the values of the curve."""
        refuse_units("x", x)
        return np.asarray(self.curve(np.asarray(x, dtype=float), **self.parameters))


def check_points(**columns: object) -> list[Array]:
    """Return the columns as arrays; a ValueError names the arguments that do not fit."""
    arrays = [check_numbers(name, values) for name, values in columns.items()]
    shapes = [array.shape for array in arrays]
    if len(set(shapes)) > 1 or arrays[0].ndim != 1:
        raise ValueError(
            f"{', '.join(columns)} must have one dimension and the same length, got the shapes "
            f"{', '.join(map(str, shapes))}"
        )
    for name, array in zip(columns, arrays, strict=True):
        if not np.isfinite(array).all():
            raise ValueError(f"{name} must be finite, got {shown(columns[name])}")
    return arrays


def least_squares(
    what: str,
    curve: Callable[..., Array],
    points: tuple[Array, Array],
    start: tuple[float, ...],
    error: Array | None = None,
) -> tuple[Array, Array, dict[str, Any]]:
    """Fit a curve to points (x, y); return its parameters, their covariance, and the quality.

    Without standard errors of y the covariance follows from the scatter, and the quality is the
    ``misfit``. With ``error`` it is ``chi_square``, the sum of the squared residuals in standard
    errors over the degrees of freedom (nan if there are none), and where this is above 1, the
    covariance is larger by it. ``what`` names the curve in the error of points that do not fit.
    """
    x, y = points
    try:
        # A step of the search may overflow. What it finds must not.
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("error", OptimizeWarning)  # there is no covariance
            values, covariance = curve_fit(
                curve, x, y, p0=start, sigma=error, absolute_sigma=error is not None, maxfev=20_000
            )
            residuals = y - curve(x, *values)
    except (RuntimeError, OptimizeWarning) as problem:
        raise ValueError(f"no {what} fits: {problem}") from problem
    if not all(np.isfinite(each).all() for each in (values, covariance, residuals)):
        raise ValueError(f"no {what} fits: the search for its parameters runs away")
    if error is None:
        return values, covariance, {"misfit": root_mean_square(residuals)}
    residuals, freedom = residuals / error, x.size - len(start)
    chi_square = float(residuals @ residuals / freedom) if freedom else math.nan
    return values, covariance * np.fmax(chi_square, 1.0), {"chi_square": chi_square}


def root_mean_square(residuals: Array) -> float:
    """Return the root mean square of residuals."""
    return float(np.sqrt(np.mean(residuals**2)))
