r"""From the density f(y, v) of points to the rods: order statistics, and the centre of mass.

**Order statistics.** Without a gap the points are exchangeable. If L points are drawn independently
from f, the i-th in order has a label N/L distributed as Beta(i, L + 1 - i). An average over rod i
is that of a function of the label over this distribution. This is exact at e = 1.

**Centre of mass.** For e != 1 the rods are not independent, and the leading correction is that of
the centre of mass. The noise drives every mode equally, but collisions conserve momentum and do not
act on the centre of mass. On linear springs it is a damped oscillator of mass L m for every e, with
<V^2> = W^2/L and <Y^2> = s^2/L, where W and s are those of the free rod. They replace the share
that independent points have. With the widths w_i and q_i of independent points

    W_v(i)^2 = (1 - 1/L) w_i^2 + W^2/L,
    W_x(i)^2 = q_i^2 + (s^2 + <y^2> - 2 c_i)/L,     c_i = L Cov(y_i, Y) = (1/n) int_y^inf y' n dy'.

On quadratic springs the second correction is left out, because the centre of mass is then coupled
to the other modes. Nothing is fitted. The result is exact at e = 1. The energy of all rods is exact
to first order in lambda L, because it is m W^2/2 for the centre of mass plus L - 1 times the mean
of the relative motions, in which each pair of rods collides with the drag lambda L of the kinetic
equation. The first-order term of a single rod has a relative error of order 1/L.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.special import betaincinv, ndtr, ndtri

from crazybilliards.kinetic.kinetic_equation.velocity_moments import Moments
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_NODES = 40  # of Gauss-Hermite quadrature over an order statistic's normal score
_FARTHEST = 1e-8  # labels closer to the end than this are numerical noise
_PARITY = (-1, 1, 1, -1, 1, -1, -1)  # of the fields of Moments


class Points(NamedTuple):
    """Means over the order statistics of independent points, shape (L,), in the units of f."""

    position: Array
    position_variance: Array
    velocity: Array
    velocity_variance: Array
    lever: Array  # L Cov(y_i, Y)


class Rods(NamedTuple):
    """Moments of each rod, shape (L,), in units that the function that returns them names."""

    position: Array
    position_variance: Array
    velocity_variance: Array


class LabelAverage:
    """Averages of functions of the label over Beta distributions of it, such as that of a rod."""

    def __init__(self, profiles: Moments) -> None:
        share = np.maximum(profiles.density * profiles.weights, 0.0)
        self.share = share = share / share.sum()
        below, beyond = _cumulated(share), _cumulated(share[::-1])[::-1]
        self.kept = (np.minimum(below, beyond) > _FARTHEST) & (share > _FARTHEST * share.max())
        # The smaller of the two labels is more accurate.
        self._score = np.where(below < beyond, ndtri(below), -ndtri(beyond))[self.kept]

    def nodes(self, values: Array, first: Array, second: Array) -> Array:
        """Return values, given along the profiles, at quadrature nodes of Beta(first, second)."""
        places = np.clip(_scores(first, second), self._score[0], self._score[-1])
        return np.asarray(PchipInterpolator(self._score, values[self.kept])(places))

    def mean(self, values: Array, first: Array, second: Array) -> Array:
        """Return the means over Beta(first, second); ``second`` is ``first`` backwards."""
        return np.asarray(self.nodes(values, first, second) @ _hermite()[1])


def points(size: int, profiles: Moments) -> Points:
    """Average over the order statistics of ``size`` points drawn from a distribution."""
    labels = LabelAverage(profiles)
    share, kept, weights = labels.share, labels.kept, _hermite()[1]
    mean = float(share @ profiles.y)
    lever = _cumulated((share * (profiles.y - mean))[::-1])[::-1]
    i = np.arange(1.0, size + 1)

    def over(values: Array) -> Array:
        return labels.nodes(values, i, size + 1 - i)

    position = over(profiles.y)
    flow = np.divide(profiles.flux, profiles.density, out=np.zeros_like(share), where=kept)
    covariance = np.divide(lever * profiles.weights, share, out=np.zeros_like(share), where=kept)
    velocity = over(flow)
    average = position @ weights
    speed = velocity @ weights
    return Points(
        average,
        position**2 @ weights - average**2,
        speed,
        over(profiles.variance) @ weights + velocity**2 @ weights - speed**2,
        over(covariance) @ weights,
    )


def rods(chain: Chain, profiles: Moments, length: float, velocity: float) -> Rods:
    """Return the moments [R, R/T] of the rods of a steady state, the centre of mass corrected."""
    L = chain.size
    profiles = mirrored(profiles)
    of = points(L, profiles)
    share = profiles.density * profiles.weights
    spread = float((share * profiles.y**2).sum() / share.sum())
    free_variance = chain.free_velocity_width**2 / velocity**2
    position_variance = of.position_variance
    if chain.spring == "linear":
        free_spread = chain.thermal_length**2 / length**2
        position_variance = position_variance + (free_spread + spread - 2 * of.lever) / L
    return Rods(
        length * of.position,
        length**2 * position_variance,
        velocity**2 * ((1 - 1 / L) * of.velocity_variance + free_variance / L),
    )


def mirrored(half: Moments) -> Moments:
    """Return both halves of a symmetric state."""
    half = half._replace(weights=half.weights / 2)
    return Moments(*(np.append(sign * v[::-1], v) for sign, v in zip(_PARITY, half, strict=True)))


def _cumulated(shares: Array) -> Array:
    """Return sums up to each place, with half of its own share."""
    return np.asarray(np.cumsum(shares) - shares / 2)


def _hermite() -> tuple[Array, Array]:
    nodes, weights = np.polynomial.hermite_e.hermegauss(_NODES)
    return nodes, weights / math.sqrt(2 * math.pi)


def _scores(first: Array, second: Array) -> Array:
    """Return normal scores of labels distributed as Beta(first, second), shape (..., nodes)."""
    probability = ndtr(_hermite()[0])
    # Smaller labels are more accurate, so the upper half is computed by reflection.
    lower = ndtri(betaincinv(first[:, None], second[:, None], probability))
    return np.where((first <= second)[:, None], lower, -lower[::-1, ::-1])
