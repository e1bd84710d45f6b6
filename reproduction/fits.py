"""Fits that the paper makes to points: growing energies, scaling, exponents, and tails."""

from functools import partial

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar
from scipy.stats import linregress

from crazybilliards.comparison.fits import Fit, check_points, least_squares, root_mean_square
from crazybilliards.model import Array
from crazybilliards.model.checks import check_integer, check_real


def fit_singularity(time: ArrayLike, energy: ArrayLike) -> Fit:
    """Fit E(t) = C (t_c - t)^-a to an energy that grows towards a divergence after the last time.

    ``scale``, ``time`` and ``exponent`` are C, t_c and a. The errors follow from the scatter about
    the fit in ln E, whose root mean square is ``misfit``. The energy of one run fluctuates about
    its mean growth, so the scatter between independent runs is a better measure. A ValueError says
    that no such law fits: t_c of an exponential growth, say, is at infinity.
    """
    t, log_E = _logarithm(time, energy, least=5)
    last, span = float(t.max()), float(np.ptp(t))

    # t_c = last + span exp(q) lies behind the data for every q.
    def model(t: Array, intercept: float, exponent: float, q: float) -> Array:
        return np.asarray(intercept - exponent * np.log((last - t) / span + np.exp(q)))

    start = (float(log_E[0]), 3.0, -2.0)
    (intercept, exponent, q), (_, exponent_error, q_error), quality = least_squares(
        "finite-time singularity", model, (t, log_E), start
    )
    log_scale = intercept + exponent * float(np.log(span))
    if not (-50 < q < 5 and exponent > 0 and abs(log_scale) < 700):  # exp overflows beyond
        raise ValueError("no finite-time singularity fits: its time runs away")
    left = float(np.exp(q))
    return Fit(
        {"scale": float(np.exp(log_scale)), "time": last + span * left, "exponent": exponent},
        {"time": span * (left * q_error), "exponent": exponent_error},
        _singularity,
        quality,
    )


def _singularity(t: Array, scale: float, time: float, exponent: float) -> Array:
    return np.asarray(scale * (time - t) ** -exponent)


def fit_growth(time: ArrayLike, energy: ArrayLike) -> Fit:
    """Fit E(t) = C exp(rate t) to an energy: ``scale`` is C, and ``rate`` is in 1/t_0.

    It is a straight line through ln E, with ``rate_error`` and ``misfit`` as in
    :func:`fit_singularity`.
    """
    t, log_energy = _logarithm(time, energy, least=3)
    if np.ptp(t) == 0:
        raise ValueError("the fit needs times that differ, and these are identical")
    line = linregress(t, log_energy)
    return Fit(
        {"scale": float(np.exp(line.intercept)), "rate": float(line.slope)},
        {"rate": float(line.stderr)},
        _growth,
        {"misfit": root_mean_square(log_energy - line.intercept - line.slope * t)},
    )


def _growth(t: Array, scale: float, rate: float) -> Array:
    return np.asarray(scale * np.exp(rate * t))


def _logarithm(time: ArrayLike, energy: ArrayLike, least: int) -> tuple[Array, Array]:
    """Return the times and ln E, if there are enough and all energies are positive."""
    t, E = check_points(time=time, energy=energy)
    if t.size < least or E.min() <= 0:
        raise ValueError(f"the fit needs at least {least} energies, all of them positive")
    return t, np.log(E)


def fit_scaling(x: ArrayLike, y: ArrayLike, error: ArrayLike) -> Fit:
    """Fit y = B x^a to positive points with standard errors: ``scale`` B and ``exponent`` a.

    Their errors follow from those of the points, and are larger by the square root of
    ``chi_square`` if the points scatter more than their errors. ``chi_square`` is the sum of the
    squared residuals in standard errors over the degrees of freedom, nan if there are none. Far
    above 1 it means that the points follow no power law.
    """
    x, y, error = check_points(x=x, y=y, error=error)
    if x.size < 2 or np.min([x, y, error]) <= 0:
        raise ValueError("a power law needs at least two points, positive, with positive errors")
    (intercept, slope), (intercept_error, slope_error), quality = least_squares(
        "power law",
        lambda log_x, a, b: a + b * log_x,
        (np.log(x), np.log(y)),
        (0.0, 0.0),
        error / y,
    )
    scale = float(np.exp(intercept))
    return Fit(
        {"scale": scale, "exponent": slope},
        {"scale": scale * intercept_error, "exponent": slope_error},
        _power_law,
        quality,
    )


def _power_law(x: Array, scale: float, exponent: float) -> Array:
    return np.asarray(scale * x**exponent)


def fit_exponential(restitution: ArrayLike, y: ArrayLike, error: ArrayLike) -> Fit:
    """Fit y = a exp(-rate (1 - e)) + d, the paper's fit of -nu against the restitution.

    ``amplitude``, ``rate`` and ``offset`` are a, the paper's lambda, and d. Their errors and
    ``chi_square`` are as in :func:`fit_scaling`.
    """
    e, y, error = check_points(restitution=restitution, y=y, error=error)
    if e.size < 3:
        raise ValueError("an exponential with offset needs at least three points")
    if error.min() <= 0:
        raise ValueError("an exponential with offset needs positive errors")
    lowest = float(y[e.argmin()])
    start = (float(y[e.argmax()]) - lowest, 5.0, lowest)
    values, errors, quality = least_squares("exponential", _saturating, (e, y), start, error)
    parameters, of_errors = (
        dict(zip(("amplitude", "rate", "offset"), numbers, strict=True))
        for numbers in (values, errors)
    )
    return Fit(parameters, of_errors, _saturating, quality)


def _saturating(e: Array, amplitude: float, rate: float, offset: float) -> Array:
    return np.asarray(amplitude * np.exp(-rate * (1 - e)) + offset)


def fit_avalanches(count: ArrayLike, *, smallest: int = 1, largest: int | None = None) -> Fit:
    """Fit p(N) ~ N^-exponent to counts of avalanches of size 1, 2, ... by maximum likelihood.

    Sizes are fitted from ``smallest`` to ``largest`` (None: all), and the curve is the probability
    among these. ``exponent_error`` holds for independent avalanches; the scatter between runs is
    about three times larger. ``count``: number of avalanches fitted. ``distance``: of Kolmogorov
    and Smirnov, the largest difference between the measured and the fitted distribution function,
    to be compared with 1/sqrt(count).
    """
    [counts] = check_points(count=count)
    smallest = check_integer("smallest", smallest, least=1)
    largest = counts.size if largest is None else check_integer("largest", largest, least=smallest)
    chosen = slice(smallest - 1, largest)
    sizes, counts = np.arange(1.0, counts.size + 1)[chosen], counts[chosen]
    if np.count_nonzero(counts) < 2 or counts.min() < 0:
        raise ValueError(
            f"count needs avalanches of at least two of the sizes {smallest} to {largest}, and "
            "none below 0"
        )
    total, logs = float(counts.sum()), np.log(sizes)
    mean = float(counts @ logs) / total
    least = minimize_scalar(lambda a: a * mean + np.log(np.sum(sizes**-a)), bracket=(1.0, 3.0))
    exponent, curve = float(least.x), partial(_probability, sizes=sizes)
    p = curve(sizes, exponent)
    # Fisher's information of one avalanche is the variance of ln N.
    information = float(p @ logs**2 - (p @ logs) ** 2)
    return Fit(
        {"exponent": exponent},
        {"exponent": 1 / float(np.sqrt(total * information))},
        curve,
        {
            "smallest": smallest,
            "largest": int(sizes[-1]),
            "count": int(total),
            "distance": float(np.abs(np.cumsum(counts) / total - np.cumsum(p)).max()),
        },
    )


def _probability(size: Array, exponent: float, *, sizes: Array) -> Array:
    return np.asarray(size**-exponent / np.sum(sizes**-exponent))


def tail_length(velocity: ArrayLike, density: ArrayLike, beyond: float) -> float:
    """Length w of the tails p(v) ~ exp(-|v|/w) for |v| > ``beyond`` [R/t_0], of both sides.

    The maximum-likelihood estimate is the mean excess over ``beyond``: the integral of the share of
    velocities beyond v, over all v > ``beyond``, divided by that share at ``beyond``. The logarithm
    of the share is taken as linear within a bin, which is right for an exponential tail even in
    bins as wide as w. ``velocity`` holds the centres of the bins, which may differ in width.
    """
    v, p = check_points(velocity=velocity, density=density)
    beyond = check_real("beyond", beyond, signed=True)
    if v.size < 2 or not (np.diff(v) > 0).all():
        raise ValueError("velocity must ascend, over at least two bins")
    between = (v[1:] + v[:-1]) / 2
    edges = np.concatenate([[2 * v[0] - between[0]], between, [2 * v[-1] - between[-1]]])
    sides = _beyond(edges, p, beyond), _beyond(-edges[::-1], p[::-1], beyond)
    share, integral = map(sum, zip(*sides, strict=True))
    if not share > 0:
        raise ValueError(f"no velocities beyond {beyond:g}")
    return integral / share


def _beyond(edges: Array, density: Array, start: float) -> tuple[float, float]:
    """Return the share of velocities above ``start``, and the integral of that share from there."""
    counts = density * np.diff(edges)
    shares = np.append(np.cumsum(counts[::-1])[::-1], 0.0)  # above every edge
    used = (edges[1:] > start) & (shares[:-1] > 0)
    if not used.any():
        return 0.0, 0.0
    low, high = edges[:-1][used], edges[1:][used]
    at_low, at_high = shares[:-1][used], shares[1:][used]
    # No logarithm where the share ends at 0: the velocities are then evenly spread over the bin.
    fall = np.log(at_low / np.where(at_high > 0, at_high, at_low))
    begin = np.maximum(low, start)
    part = (high - begin) / (high - low)
    at_begin = np.where(at_high > 0, at_low * np.exp(-fall * (1 - part)), at_low * part)
    falling = fall > 1e-9
    mean = np.where(at_high > 0, at_begin, at_begin / 2)
    np.divide(at_begin - at_high, fall * part, out=mean, where=falling)
    return float(at_begin[0]), float(np.sum(mean * (high - begin)))
