r"""From the density f(y, v) of points to the rods: order statistics, and the centre of mass.

**Order statistics.** Without a gap the points are exchangeable. If L points are drawn independently
from f, the i-th in order has a label N/L distributed as Beta(i, L + 1 - i). An average over rod i
is that of a function of the label over this distribution. This is exact at e = 1.

**Centre of mass.** For e != 1 the rods are not independent, and the leading correction is that of
the centre of mass. The noise drives every mode equally, but collisions conserve momentum and do not
act on the centre of mass, which has <V^2> = W^2/L for every e, W being that of the free rod. This
replaces the share that independent points have. With their widths w_i

    W_v(i)^2 = (1 - 1/L) w_i^2 + W^2/L.

Nothing is fitted. The result is exact at e = 1. The energy of all rods is exact to first order in
lambda L, because it is m W^2/2 for the centre of mass plus L - 1 times the mean of the relative
motions, in which each pair of rods collides with the drag lambda L of the kinetic equation. The
first-order term of a single rod has a relative error of order 1/L. The displacement widths follow
from :mod:`crazybilliards.kinetic.rods.waves`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.special import ndtri

from crazybilliards.kinetic.kinetic_equation.velocity_moments import Moments
from crazybilliards.kinetic.rods.places import RodPlaces, beta_scores, exchangeable
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_FARTHEST = 1e-8  # labels closer to the end than this are numerical noise
_PARITY = (-1, 1, 1, -1, 1, -1, -1)  # of the fields of Moments


class Points(NamedTuple):
    """Means over the order statistics of independent points, shape (L,), in the units of f."""

    position: Array
    position_variance: Array
    velocity: Array
    velocity_variance: Array


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

    def at(self, values: Array, law: RodPlaces) -> Array:
        """Return values, given along the profiles, at the scores of a law."""
        scores = np.clip(law.places, self._score[0], self._score[-1])
        return np.asarray(PchipInterpolator(self._score, values[self.kept])(scores))

    def mean(self, values: Array, first: Array, second: Array) -> Array:
        """Return the means over Beta(first, second); ``second`` is ``first`` backwards."""
        law = beta_scores(first, second)
        return law.mean(self.at(values, law))


def points(size: int, profiles: Moments) -> Points:
    """Average over the order statistics of ``size`` points drawn from a distribution."""
    labels, law = LabelAverage(profiles), exchangeable(size)
    share, kept = labels.share, labels.kept
    flow = np.divide(profiles.flux, profiles.density, out=np.zeros_like(share), where=kept)
    position, velocity = (labels.at(values, law) for values in (profiles.y, flow))
    average, speed = law.mean(position), law.mean(velocity)
    return Points(
        average,
        law.mean(position**2) - average**2,
        speed,
        law.mean(labels.at(profiles.variance, law)) + law.mean(velocity**2) - speed**2,
    )


def rods(chain: Chain, profiles: Moments, length: float, velocity: float) -> Rods:
    """Return the moments [R, R/t_0] of the rods of a steady state.

    The velocities are corrected for the centre of mass, the positions are those of points.
    """
    L, of = chain.size, points(chain.size, mirrored(profiles))
    free_variance = chain.free_velocity_width**2 / velocity**2
    return Rods(
        length * of.position,
        length**2 * of.position_variance,
        velocity**2 * ((1 - 1 / L) * of.velocity_variance + free_variance / L),
    )


def mirrored(half: Moments) -> Moments:
    """Return both halves of a symmetric state."""
    half = half._replace(weights=half.weights / 2)
    return Moments(*(np.append(sign * v[::-1], v) for sign, v in zip(_PARITY, half, strict=True)))


def _cumulated(shares: Array) -> Array:
    """Return sums up to each place, with half of its own share."""
    return np.asarray(np.cumsum(shares) - shares / 2)
