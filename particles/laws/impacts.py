"""What single collisions exchange and take, summed up at every contact.

Clusters (see ``event_driven``) of l rods on the left and r on the right, of one mass, meet with the
closing speed w and separate with w'. With their reduced mass mu = l r/(l + r), in units of a rod's
mass, the impulse is mu (w + w'), and the collision takes the energy mu (w^2 - w'^2)/2.

The impulse also crosses the contacts within the clusters: j rods beyond a contact of the left
cluster get the share j/l of it, and in the same way on the right. The impulses at a contact
therefore add up to the momentum that all rods on one side of it lose in collisions, except of rods
with a gap that merge or hardly touch, whose w is corrected (``spring_correction.py``).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.kernels import kernel

# Rows of the sums: mu w, mu w^2/2, mu w', mu w'^2/2, momenta with what crosses within clusters.
MOMENTUM_BEFORE, ENERGY_BEFORE, MOMENTUM_AFTER, ENERGY_AFTER = range(4)


class Speeds(NamedTuple):
    """How often rods met at each contact with a speed between two edges, ascending from 0."""

    edges: NDArray[np.float64]  # (bins + 1,)
    counts: NDArray[np.int64]  # (L - 1, bins); of length 0: nothing is counted


def make_impacts(size: int) -> NDArray[np.float64]:
    """Return empty sums for ``size`` rods, shape (4, L - 1); size 0: nothing is summed."""
    return np.zeros((4, max(size - 1, 0)))


@kernel
def record_impact(contact, first, last, closing, separating, impacts):  # type: ignore[no-untyped-def]
    """Add a collision at a contact, of the clusters of the rods ``first`` to ``last``."""
    left, right = float(contact - first + 1), float(last - contact)
    mass = left * right / (left + right)
    for other in range(first, last):
        beyond = (other - first + 1) / left if other <= contact else (last - other) / right
        impacts[MOMENTUM_BEFORE, other] += beyond * mass * closing
        impacts[MOMENTUM_AFTER, other] += beyond * mass * separating
    impacts[ENERGY_BEFORE, contact] += mass * closing * closing / 2
    impacts[ENERGY_AFTER, contact] += mass * separating * separating / 2


@kernel
def record_speed(contact, closing, speeds):  # type: ignore[no-untyped-def]
    """Count the closing speed of a collision; one beyond the last edge is left out."""
    place = np.searchsorted(speeds.edges, closing, side="right") - 1
    if place < speeds.counts.shape[1]:
        speeds.counts[contact, max(place, 0)] += 1
