r"""Rods and points: the mean state of the gas seen in two ways.

Neighbours stay neighbours, so a rod has a temperature of its own. But rods that exchange their
velocities hand them on, and at e = 1 a velocity belongs to a point, which passes freely from rod to
rod. Rod i then has the mean over the labels at which the i-th of L points is found,
Beta(i, L + 1 - i).

Both are the same equations (:mod:`.mean_state`), on cells of a rod and on cells much smaller than
one. They agree inside a chain. At its open ends points are too cold for e < 1, and rods too hot.
Chains with open ends and without a gap therefore have the mean of both. A gap keeps rods at their
labels, and so do walls.

**Forces.** Without a gap, or without springs, the points are exchangeable, and both descriptions
have their forces: at the contact of the rods i and i + 1

    P = E[n T],      g = E[1/n] L/(L + 1),

over Beta(i, L - i) and Beta(i + 1, L - i + 1) of the label, i = 0 and L being walls. At e = 1 they
are exact. With a gap :mod:`.elastic_contacts` has what springs carry.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import ndtri

from crazybilliards.kinetic.gas.cells import Cells, cells_of_points
from crazybilliards.kinetic.gas.closure import Closure, Independent
from crazybilliards.kinetic.gas.elastic_contacts import contact_share
from crazybilliards.kinetic.gas.mean_state import (
    Balance,
    Medium,
    balanced,
    between,
    first_places,
    heated,
)
from crazybilliards.kinetic.gas.quadratic_springs import mean_slope
from crazybilliards.kinetic.rods.places import beta_scores
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array


class MeanState(NamedTuple):
    """What a description says of cells of rods, and of all their contacts, walls included."""

    place: Array  # y, (M,)
    temperature: Array  # T, (M,)
    contact_temperature: Array  # (K,)
    force: Array  # P, (K,)
    gap: Array  # g, (K,)


class Labels:
    """Means over the labels of exchangeable points, as matrices on their fine cells."""

    def __init__(self, medium: Medium, cells: Cells) -> None:
        self.medium, self.cells, self.fine = medium, cells, cells_of_points(medium.size)
        inner, walled = cells.contacts, medium.walled
        contacts = cells.all_labels(walled)
        self.to_contacts = self._means(self.fine.centres, inner)
        self.force_to_contacts = self._means(self.fine.contacts, inner)
        self.gap_to_contacts = self._means(self.fine.contacts, contacts + 1, medium.size + 2)
        self.gap_to_contacts *= medium.size / (medium.size + 1)
        self.to_rods = self._means(self.fine.centres, cells.centres + 0.5, medium.size + 1)
        self.place = first_places(medium, self.fine)

    @property
    def score(self) -> Array:
        """Normal scores of the labels of the fine cells."""
        return np.asarray(ndtri(self.fine.centres / self.medium.size))

    def _means(self, labels: Array, first: Array, total: float = 0.0) -> Array:
        """Return the matrix of means over Beta(first, total - first) of values at labels."""
        score = ndtri(labels / self.medium.size)
        law = beta_scores(first, (total or self.medium.size) - first)
        basis = CubicSpline(score, np.eye(score.size))
        inside = np.clip(law.places, score[0], score[-1])
        means = [w @ basis(z) for w, z in zip(law.share, inside, strict=True)]
        return np.reshape(means, (first.size, score.size))

    def balanced(self, T: Array, spread: Array) -> Balance:
        """Balance the forces of points with the temperatures T of the fine cells."""
        stress = between(T, self.medium.walled)
        balance = balanced(self.medium, self.fine, self.place, stress, spread)
        self.place = balance.place
        return balance

    def of_rods(self, balance: Balance) -> Balance:
        """Return what acts on the cells of rods: means over the labels of contacts."""
        gap, force = balance.gap, balance.force
        if not self.medium.walled:
            force = self.force_to_contacts @ force
        else:
            force = np.concatenate([force[:1], self.force_to_contacts @ force[1:-1], force[-1:]])
            gap = gap[1:-1]
        return Balance(self.to_rods @ balance.place, self.gap_to_contacts @ gap, force)

    def averaged(self, T: Array, balance: Balance) -> MeanState:
        """Return the state of points, averaged over the labels at which rods are found."""
        of, at_contacts = self.of_rods(balance), self.to_contacts @ T
        return MeanState(of.place, self.to_rods @ T, at_contacts, of.force, of.gap)


class Rods:
    """The mean state on cells of whole rods."""

    def __init__(self, chain: Chain, medium: Medium, cells: Cells, labels: Labels | None) -> None:
        self.chain, self.cells, self.labels = chain, cells, labels
        self.temperature = np.ones(cells.rods.size)
        self.place = first_places(medium, cells)

    def solve(
        self, medium: Medium, closure: Closure | Independent, e: float, spread: Array
    ) -> MeanState:
        """Solve for the state with a closure at the contacts. ``spread``: h_uu at the cells."""
        cells = self.cells
        shared = closure.at(cells.contacts, cells.centres).collective

        def forces(T: Array) -> Balance:
            if self.labels is not None:
                T, h = (_continued(values, cells, self.labels.fine) for values in (T, spread))
                return self.labels.of_rods(self.labels.balanced(T, h))
            stress = share * between(T, medium.walled)
            balance = balanced(medium, cells, self.place, stress, spread)
            self.place = balance.place
            return balance

        share = contact_share(self.chain, medium, cells, self.temperature + shared)
        T, balance = heated(
            medium, cells, self.temperature, forces, lambda T: closure.strength(T, e), shared
        )
        self.temperature = T
        at_contacts = between(T, medium.walled)
        return MeanState(balance.place, T, at_contacts, balance.force, balance.gap)


class Points:
    """The mean state on fine cells, averaged over the labels at which rods are found."""

    def __init__(self, labels: Labels) -> None:
        self.labels = labels
        self.temperature = np.ones(labels.fine.rods.size)

    def solve(
        self, medium: Medium, closure: Closure | Independent, e: float, spread: Array
    ) -> MeanState:
        """Solve for the state with a closure at the contacts. ``spread``: h_uu at the cells."""
        labels, cells, fine = self.labels, self.labels.cells, self.labels.fine
        # A point meets L - 1 of L. In the mean field T is that of the motion about the centre of
        # mass, which collisions leave alone: its share 1/L of the noise is missing as well.
        met = 1.0 if isinstance(closure, Independent) else 1 - 1 / medium.size
        along = closure.at(cells.contacts, fine.contacts)
        shared = closure.at(cells.contacts, fine.centres).collective
        h = _continued(spread, cells, fine)
        self.temperature, balance = heated(
            medium,
            fine,
            self.temperature,
            lambda T: labels.balanced(T, h),
            lambda T: met * along.strength(T, e),
            shared,
        )
        return labels.averaged(self.temperature, balance)


def _continued(values: Array, cells: Cells, fine: Cells) -> Array:
    """Return values of cells of rods at fine cells, constant beyond the outermost centres."""
    return np.interp(fine.centres, cells.centres, values)


class Descriptions:
    """The descriptions of a chain, whose mean it has."""

    def __init__(
        self, chain: Chain, medium: Medium, cells: Cells, *, mean_field: bool = False
    ) -> None:
        """``mean_field``: points alone, where they are exchangeable and there are no walls."""
        labels = Labels(medium, cells) if chain.exchangeable else None
        self.cells, self.labels = cells, labels
        self.descriptions: list[Rods | Points] = []
        points = labels is not None and not medium.walled
        if not (points and mean_field):
            self.descriptions.append(Rods(chain, medium, cells, labels))
        if labels is not None and points:
            self.descriptions.append(Points(labels))  # the last: its places are those of labels
        self.slope = np.full(cells.rods.size, medium.stiffness)

    def solve(self, medium: Medium, closure: Closure | Independent, e: float) -> MeanState:
        """Return the mean state with a closure at the contacts."""
        collective = closure.at(self.cells.contacts, self.cells.centres).collective
        spread = collective / self.slope if medium.stiffness else 0 * self.slope
        states = [each.solve(medium, closure, e, spread) for each in self.descriptions]
        state = MeanState(*(np.mean(fields, axis=0) for fields in zip(*states, strict=True)))
        if medium.exponent == 3:
            x = state.place - medium.lattice * (self.cells.centres - medium.size / 2)
            labels = self.cells.all_labels(medium.walled)
            # A rod alone has no contact.
            gap = np.interp(self.cells.centres, labels, state.gap) if labels.size else np.inf
            T = state.temperature
            self.slope = mean_slope(medium.stiffness, x, T, gap, spread)
        return state
