"""Power laws and saturating exponentials through a few points with error bars."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import curve_fit

from crazybilliards.comparison.fits.points import check_points

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ScalingFit:
    """y = B x^a, callable.

    Attributes
    ----------
    scale, exponent
        B and a.
    scale_error, exponent_error
        Their standard errors.
    chi_square
        Sum of the squared residuals in standard errors, over the degrees of freedom; nan if there
        are none. A value far above 1 means that the points follow no power law.
    """

    scale: float
    exponent: float
    scale_error: float
    exponent_error: float
    chi_square: float

    def __call__(self, x: ArrayLike) -> Array:
        """Return B x^a."""
        return np.asarray(self.scale * np.asarray(x, dtype=float) ** self.exponent)


def fit_scaling(x: ArrayLike, y: ArrayLike, error: ArrayLike) -> ScalingFit:
    """Fit y = B x^a to points with standard errors, all positive.

    Errors of the parameters follow from those of the points. They are enlarged by the square root
    of ``chi_square`` if the points scatter more than their errors.

    Raises
    ------
    ValueError
        If there are fewer than two points, or if any number is not positive.

    Examples
    --------
    >>> fit = fit_scaling([1, 10, 100], [2.0, 0.2, 0.02], [0.1, 0.01, 0.001])
    >>> round(fit.exponent, 3), round(fit.exponent_error, 3)
    (-1.0, 0.015)
    """
    x, y, error = check_points(x=x, y=y, error=error)
    if x.size < 2 or not (np.min([x, y, error]) > 0 and np.isfinite([x, y, error]).all()):
        raise ValueError("a power law needs at least two points, positive, with positive errors")
    relative = error / y

    def line(log_x: Array, intercept: float, slope: float) -> Array:
        return np.asarray(intercept + slope * log_x)

    # Centred, so that the two parameters are nearly independent.
    middle = float(np.average(np.log(x), weights=relative**-2))
    (intercept, slope), covariance = curve_fit(
        line, np.log(x) - middle, np.log(y), p0=(0.0, 0.0), sigma=relative, absolute_sigma=True
    )
    residuals = (np.log(y) - line(np.log(x) - middle, intercept, slope)) / relative
    freedom = x.size - 2
    chi_square = float(residuals @ residuals / freedom) if freedom else float("nan")
    covariance = covariance * np.fmax(chi_square, 1.0)
    scale = float(np.exp(intercept - slope * middle))
    variance = covariance[0, 0] + middle**2 * covariance[1, 1] - 2 * middle * covariance[0, 1]
    return ScalingFit(
        scale=scale,
        exponent=float(slope),
        scale_error=scale * float(np.sqrt(variance)),
        exponent_error=float(np.sqrt(covariance[1, 1])),
        chi_square=chi_square,
    )


@dataclass(frozen=True)
class ExponentialFit:
    """y = a exp(-rate (1 - e)) + d, the paper's fit of -nu against the restitution.

    Attributes
    ----------
    amplitude, rate, offset
        a, the paper's lambda, and d.
    amplitude_error, rate_error, offset_error
        Their standard errors.
    chi_square
        As in :class:`ScalingFit`.
    """

    amplitude: float
    rate: float
    offset: float
    amplitude_error: float
    rate_error: float
    offset_error: float
    chi_square: float

    def __call__(self, restitution: ArrayLike) -> Array:
        """Return a exp(-rate (1 - e)) + d."""
        e = np.asarray(restitution, dtype=float)
        return np.asarray(self.amplitude * np.exp(-self.rate * (1 - e)) + self.offset)


def fit_exponential(restitution: ArrayLike, y: ArrayLike, error: ArrayLike) -> ExponentialFit:
    """Fit y = a exp(-rate (1 - e)) + d to points with standard errors.

    Raises
    ------
    ValueError
        If there are fewer than three points, or if no exponential fits.

    Examples
    --------
    >>> e = [0.0, 0.5, 0.8, 0.9]
    >>> y = [0.4 + 0.5 * 2.718281828 ** (-6 * (1 - each)) for each in e]
    >>> round(fit_exponential(e, y, [0.01] * 4).rate, 3)
    6.0
    """
    e, y, error = check_points(restitution=restitution, y=y, error=error)
    if e.size < 3:
        raise ValueError("an exponential with offset needs at least three points")

    def model(e: Array, amplitude: float, rate: float, offset: float) -> Array:
        return np.asarray(amplitude * np.exp(-rate * (1 - e)) + offset)

    order = np.argsort(e)
    start = (float(y[order[-1]] - y[order[0]]), 5.0, float(y[order[0]]))
    try:
        values, covariance = curve_fit(
            model, e, y, p0=start, sigma=error, absolute_sigma=True, maxfev=20_000
        )
    except RuntimeError as problem:
        raise ValueError(f"no exponential fits: {problem}") from problem
    residuals = (y - model(e, *values)) / error
    freedom = e.size - 3
    chi_square = float(residuals @ residuals / freedom) if freedom else float("nan")
    errors = np.sqrt(np.diag(covariance) * np.fmax(chi_square, 1.0))
    return ExponentialFit(*map(float, (*values, *errors, chi_square)))
