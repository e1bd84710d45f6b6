"""Power laws, exponentials and divergences through points: growing energies, scaling, exponents."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from crazybilliards.comparison.fits.fit import Fit, check_points, least_squares, root_mean_square
from crazybilliards.model.arrays import Array

_OVERFLOW = 700.0  # of exp


def fit_singularity(time: ArrayLike, energy: ArrayLike) -> Fit:
    """Fit E(t) = C (t_c - t)^-a to an energy that grows towards a divergence after the last time.

    Returns
    -------
    Fit
        ``scale``, ``time`` and ``exponent``: C, t_c and a. ``time_error`` and ``exponent_error``
        are standard errors from the scatter about the fit in ln E. The energy of one run fluctuates
        about its mean growth, so the scatter between independent runs is a better measure.
        ``misfit``: root mean square of the residuals of ln E.

    Raises
    ------
    ValueError
        If there are fewer than five points, or all at one time, or if no such law fits. For
        example, t_c of an exponential growth is at infinity.

    Examples
    --------
    >>> t = np.linspace(0, 9.5, 40)
    >>> fit = fit_singularity(t, 3.0 * (10 - t) ** -6)
    >>> round(fit.time, 6), round(fit.exponent, 6)
    (10.0, 6.0)
    """
    t, log_energy = _logarithm(time, energy, least=5)
    last, span = float(t.max()), float(np.ptp(t))

    # t_c = last + span exp(q) lies behind the data for every q.
    def model(t: Array, intercept: float, exponent: float, q: float) -> Array:
        return np.asarray(intercept - exponent * np.log((last - t) / span + np.exp(q)))

    start = (float(log_energy[0]), 3.0, -2.0)
    values, covariance, quality = least_squares(
        "finite-time singularity", model, (t, log_energy), start
    )
    intercept, exponent, q = map(float, values)
    log_scale = intercept + exponent * float(np.log(span))
    if not (-50 < q < 5 and exponent > 0 and abs(log_scale) < _OVERFLOW):
        raise ValueError("no finite-time singularity fits: its time runs away")
    errors = np.sqrt(np.diag(covariance))
    return Fit(
        {
            "scale": float(np.exp(log_scale)),
            "time": last + span * float(np.exp(q)),
            "exponent": exponent,
        },
        {"time": span * float(np.exp(q) * errors[2]), "exponent": float(errors[1])},
        _singularity,
        quality,
    )


def _singularity(t: Array, scale: float, time: float, exponent: float) -> Array:
    return np.asarray(scale * (time - t) ** -exponent)


def fit_growth(time: ArrayLike, energy: ArrayLike) -> Fit:
    """Fit E(t) = C exp(rate t) to an energy, by a straight line through ln E.

    Returns
    -------
    Fit
        ``scale`` and ``rate`` [1/T]. ``rate_error`` and ``misfit`` as in :func:`fit_singularity`.

    Raises
    ------
    ValueError
        If there are fewer than three points, or all at one time, or an energy is not positive.

    Examples
    --------
    >>> t = np.linspace(0, 10, 5)
    >>> round(fit_growth(t, 2 * np.exp(0.3 * t)).rate, 6)
    0.3
    """
    t, log_energy = _logarithm(time, energy, least=3)
    (rate, intercept), covariance = np.polyfit(t, log_energy, 1, cov="unscaled")
    residuals = log_energy - intercept - rate * t
    spread = float(np.sqrt(covariance[0, 0] * (residuals @ residuals) / (t.size - 2)))
    return Fit(
        {"scale": float(np.exp(intercept)), "rate": float(rate)},
        {"rate": spread},
        _growth,
        {"misfit": root_mean_square(residuals)},
    )


def _growth(t: Array, scale: float, rate: float) -> Array:
    return np.asarray(scale * np.exp(rate * t))


def _logarithm(time: ArrayLike, energy: ArrayLike, least: int) -> tuple[Array, Array]:
    """Return the times and ln E, if there are enough and all energies are positive."""
    t, E = check_points(time=time, energy=energy)
    if t.size < least or E.min() <= 0:
        raise ValueError(f"the fit needs at least {least} energies, all of them positive")
    if np.ptp(t) == 0:
        raise ValueError(f"the fit needs energies at more than one time, got time={t[0]:g} only")
    return t, np.log(E)


def fit_scaling(x: ArrayLike, y: ArrayLike, error: ArrayLike) -> Fit:
    """Fit y = B x^a to points with standard errors, all positive.

    Returns
    -------
    Fit
        ``scale`` and ``exponent``, B and a, and their errors, which follow from those of the
        points. They are enlarged by the square root of ``chi_square`` if the points scatter more
        than their errors. ``chi_square`` is the sum of the squared residuals in standard errors,
        over the degrees of freedom; nan if there are none. A value far above 1 means that the
        points follow no power law.

    Raises
    ------
    ValueError
        If there are fewer than two points, or all at one x, or if any number is not positive.

    Examples
    --------
    >>> fit = fit_scaling([1, 10, 100], [2.0, 0.2, 0.02], [0.1, 0.01, 0.001])
    >>> round(fit.exponent, 3), round(fit.exponent_error, 3)
    (-1.0, 0.015)
    """
    x, y, error = check_points(x=x, y=y, error=error)
    if x.size < 2 or np.min([x, y, error]) <= 0:
        raise ValueError("a power law needs at least two points, positive, with positive errors")
    if np.ptp(x) == 0:
        raise ValueError(f"a power law needs more than one x, got x={x[0]:g} only")
    relative = error / y

    def line(log_x: Array, intercept: float, slope: float) -> Array:
        return np.asarray(intercept + slope * log_x)

    # Centred, so that the two parameters are nearly independent.
    middle = float(np.average(np.log(x), weights=relative**-2))
    points = np.log(x) - middle, np.log(y)
    (intercept, slope), covariance, quality = least_squares(
        "power law", line, points, (0.0, 0.0), relative
    )
    scale = float(np.exp(intercept - slope * middle))
    variance = covariance[0, 0] + middle**2 * covariance[1, 1] - 2 * middle * covariance[0, 1]
    return Fit(
        {"scale": scale, "exponent": float(slope)},
        {"scale": scale * float(np.sqrt(variance)), "exponent": float(np.sqrt(covariance[1, 1]))},
        _power_law,
        quality,
    )


def _power_law(x: Array, scale: float, exponent: float) -> Array:
    return np.asarray(scale * x**exponent)


def fit_exponential(restitution: ArrayLike, y: ArrayLike, error: ArrayLike) -> Fit:
    """Fit y = a exp(-rate (1 - e)) + d to points with standard errors.

    It is the paper's fit of -nu against the restitution.

    Returns
    -------
    Fit
        ``amplitude``, ``rate`` and ``offset``: a, the paper's lambda, and d. Their errors and
        ``chi_square`` as in :func:`fit_scaling`.

    Raises
    ------
    ValueError
        If there are fewer than three points, if an error is not positive, or if no exponential
        fits.

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
    if error.min() <= 0:
        raise ValueError("an exponential with offset needs positive errors")
    order = np.argsort(e)
    start = (float(y[order[-1]] - y[order[0]]), 5.0, float(y[order[0]]))
    values, covariance, quality = least_squares("exponential", _saturating, (e, y), start, error)
    names = ("amplitude", "rate", "offset")
    parameters, errors = (
        dict(zip(names, map(float, each), strict=True))
        for each in (values, np.sqrt(np.diag(covariance)))
    )
    return Fit(parameters, errors, _saturating, quality)


def _saturating(e: Array, amplitude: float, rate: float, offset: float) -> Array:
    return np.asarray(amplitude * np.exp(-rate * (1 - e)) + offset)
