r"""The distribution p_i(y) of each rod's place in the reduced coordinate, and the density of all.

**Without a gap** the points are exchangeable. Of L independent points with the density n(y), of
which N(y) lie below y, the i-th in order has

    p_i(y) = n(y)/L Beta(N(y)/L; i, L + 1 - i).

This is exact at e = 1, in the steady state and, because points that exchange their names stay
independent, at any time after an independent start. **With a gap** at e = 1 and rest it follows
from the Gibbs measure.

Every distribution is a table of some places. Between them its integral is a cubic.
"""

import math
from functools import lru_cache
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.special import betainc, betaincinv, betaln, log_ndtr, ndtr, ndtri

from crazybilliards.kinetic.exact.gibbs_measure import recursion_of, weights
from crazybilliards.model import Array, Chain

# More rods are not resolved: neither by a grid of positions nor, with a gap, within seconds.
MOST_RODS, MOST_RODS_WITH_GAP = 10_000, 3000

_TOGETHER = 500  # rods that are summed at once, for the memory
_RESOLVED = 0.8  # spacings of x in the width of a rod, from which on a sum over x is its integral
_NODES = 193  # of a table
_TAIL = 1e-13  # probability beyond either end of a table


class RodPlaces(NamedTuple):
    """Distributions of the places of all rods, each a table over ascending places; shape (L, K)."""

    places: Array  # y
    below: Array  # probability of a place below
    density: Array  # p_i
    share: Array  # of the probability, for means over the table; sums to 1

    def mean(self, values: Array | None = None) -> Array:
        """Return each rod's mean of values given at the places, of the place itself if None."""
        return np.asarray((self.share * (self.places if values is None else values)).sum(axis=1))

    def width(self) -> Array:
        """Return the standard deviation of each rod's place."""
        return np.asarray(np.sqrt(self.mean((self.places - self.mean()[:, None]) ** 2)))

    def moved(self, mean: Array, width: Array) -> Self:
        """Return the rods moved and stretched to other means and standard deviations."""
        factor = (width / self.width())[:, None]
        return self.mapped(mean[:, None] + factor * (self.places - self.mean()[:, None]), factor)

    def mapped(self, places: Array, slope: Array) -> Self:
        """Return the rods with other places, of this slope over their own."""
        return self._replace(places=places, density=self.density / slope)


def are_resolved(chain: Chain) -> bool:
    """Return whether the rods of a chain are told apart."""
    return chain.size <= (MOST_RODS if chain.exchangeable else MOST_RODS_WITH_GAP)


def at_temperature(chain: Chain, temperature: float) -> Chain:
    """Return the elastic chain with this temperature, to three digits, which few chains have."""
    ratio = float(f"{temperature / chain.temperature:.3g}")
    amplitude = chain.amplitude * math.sqrt(ratio)
    return chain.replace(restitution=1.0, wall_restitution=1.0, amplitude=amplitude)


@lru_cache(maxsize=4)
def exchangeable(size: int) -> RodPlaces:
    """Return the distributions of the normal scores of independent points in order."""
    i = np.arange(1.0, size + 1)
    return beta_scores(i, size + 1 - i)


def beta_scores(first: Array, second: Array) -> RodPlaces:
    """Return laws of normal scores of Beta(first, second); ``second`` is ``first`` backwards."""
    low = np.asarray(ndtri(betaincinv(first, second, _TAIL)), dtype=float)
    score: Array = low[:, None] + np.linspace(0.0, 1.0, _NODES) * (-low[::-1] - low)[:, None]
    first, second = first[:, None], second[:, None]
    log_share = (first - 1) * log_ndtr(score) + (second - 1) * log_ndtr(-score)
    density = np.exp(log_share - betaln(first, second)) * normal(score)
    share = density / density.sum(axis=1, keepdims=True)
    return RodPlaces(score, np.asarray(betainc(first, second, ndtr(score))), density, share)


@lru_cache(maxsize=4)
def elastic_rods(chain: Chain) -> RodPlaces:
    """Return the exact rods of the elastic chain at rest."""
    if chain.lattice_gap == 0 and not chain.box:
        from scipy.stats import gennorm  # its import takes half a second, and few calls need it

        law, n, s = exchangeable(chain.size), chain.potential_exponent, chain.thermal_length
        free = gennorm(n, scale=n ** (1 / n))
        # The lower tail is the accurate one.
        u = -np.sign(law.places) * free.ppf(ndtr(-np.abs(law.places)))
        return law.mapped(s * u, s * normal(law.places) / free.pdf(u))
    recursion, L = recursion_of(chain), chain.size
    rods = RodPlaces(*np.empty((4, L, _NODES)))
    for i in range(L):
        d, p, _, _ = recursion.distribution(i)
        likely = np.flatnonzero(p > _TAIL * p.max())
        d, p = d[likely[0] : likely[-1] + 1], p[likely[0] : likely[-1] + 1]
        curve = CubicSpline(d, p)
        nodes = np.linspace(d[0], d[-1], _NODES)
        rods.places[i] = chain.reduced_anchors[i] + nodes
        rods.density[i], rods.below[i] = curve(nodes), curve.antiderivative()(nodes)
    rods.below[:] /= rods.below[:, -1:]
    # A table may end at a wall, where the density is not 0.
    weighted = rods.density * weights(_NODES)
    rods.share[:] = weighted / weighted.sum(axis=1, keepdims=True)
    return rods


def normal(score: Array) -> Array:
    """Return the standard normal density."""
    return np.asarray(np.exp(-(score**2) / 2) / math.sqrt(2 * math.pi))


def over_positions(chain: Chain, x: Array, rods: RodPlaces) -> tuple[Array, Array]:
    """Return density [1/R] and label of the rods at ascending, even ``x`` [R].

    Rod i adds p_i(x - 2R (i - (L+1)/2)) to the density at x.
    """
    shift, spacing = 2 * chain.radius * chain.rank[:, None], x[1] - x[0]
    resolved = rods.width() > _RESOLVED * spacing
    density, label = np.zeros((2, x.size))
    for first in range(0, chain.size, _TOGETHER):
        some = slice(first, first + _TOGETHER)
        rod, node, below, p = _at_nodes(x, rods.places[some] + shift[some], rods, some)
        # The points come from a grid and are a little rough: a rod that x resolves is made 1.
        held = spacing * np.bincount(rod, p, resolved[some].size)
        p = p / np.where(resolved[some] & (held > 0), held, 1.0)[rod]
        density += np.bincount(node, p, x.size)
        label += np.bincount(node, below, x.size)
    # A rod counts as one from the first node beyond its table.
    ends = np.searchsorted(x, rods.places[:, -1] + shift[:, 0], side="right")
    label += np.searchsorted(np.sort(ends), np.arange(x.size), side="right")
    # Its ripples are taken out, in both directions alike.
    from_above = np.minimum.accumulate(label[::-1])[::-1]
    return density, (np.maximum.accumulate(label) + from_above) / 2


def _at_nodes(
    x: Array, places: Array, rods: RodPlaces, some: slice
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array, Array]:
    """Return rod, node, the probability below it and the density, of all nodes in the tables."""
    first = np.searchsorted(x, places[:, 0])
    count = np.searchsorted(x, places[:, -1], side="right") - first
    rod = np.repeat(np.arange(count.size), count)
    node = np.arange(rod.size) - np.repeat(np.cumsum(count) - count, count) + first[rod]
    at, width = x[node], places.shape[1]
    # All tables in one ascending row, so that one search finds all cells.
    apart = 2 * max(float(np.ptp(x)), float(np.ptp(places)))
    row = (places + apart * np.arange(len(places))[:, None]).ravel()
    cell = np.searchsorted(row, at + apart * rod, side="right") - 1 - rod * width
    cell = np.clip(cell, 0, width - 2)
    left, step = places[rod, cell], places[rod, cell + 1] - places[rod, cell]
    below, slope = rods.below[some], rods.density[some]
    start, rise = below[rod, cell], below[rod, cell + 1] - below[rod, cell]
    # The cubic with these values and slopes at both ends of a cell.
    a, b = step * slope[rod, cell], step * slope[rod, cell + 1]
    c, d, t = 3 * rise - 2 * a - b, a + b - 2 * rise, (at - left) / step
    value = start + t * (a + t * (c + t * d))
    p = np.maximum(a + t * (2 * c + 3 * t * d), 0.0) / step
    return rod, node, np.clip(value, 0.0, 1.0), p
