r"""How much of the load contacts carry in a chain with a gap: phi = P g/T.

Rods that stay near their anchors seldom meet, and springs carry a part of the load. In the exact
equilibrium at e = 1 mean places and mean forces of all rods follow from the Gibbs measure
(:mod:`crazybilliards.kinetic.exact.gibbs_measure`), the force P between neighbours from the balance
of each rod, and so phi at every contact and at walls. It is taken at the temperature of the
outermost rods. Inside the chain the local one changes phi as in the uniform elastic lattice of
wells, where phi = 1 - v and v(x) is the variance of a rod over T/k at the spacing x = g sqrt(k/T)
(``studies/elastic_lattice.py``).
"""

from functools import lru_cache

import numpy as np
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.exact.recursion import recursion_of
from crazybilliards.kinetic.gas.cells import Cells
from crazybilliards.kinetic.gas.mean_state import Medium
from crazybilliards.kinetic.rods.places import at_temperature
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_SPACINGS = 0, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 2.5, 3, 4, 5, 8  # x
_SHARES = 0, 493, 972, 1438, 2328, 3163, 4315, 5971, 7305, 8329, 9060, 9792, 9973, 10_000
VARIANCES = {x: v / 10_000 for x, v in zip(_SPACINGS, _SHARES, strict=True)}  # v, to 1e-4
_VARIANCE = PchipInterpolator(list(VARIANCES), list(VARIANCES.values()))
_MOST = 1000  # rods of a gap whose exact state is computed; longer chains have the same ends
_LEAST = 1e-12  # of phi


def contact_share(chain: Chain, medium: Medium, cells: Cells, temperature: Array) -> Array:
    """Return phi at all contacts. ``temperature``: W_v^2 of the cells."""
    edge = float(temperature[[0, -1]].mean())
    places, share = _of_rods(at_temperature(chain, edge * chain.temperature))
    labels = cells.all_labels
    if len(places) < chain.size + 1:  # counted from the nearer end
        labels = np.minimum(np.minimum(labels, chain.size - labels), places[-1] / 2)
    phi = np.interp(labels, places, share)
    if chain.spring == "linear":
        x = medium.lattice * np.sqrt(medium.stiffness)
        local = cells.between(temperature)
        phi = phi * _lattice_share(x / np.sqrt(local)) / _lattice_share(x / np.sqrt(edge))
    return phi


def _lattice_share(spacing: Array | float) -> Array:
    """Return phi of the uniform lattice at a spacing in units of sqrt(T/k)."""
    return np.maximum(1 - _VARIANCE(np.minimum(spacing, max(VARIANCES))), _LEAST)


@lru_cache(maxsize=8)
def _of_rods(chain: Chain) -> tuple[Array, Array]:
    """Return the labels 0 to L and phi there, of an elastic chain with a gap."""
    if not chain.box and chain.size > _MOST:
        chain = chain.replace(size=_MOST)
    recursion, (place, force) = recursion_of(chain), np.empty((2, chain.size))
    for i in range(chain.size):
        d, _, share, _ = recursion.distribution(i)
        place[i], force[i] = chain.reduced_anchors[i] + d @ share, chain.force(d) @ share
    at_wall = chain.temperature * recursion.distribution(0)[1][0] if chain.box else 0.0
    # From both ends inwards, so that rounding does not add up: the sum of all forces vanishes.
    below = -np.concatenate([[0.0], np.cumsum(force)])
    beyond = np.concatenate([[0.0], np.cumsum(force[::-1])])[::-1]
    ends = chain.walls if chain.box else (place[0], place[-1])
    gap = np.diff(place, prepend=ends[0], append=ends[1])
    share = ((below + beyond) / 2 + at_wall) * gap / chain.temperature
    return np.arange(chain.size + 1.0), np.maximum(share, _LEAST)
