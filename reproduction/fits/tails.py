"""Maximum-likelihood fits of tails, of avalanche sizes and of velocities."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from crazybilliards.comparison.fits.fit import Fit, check_points
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_integer, check_real


def fit_avalanches(count: ArrayLike, *, smallest: int = 1, largest: int | None = None) -> Fit:
    """Fit a power law p(N) ~ N^-exponent to avalanche counts by maximum likelihood.

    Parameters
    ----------
    count
        Number of avalanches of size 1, 2, 3, ..., shape (sizes,).
    smallest, largest
        Sizes to fit, inclusive; ``largest`` None: all.

    Returns
    -------
    Fit
        ``exponent``, and ``exponent_error``, its standard error for independent avalanches. The
        avalanches of one run are not independent, and the scatter between runs is about three times
        larger. The curve is the probability of a size among those that are fitted, ``smallest`` to
        ``largest``. ``count``: number of avalanches of these sizes. ``distance``: of Kolmogorov and
        Smirnov, the largest difference between the measured and the fitted distribution function.
        Compare it with 1/sqrt(count).

    Raises
    ------
    ValueError
        If the avalanches in the range do not have at least two different sizes, which would leave
        the exponent open, or if a count is negative.

    Examples
    --------
    >>> sizes = np.arange(1, 1001)
    >>> round(fit_avalanches(np.round(1e9 * sizes**-2.2)).exponent, 3)
    2.2
    """
    [counts] = check_points(count=count)
    smallest = check_integer("smallest", smallest, least=1)
    largest = counts.size if largest is None else check_integer("largest", largest, least=smallest)
    chosen = slice(smallest - 1, largest)
    sizes, counts = np.arange(1.0, counts.size + 1)[chosen], counts[chosen]
    total = float(counts.sum())
    if sizes.size < 2 or not total > 0:
        raise ValueError(f"no avalanches of sizes {smallest} to {largest} to fit")
    if counts.min() < 0 or np.count_nonzero(counts) < 2:
        raise ValueError(
            f"count needs avalanches of at least two of the sizes {smallest} to {largest}, and "
            "none below 0"
        )
    logs = np.log(sizes)
    mean = float(counts @ logs) / total

    def cost(exponent: float) -> float:
        return exponent * mean + float(np.log(np.sum(sizes**-exponent)))

    exponent = float(minimize_scalar(cost, bracket=(1.0, 3.0)).x)
    curve = partial(_probability, sizes=sizes)
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
    """Length w of the exponential tails p(v) ~ exp(-|v|/w) for |v| > ``beyond``, of both sides.

    The maximum-likelihood estimate is the mean excess over ``beyond``: the integral of the share of
    velocities beyond v, over all v > ``beyond``, divided by that share at ``beyond``. The logarithm
    of the share is taken as linear within a bin, which is right for an exponential tail even in
    bins as wide as w.

    Parameters
    ----------
    velocity, density
        Bin centres [R/T] and probability density [T/R], shape (bins,). Bins may differ in width.
    beyond
        Speed at which the tail begins [R/T].

    Raises
    ------
    ValueError
        If no velocity was measured beyond, or the velocities of the bins do not ascend.

    Examples
    --------
    >>> v = np.linspace(-60, 60, 4001)
    >>> round(tail_length(v, np.exp(-np.abs(v) / 3) / 6, beyond=2.0), 2)
    3.0
    """
    v, p = check_points(velocity=velocity, density=density)
    beyond = check_real("beyond", beyond, signed=True)
    if v.size < 2 or not (np.diff(v) > 0).all():
        raise ValueError("velocity must ascend, over at least two bins")
    between = (v[1:] + v[:-1]) / 2
    edges = np.concatenate([[2 * v[0] - between[0]], between, [2 * v[-1] - between[-1]]])
    right = _beyond(edges, p, beyond)
    left = _beyond(-edges[::-1], p[::-1], beyond)
    if not right[0] + left[0] > 0:
        raise ValueError(f"no velocities beyond {beyond:g}")
    return (right[1] + left[1]) / (right[0] + left[0])


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
    here = np.maximum(low, start)
    part = (high - here) / (high - low)
    at_here = np.where(at_high > 0, at_low * np.exp(-fall * (1 - part)), at_low * part)
    falling = fall > 1e-9
    mean = np.where(at_high > 0, at_here, at_here / 2)
    np.divide(at_here - at_high, fall * part, out=mean, where=falling)
    return float(at_here[0]), float(np.sum(mean * (high - here)))
