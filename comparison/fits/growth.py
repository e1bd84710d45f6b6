"""Fits of energies that grow exponentially or diverge at a finite time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import curve_fit

from crazybilliards.comparison.fits.points import check_points

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SingularityFit:
    """E(t) = C (t_c - t)^-a, callable for t < t_c.

    Attributes
    ----------
    scale, time, exponent
        C, the time of divergence t_c, and a.
    time_error, exponent_error
        Standard errors, from the scatter about the fit in ln E. The energy of one run fluctuates
        about its mean growth, so the scatter between independent runs is a better measure.
    misfit
        Root mean square of the residuals of ln E.
    """

    scale: float
    time: float
    exponent: float
    time_error: float
    exponent_error: float
    misfit: float

    def __call__(self, time: ArrayLike) -> Array:
        """Return C (t_c - t)^-a."""
        left = self.time - np.asarray(time, dtype=float)
        return np.asarray(self.scale * left**-self.exponent)


def fit_singularity(time: ArrayLike, energy: ArrayLike) -> SingularityFit:
    """Fit C (t_c - t)^-a to an energy that grows towards a divergence after the last time.

    Raises
    ------
    ValueError
        If there are fewer than five points, or if no such law fits. For example, t_c of an
        exponential growth is at infinity.

    Examples
    --------
    >>> t = np.linspace(0, 9.5, 40)
    >>> fit = fit_singularity(t, 3.0 * (10 - t) ** -6)
    >>> round(fit.time, 6), round(fit.exponent, 6)
    (10.0, 6.0)
    """
    t, log_energy = _logarithm(time, energy, least=5)
    last, span = float(t[-1]), float(t[-1] - t[0])

    # t_c = last + span exp(q) lies behind the data for every q.
    def model(t: Array, intercept: float, exponent: float, q: float) -> Array:
        return np.asarray(intercept - exponent * np.log((last - t) / span + np.exp(q)))

    try:
        values, covariance = curve_fit(
            model, t, log_energy, p0=(float(log_energy[0]), 3.0, -2.0), maxfev=20_000
        )
    except RuntimeError as error:
        raise ValueError(f"no finite-time singularity fits: {error}") from error
    intercept, exponent, q = map(float, values)
    if not (-50 < q < 5 and exponent > 0):
        raise ValueError("no finite-time singularity fits: its time runs away")
    errors = np.sqrt(np.diag(covariance))
    return SingularityFit(
        scale=float(np.exp(intercept + exponent * np.log(span))),
        time=last + span * float(np.exp(q)),
        exponent=exponent,
        time_error=span * float(np.exp(q) * errors[2]),
        exponent_error=float(errors[1]),
        misfit=float(np.sqrt(np.mean((model(t, *values) - log_energy) ** 2))),
    )


@dataclass(frozen=True)
class GrowthFit:
    """E(t) = C exp(rate t), callable.

    Attributes
    ----------
    scale, rate
        C and the growth rate [1/T].
    rate_error
        Standard error from the scatter of ln E; see :class:`SingularityFit`.
    misfit
        Root mean square of the residuals of ln E.
    """

    scale: float
    rate: float
    rate_error: float
    misfit: float

    def __call__(self, time: ArrayLike) -> Array:
        """Return C exp(rate t)."""
        return np.asarray(self.scale * np.exp(self.rate * np.asarray(time, dtype=float)))


def fit_growth(time: ArrayLike, energy: ArrayLike) -> GrowthFit:
    """Fit C exp(rate t) to an energy, by a straight line through ln E.

    Raises
    ------
    ValueError
        If there are fewer than three points, or an energy is not positive.

    Examples
    --------
    >>> t = np.linspace(0, 10, 5)
    >>> round(fit_growth(t, 2 * np.exp(0.3 * t)).rate, 6)
    0.3
    """
    t, log_energy = _logarithm(time, energy, least=3)
    (rate, intercept), covariance = np.polyfit(t, log_energy, 1, cov="unscaled")
    residuals = log_energy - intercept - rate * t
    misfit = float(np.sqrt(np.mean(residuals**2)))
    spread = float(np.sqrt(covariance[0, 0] * (residuals @ residuals) / (t.size - 2)))
    return GrowthFit(float(np.exp(intercept)), float(rate), spread, misfit)


def _logarithm(time: ArrayLike, energy: ArrayLike, least: int) -> tuple[Array, Array]:
    """Return the times and ln E, if there are enough and all energies are positive."""
    t, E = check_points(time=time, energy=energy)
    if t.size < least or not (np.isfinite(E).all() and E.min() > 0):
        raise ValueError(f"the fit needs at least {least} energies, all of them positive")
    return t, np.log(E)
