r"""From pair correlations to the strength of collisions.

**Collective motion.** Whole neighbourhoods move together: the displacement u of a place has the
variance h_uu, and its velocity has the same one, as the waves that displace rods far are hardly
faster than the spring. f(y, v) describes the rods within their neighbourhood, so

    T = T_f + h_uu,      noise of f:  2 Gamma (1 - h_uu) in place of 2 Gamma,

T_f being the variance of f and T that of the rods. What feeds f and the collective motion adds up
to the noise that there is. For the centre of mass alone, h_uu = 1/L.

**The force.** The force between neighbours carries the springs of all rods beyond. In the equation
of f that is P = n_f T_f, without a closure.

**What collisions take.** With w the speed at which rods meet, a collision has the impulse
(1 + e) w/2 and takes (1 - e^2) w^2/2 from the sum of v^2. So with the means over the collisions of
a contact

    Lambda = (1 - e) P <w^2>/<w> = (4/sqrt(pi)) (1 - e) P K F sqrt(Theta),

the density being gone. Theta = T - h_c is the relative temperature of all neighbours, h_c being
their covariance. K(e) of :mod:`.contact_speeds` says how much slower they are when they meet.

h_c is the mean of two values: with what the last collision of the two left, and without it, which
is continued from pairs of rods further apart. Half of all neighbours leave one another.

**Clustering.** P goes like Theta/g and Lambda like Theta^(3/2)/g, with g and Theta of the
neighbourhood, which fluctuate. To second order in the relative deviations their ratio has the mean

    F = 1 + 3/8 h_ThetaTheta - 1/2 h_gTheta,

the covariances being those of contacts next to each other. How much gaps fluctuate does not enter.

The collision terms of the kinetic equation, which are those of L independent points and take
Lambda_f = (2/sqrt(pi)) (1 - e^2) n_f T_f^(3/2), are to be multiplied by

    a = (1 - 1/L) Lambda/Lambda_f.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.correlations.one_rod import OneRod
from crazybilliards.kinetic.correlations.pair_covariance import Background, PairCovariance, Problem
from crazybilliards.kinetic.gas.cells import Cells, at_distance
from crazybilliards.kinetic.gas.contact_speeds import contact_speed
from crazybilliards.kinetic.kinetic_equation.weak_form import Factors
from crazybilliards.model.arrays import Array

_NEIGHBOUR = 1.0  # rod
_BEYOND = 2  # cells between two rods that have not hit one another
_LEAST = 0.02  # bound of Theta/T, F and 1 - h_uu on the way; at the end they must be far from it


class Closure(NamedTuple):
    """The unknowns that one-rod distribution and pair covariance must agree on, at contacts."""

    log_factor: Array  # ln a
    shared: Array  # h_c/T
    collective: Array  # h_uu
    log_clustering: Array  # ln F

    @property
    def is_possible(self) -> bool:
        """True if no unknown lies on one of the bounds to which ``implied`` keeps an iteration."""
        bounded = 1 - self.shared, 1 - self.collective, np.exp(self.log_clustering)
        return min(float(each.min()) for each in bounded) > 2 * _LEAST

    def packed(self) -> Array:
        """Return them as one vector."""
        return np.concatenate(self)

    @classmethod
    def unpacked(cls, vector: Array) -> Closure:
        """Return the unknowns of a vector."""
        return cls(*np.split(vector, 4))

    @classmethod
    def independent(cls, cells: Cells) -> Closure:
        """Return those of independent points."""
        return cls(*np.zeros((4, cells.contacts.size)))

    def factors(self, problem: Problem) -> Factors:
        """Return the factors of the kinetic equation."""
        labels = problem.cells.contacts / problem.chain.size - 0.5
        values = np.exp(self.log_factor), np.maximum(1 - self.collective, _LEAST)
        return Factors(*(PchipInterpolator(labels, each) for each in values))


def background(problem: Problem, rod: OneRod, closure: Closure) -> Background:
    """Return what pairs fluctuate about."""
    restitution = problem.chain.restitution
    variance = rod.temperature + closure.collective
    temperature = variance * np.maximum(1 - closure.shared, _LEAST)
    unclustered = 2 / (1 + restitution) * contact_speed(restitution)
    return Background(
        density=rod.force / temperature,
        gap=rod.gap,
        temperature=temperature,
        pressure=rod.force,
        strength=unclustered * np.exp(closure.log_clustering),
        shared=variance - temperature,
    )


def collective_variance(cells: Cells, pairs: PairCovariance, labels: Array) -> Array:
    """Return h_uu at labels from 0 to L, continued from pairs of different cells."""
    return at_distance(pairs.displacement, cells.centres, labels, 0.0)


def implied(problem: Problem, rod: OneRod, around: Background, pairs: PairCovariance) -> Closure:
    """Return the unknowns that follow from the distributions."""
    cells = problem.cells
    leaving, approaching = (
        at_distance(pairs.velocity, cells.centres, cells.contacts, _NEIGHBOUR, nearest)
        for nearest in (1, _BEYOND)
    )
    shared = (leaving + approaching) / 2
    mixed, temperature = (
        at_distance(each, cells.contacts, cells.contacts, _NEIGHBOUR)
        for each in (pairs.gap_temperature, pairs.temperature)
    )
    clustering = 1 + 0.375 * temperature - 0.5 * mixed
    loss = around.strength * around.density * around.temperature**1.5
    return Closure(
        np.log(_even((1 - 1 / problem.chain.size) * loss / rod.cubes)),
        np.minimum(_even(shared / (around.temperature + around.shared)), 1 - _LEAST),
        np.minimum(_even(collective_variance(cells, pairs, cells.contacts)), 1 - _LEAST),
        np.log(np.maximum(_even(clustering), _LEAST)),
    )


def _even(values: Array) -> Array:
    """Average over a contact and its mirror image: rounding must not break the symmetry."""
    return (values + values[::-1]) / 2
