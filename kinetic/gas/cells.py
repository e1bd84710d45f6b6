"""Cells of neighbouring rods, and what lies between them.

Up to ``MOST`` rods a cell is one rod. Longer chains have cells of several rods in the middle, where
correlations reach far, and of one at the ends.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from crazybilliards.model import Array

MOST = 200
_SCORES, _POINTS = 5.5, 320


class Cells(NamedTuple):
    """M cells and K contacts, M - 1 of cells and two at any walls; lengths are counted in rods."""

    rods: Array  # number of rods in each, shape (M,)
    centres: Array  # label of each, from 0 to L, shape (M,)
    contacts: Array  # label of the contact between two, shape (M - 1,)
    distances: Array  # from centre to centre, shape (M - 1,)
    all_labels: Array  # of all contacts, 0 and L being walls, (K,)
    all_distances: Array  # across all contacts, (K,)
    walled: bool

    @property
    def inner(self) -> slice:
        """Which of all contacts lie between two cells."""
        return slice(1, -1) if self.walled else slice(None)

    def between(self, values: Array) -> Array:
        """Return the means at all contacts of what cells have; at a wall that of its cell."""
        return means(np.pad(values, 1, mode="edge")) if self.walled else means(values)

    def sides(self, at_contacts: Array) -> tuple[Array, Array]:
        """Return what all contacts have left and right of each cell, 0 beyond open ends."""
        values = at_contacts if self.walled else np.concatenate([[0.0], at_contacts, [0.0]])
        return values[:-1], values[1:]


def make_cells(size: int, most: int = MOST, *, walled: bool = False) -> Cells:
    """Divide ``size`` rods into at most ``most`` cells, none shorter than a rod."""
    ends = np.arange(size + 1.0)
    if size > most:
        s = np.linspace(0, 1, most + 1)
        ends = size * (s - (1 - most / size) * np.sin(2 * np.pi * s) / (2 * np.pi))
    return _between(ends, 0.5, walled)


def cells_of_points(size: int, *, walled: bool = False) -> Cells:
    """Return cells much smaller than a rod at both ends: evenly spaced normal scores of labels."""
    ends = size * ndtr(np.linspace(-_SCORES, _SCORES, _POINTS + 1))
    ends[0], ends[-1] = 0, size
    return _between(ends, 0.0, walled)


def _between(ends: Array, beyond: float, walled: bool) -> Cells:
    """Return cells between ends. ``beyond``: rods from the outermost ends to a wall."""
    ends = (ends + ends[-1] - ends[::-1]) / 2  # symmetric but for rounding
    rods, centres, labels = np.diff(ends), means(ends), ends[1:-1]
    distances, more = np.diff(centres), 1 if walled else 0
    all_labels = np.pad(labels, more, constant_values=(0.0, rods.sum()))
    all_distances = np.pad(distances, more, constant_values=rods[0] / 2 + beyond)
    return Cells(rods, centres, labels, distances, all_labels, all_distances, walled)


def means(values: Array) -> Array:
    """Return the means of neighbouring values."""
    return (values[1:] + values[:-1]) / 2


def at_distance(
    covariance: Array, places: Array, wanted: Array, distance: float, nearest: int = 1
) -> Array:
    """Return the covariance at a short distance, continued from that of different cells.

    It lies on a line across the diagonal through those of cells ``nearest`` and one more apart: on
    the diagonal is what cells add of their own, and next to it what the last collision left.
    ``covariance``, (M, M), M > nearest + 1, is that of fields at ``places``. The pairs have their
    middles at ``wanted`` and are ``distance`` rods apart.
    """
    symmetric = (covariance + covariance.T) / 2
    near_middle, near_apart, near = _side_diagonal(symmetric, places, nearest)
    far_middle, far_apart, far = _side_diagonal(symmetric, places, nearest + 1)
    further = np.interp(near_middle, far_middle, far_apart) - near_apart
    slope = (near - np.interp(near_middle, far_middle, far)) / further
    return np.asarray(np.interp(wanted, near_middle, near + slope * (near_apart - distance)))


def of_rods(covariance: Array, cells: Cells) -> Array:
    """Return the covariances of the rods i and i + r, shape (L, L), over i and r from 0.

    Along a line across the diagonal they are linear between the given ones of different cells,
    (M, M), and continued to r = 0 by :func:`at_distance`. Beyond the chain there is NaN.
    """
    size, symmetric = round(cells.rods.sum()), (covariance + covariance.T) / 2
    middles = np.arange(1, 2 * size) / 2
    apart, values = np.zeros((2, cells.rods.size, middles.size))
    values[0] = at_distance(symmetric, cells.centres, middles, 0.0)
    for k in range(1, cells.rods.size):
        places, *profiles = _side_diagonal(symmetric, cells.centres, k)
        apart[k], values[k] = (np.interp(middles, places, each) for each in profiles)
    found = np.full((size, size), np.nan)
    for line in range(middles.size):
        r = np.arange(line % 2, min(line, 2 * size - 2 - line) + 1, 2)
        found[(line - r) // 2, r] = np.interp(r, apart[:, line], values[:, line])
    return found


def _side_diagonal(covariance: Array, places: Array, apart: int) -> tuple[Array, Array, Array]:
    """Return middle, distance and covariance of all pairs that many cells apart."""
    first, second = places[:-apart], places[apart:]
    return (first + second) / 2, second - first, np.diag(covariance, apart)
