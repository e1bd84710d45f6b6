"""Cells of neighbouring rods, and what lies between them.

Up to ``MOST`` rods a cell is one rod. Longer chains have cells of several rods in the middle, where
correlations reach far, and of about one at the ends: labels at s - sin(2 pi s)/(4 pi), s even.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST = 130


class Cells(NamedTuple):
    """M cells of a chain, all lengths counted in rods."""

    rods: Array  # number of rods in each, shape (M,)
    centres: Array  # label of each, from 0 to L, shape (M,)
    contacts: Array  # label of the contact between two, shape (M - 1,)
    distances: Array  # from centre to centre, shape (M - 1,)


def make_cells(size: int, most: int = MOST) -> Cells:
    """Divide ``size`` rods into at most ``most`` cells, symmetric about the centre."""
    ends = np.arange(size + 1.0)
    if size > most:
        s = np.linspace(0, 1, most + 1)
        ends = size * (s - np.sin(2 * np.pi * s) / (4 * np.pi))
        ends = (ends + size - ends[::-1]) / 2  # symmetric but for rounding
    rods, centres = np.diff(ends), (ends[1:] + ends[:-1]) / 2
    return Cells(rods, centres, ends[1:-1], np.diff(centres))


def at_distance(covariance: Array, places: Array, wanted: Array, distance: float) -> Array:
    """Return the covariance at a short distance, continued from that of different cells.

    Along a line across the diagonal: through the covariances with the next cell and the next but
    one. The diagonal itself is left out: on it lie what cells add of their own.

    Parameters
    ----------
    covariance
        Symmetric, shape (M, M), M > 2, between fields at ``places``.
    wanted
        Middles of the pairs.
    distance
        Between the two of a pair, in rods.
    """
    symmetric = (covariance + covariance.T) / 2
    near, far = np.diag(symmetric, 1), np.diag(symmetric, 2)
    near_middle, far_middle = (places[1:] + places[:-1]) / 2, (places[2:] + places[:-2]) / 2
    near_apart = np.diff(places)
    far_apart = np.interp(near_middle, far_middle, places[2:] - places[:-2])
    slope = (near - np.interp(near_middle, far_middle, far)) / (far_apart - near_apart)
    return np.asarray(np.interp(wanted, near_middle, near + slope * (near_apart - distance)))


def of_cells(at_contacts: Array) -> Array:
    """Continue a field from the M - 1 contacts to the M cells."""
    inner = (at_contacts[1:] + at_contacts[:-1]) / 2
    return np.concatenate([at_contacts[:1], inner, at_contacts[-1:]])
