"""The density of the rods over the positions x, summed rod by rod.

Rod i, whose place in the reduced coordinate has the density p_i(y), adds p_i(x - 2R (i - (L+1)/2))
to the density at x.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crazybilliards.kinetic.rods.places import RodPlaces
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_TOGETHER = 500  # rods that are summed at once, for the memory
_RESOLVED = 0.8  # spacings of x in the width of a rod, from which on a sum over x is its integral


def over_positions(chain: Chain, x: Array, rods: RodPlaces) -> tuple[Array, Array]:
    """Return density [1/R] and label of the rods at ascending, even ``x`` [R]."""
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
    return density, ascending(label)


def ascending(values: Array) -> Array:
    """Take the ripples out of values that ascend otherwise; both directions are treated alike."""
    from_below = np.maximum.accumulate(values)
    from_above = np.minimum.accumulate(values[::-1])[::-1]
    return np.asarray((from_below + from_above) / 2)


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
