r"""From pair correlations to the strength of collisions.

A contact meets at the rate of its own density and relative temperature,

    Theta = T - h_c,      n = s n_E,      s = (1 - <h_uu>/<y^2>)^(-1/2),

h_c being the covariance of the velocities of neighbours. n is the density that a rod sees; n_E,
that of f, is n smeared by the displacements that whole neighbourhoods share: their variance
h_uu (averaged over the chain) is taken out of the cloud's, <y^2>. The force between neighbours
carries what lies beyond, in both pictures, P = n_E T/s.

**Clustering.** The energy taken at a contact goes like Theta^(3/2)/g, with g and Theta of the
neighbourhood, which fluctuate: to second order in the relative deviations

    F = 1 + h_gg - 1.5 h_gTheta + 0.375 h_ThetaTheta,

the covariances being those of contacts next to each other.

**Before a collision.** Theta is a mean over all times; what a collision takes depends on the
relative velocity before it. As many rods as approach with w leave with e w, and a mean of |w|^3
over approaching and separating pairs is (1 + e^2)/2 times that of the approaching. In a cold dense
chain p = 2/(1 + e^2) corrects for it. Where damping and noise act long enough between collisions,
w^2 recovers: with tau = sqrt(pi)/(n sqrt(Theta)) between the collisions of a contact, z = 2 Gamma
tau, and w^2 relaxing as exp(-2 Gamma t) towards a value that noise holds,

    p = (1 - D q)/(1 - D (1 - q)/z),      q = exp(-z),      D = (1 - e^2)/(1 - e^2 q),

the ratio of w^2 before a collision to its mean over the cycle. It is 2/(1 + e^2) for z -> 0 and 1
for z -> inf.

The collision terms of the kinetic equation, which are those of L independent points, are to be
multiplied by

    a = (1 - 1/L) p F s (Theta/T)^(3/2).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.kinetic.correlations.cells import Cells, at_distance
from crazybilliards.kinetic.correlations.one_rod import OneRod
from crazybilliards.kinetic.correlations.pair_covariance import Background, PairCovariance

Array = NDArray[np.float64]

_NEIGHBOUR = 1.0  # rod
_LEAST = 0.02  # bound of Theta/T, F and 1/s^2 on the way; at the end they must be far from it


class Closure(NamedTuple):
    """The unknowns that one-rod distribution and pair covariance must agree on."""

    log_factor: Array  # ln a, at contacts
    shared: Array  # h_c/T, at contacts
    log_clustering: Array  # ln F, at contacts
    log_compression: float  # ln s

    @property
    def is_possible(self) -> bool:
        """Whether it is off the bounds that ``implied`` keeps an iteration within."""
        lowest = min(
            float((1 - self.shared).min()),
            float(np.exp(self.log_clustering).min()),
            float(np.exp(-2 * self.log_compression)),
        )
        return lowest > 2 * _LEAST

    def packed(self) -> Array:
        """Return them as one vector."""
        return np.concatenate([*self[:3], [self.log_compression]])

    @classmethod
    def unpacked(cls, vector: Array) -> Closure:
        """Return the unknowns of a vector."""
        factor, shared, clustering = np.split(vector[:-1], 3)
        return cls(factor, shared, clustering, float(vector[-1]))

    @classmethod
    def independent(cls, cells: Cells) -> Closure:
        """Return those of independent points."""
        zero = np.zeros(cells.contacts.size)
        return cls(zero, zero, zero, 0.0)


def recovery(restitution: float, damping: float, density: Array, temperature: Array) -> Array:
    """Return p, of contacts with these densities and relative temperatures."""
    z = 2 * damping * np.sqrt(np.pi) / (density * np.sqrt(temperature))
    lost = -np.expm1(-z)  # 1 - q, which must not cancel where rods collide often
    square = restitution**2
    # 1 - D q and 1 - D (1 - q)/z, both times 1 - e^2 q
    before = lost
    mean = 1 - square * (1 - lost) - (1 - square) * lost / z
    return np.asarray(before / mean)


def background(rod: OneRod, closure: Closure, restitution: float, damping: float) -> Background:
    """Return what pairs fluctuate about."""
    compression = np.exp(closure.log_compression)
    density = compression * rod.density
    temperature = rod.temperature * np.maximum(1 - closure.shared, _LEAST)
    before = recovery(restitution, damping, density, temperature)
    tails = rod.cubes / (rod.density * rod.temperature**1.5)
    return Background(
        density=density,
        gap=rod.gap / compression,
        temperature=temperature,
        pressure=rod.force / compression,
        strength=before * np.exp(closure.log_clustering) * tails,
        shared=rod.temperature - temperature,
    )


def implied(
    size: int, cells: Cells, rod: OneRod, around: Background, pairs: PairCovariance
) -> Closure:
    """Return the unknowns that follow from the distributions."""
    shared = at_distance(pairs.velocity, cells.centres, cells.contacts, _NEIGHBOUR)
    gap, mixed, temperature = (
        at_distance(each, cells.contacts, cells.contacts, _NEIGHBOUR)
        for each in (pairs.gap, pairs.gap_temperature, pairs.temperature)
    )
    clustering = 1 + gap - 1.5 * mixed + 0.375 * temperature
    collective = float(cells.rods @ np.diag(pairs.displacement)) / size
    loss = around.strength * around.density * around.temperature**1.5
    return Closure(
        np.log(_even((1 - 1 / size) * loss / rod.cubes)),
        np.minimum(_even(shared / rod.temperature), 1 - _LEAST),
        np.log(np.maximum(_even(clustering), _LEAST)),
        -0.5 * float(np.log(max(1 - collective / rod.spread, _LEAST))),
    )


def _even(values: Array) -> Array:
    """Average over a contact and its mirror image: rounding must not break the symmetry."""
    return (values + values[::-1]) / 2
