"""From the density of points over y back to the rods' positions, x = y + 2 R (N - L/2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from crazybilliards.model import Chain

Array = NDArray[np.float64]


def density_and_label(
    chain: Chain, x: Array, y: Array, points: Array, label: Array
) -> tuple[Array, Array]:
    """Return the density of the rods [1/R] and their label N at positions ``x`` [R].

    ``points`` is the density of the points [1/R] at ascending ``y`` [R], not negative. ``label`` is
    the number of points below each y, ascending. There are no rods beyond the first and last y.
    """
    places = y + 2 * chain.radius * (label - chain.size / 2)
    inside = (places[0] <= x) & (x <= places[-1])
    reduced = np.where(inside, PchipInterpolator(places, points, extrapolate=False)(x), 0.0)
    number = PchipInterpolator(places, label, extrapolate=False)(x)
    number = np.where(inside, number, np.where(x < places[0], 0.0, chain.size))
    return reduced / (1 + 2 * chain.radius * reduced), number
