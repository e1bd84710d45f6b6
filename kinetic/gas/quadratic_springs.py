r"""Springs whose force is not linear: their mean force and mean slope where rods fluctuate.

A rod is displaced by x + u, x being its mean displacement and u Gaussian, with the local variance

    T/sqrt(k^2 + 4 k T/g^2)

of a lattice of springs k whose neighbours repel one another with the stiffness T/g^2, and h_uu of
its neighbourhood. Linear fluctuations feel the mean slope k = 2 K <|x + u|>.
"""

from __future__ import annotations

import numpy as np
from scipy.special import erf

from crazybilliards.model.arrays import Array

_TURNS = 20


def mean_slope(stiffness: float, x: Array, T: Array, gap: Array | float, spread: Array) -> Array:
    """Return k of quadratic springs at the cells. ``spread``: h_uu."""
    k = np.full(x.size, 2 * stiffness)
    for _ in range(_TURNS):
        local = T / np.sqrt(k**2 + 4 * k * T / gap**2)
        width = np.sqrt(local + np.maximum(spread, 0.0))
        gauss = width * np.sqrt(2 / np.pi) * np.exp(-((x / width) ** 2) / 2)
        k = 2 * stiffness * (gauss + x * erf(x / width / np.sqrt(2)))
    return k
