r"""Rods and points: the mean state of the gas seen in two ways.

Neighbours stay neighbours, so a rod has a temperature of its own. But rods that exchange their
velocities hand them on, and at e = 1 a velocity belongs to a point, which passes freely from rod to
rod. Rod i then has the mean over the labels of the i-th of L points, Beta(i, L + 1 - i).

Both have the same equations (:mod:`.mean_state`), on cells of a rod and on much smaller ones, and
agree inside a chain. At its open ends points are too cold for e < 1, and rods too hot. Chains with
open ends and without a gap therefore have the mean of both. Gaps and walls keep rods at labels.

**Forces.** Without a gap, or without springs, the points are exchangeable, and both descriptions
have their forces: at the contact of the rods i and i + 1

    P = E[n T],      g = E[1/n] L/(L + 1),

over Beta(i, L - i) and Beta(i + 1, L - i + 1) of the label, i = 0 and L being walls. At e = 1 they
are exact.

**With a gap** contacts carry the share phi = P g/T of the load: rods that stay near their anchors
seldom meet, and springs carry the rest. In the exact equilibrium at e = 1 mean places and mean
forces of all rods follow from the Gibbs measure
(:mod:`crazybilliards.kinetic.exact.gibbs_measure`), the force P between neighbours from the balance
of each rod, and so phi at every contact and at walls. It is taken at the temperature of the
outermost rods. Inside the chain the local one changes phi as in the uniform elastic lattice of
wells, where phi = 1 - v and v(x) is the variance of a rod over T/k at the spacing x = g sqrt(k/T)
(``studies/elastic_lattice.py``).
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.special import ndtri

from crazybilliards.kinetic.exact.gibbs_measure import recursion_of
from crazybilliards.kinetic.exact.places import (
    are_resolved,
    at_temperature,
    beta_scores,
    elastic_rods,
    exchangeable,
)
from crazybilliards.kinetic.gas.cells import Cells, cells_of_points, means
from crazybilliards.kinetic.gas.closure import Closure
from crazybilliards.kinetic.gas.mean_state import (
    Balance,
    Medium,
    balanced,
    first_places,
    heated,
    mean_slope,
)
from crazybilliards.model import Array, Chain

# v, to 1e-4, of spacings x.
VARIANCES = {
    0: 0.0,
    0.1: 0.0493,
    0.2: 0.0972,
    0.3: 0.1438,
    0.5: 0.2328,
    0.7: 0.3163,
    1: 0.4315,
    1.5: 0.5971,
    2: 0.7305,
    2.5: 0.8329,
    3: 0.9060,
    4: 0.9792,
    5: 0.9973,
    8: 1.0,
}
_VARIANCE = PchipInterpolator(list(VARIANCES), list(VARIANCES.values()))
_MOST = 1000  # rods of a gap whose exact state is computed; longer chains have the same ends
_LEAST = 1e-12  # of phi


class MeanState(NamedTuple):
    """What a description says of cells of rods, and of all their contacts, walls included."""

    place: Array  # y, (M,)
    temperature: Array  # T, (M,)
    contact_temperature: Array  # of contacts between cells, (M - 1,)
    force: Array  # P, (K,)
    gap: Array  # g, (K,)


class Labels:
    """Means over the labels of exchangeable points, as matrices on their fine cells."""

    def __init__(self, medium: Medium, cells: Cells) -> None:
        self.medium, self.cells = medium, cells
        self.fine = cells_of_points(medium.size, walled=cells.walled)
        self.score = ndtri(self.fine.centres / medium.size)
        self.to_contacts = self._means(self.fine.centres, cells.contacts)
        self.force_to_contacts = self._means(self.fine.contacts, cells.contacts)
        beside = cells.all_labels + 1
        self.gap_to_contacts = self._means(self.fine.contacts, beside, medium.size + 2)
        self.gap_to_contacts *= medium.size / (medium.size + 1)
        self.to_rods = self._means(self.fine.centres, cells.centres + 0.5, medium.size + 1)
        self.place = first_places(medium, self.fine)

    def _means(self, labels: Array, first: Array, total: float = 0.0) -> Array:
        """Return the matrix of means over Beta(first, total - first) of values at labels."""
        score = ndtri(labels / self.medium.size)
        law = beta_scores(first, (total or self.medium.size) - first)
        basis = CubicSpline(score, np.eye(score.size))
        inside = np.clip(law.places, score[0], score[-1])
        averages = [w @ basis(z) for w, z in zip(law.share, inside, strict=True)]
        return np.reshape(averages, (first.size, score.size))

    def balanced(self, T: Array, spread: Array) -> Balance:
        """Balance the forces of points with the temperatures T of the fine cells."""
        balance = balanced(self.medium, self.fine, self.place, self.fine.between(T), spread)
        self.place = balance.place
        return balance

    def of_rods(self, balance: Balance) -> Balance:
        """Return what acts on the cells of rods: means over the labels of contacts."""
        inner, ends = self.cells.inner, balance.force[[0, -1]]
        force = self.force_to_contacts @ balance.force[inner]
        if self.cells.walled:
            force = np.pad(force, 1, constant_values=(ends[0], ends[1]))
        gap = self.gap_to_contacts @ balance.gap[inner]
        return Balance(self.to_rods @ balance.place, gap, force)

    def averaged(self, T: Array, balance: Balance) -> MeanState:
        """Return the state of points, averaged over the labels at which rods are found."""
        of, at_contacts = self.of_rods(balance), self.to_contacts @ T
        return MeanState(of.place, self.to_rods @ T, at_contacts, of.force, of.gap)


class Descriptions:
    """The descriptions of a chain, whose mean it has; each begins where the last one ended."""

    def __init__(self, chain: Chain, cells: Cells, *, mean_field: bool = False) -> None:
        """``mean_field``: points alone, where they are exchangeable and there are no walls."""
        medium = Medium.of(chain)
        self.chain, self.cells, self.mean_field = chain, cells, mean_field
        self.labels = Labels(medium, cells) if chain.exchangeable else None
        self.place = first_places(medium, cells)
        self.slope = np.full(cells.rods.size, medium.stiffness)
        self.T = np.ones(cells.rods.size)
        self.T_of_points = np.ones(self.labels.fine.rods.size if self.labels else 0)

    def solve(self, medium: Medium, closure: Closure) -> MeanState:
        """Return the mean state with a closure at the contacts."""
        cells, labels = self.cells, self.labels
        shared = closure.at(cells.contacts, cells.centres).collective
        spread = shared / self.slope if medium.stiffness else 0 * self.slope
        states = []
        if labels is None or cells.walled or not self.mean_field:
            states.append(self._rods(medium, closure, shared, spread))
        if labels and not cells.walled:  # the last: its places are those of labels
            states.append(self._points(labels, medium, closure, spread))
        state = MeanState(*(np.mean(fields, axis=0) for fields in zip(*states, strict=True)))
        if medium.exponent == 3:
            # A rod alone has no contact.
            known = cells.all_labels.size > 0
            gap = np.interp(cells.centres, cells.all_labels, state.gap) if known else np.inf
            x = state.place - medium.anchors(cells)
            self.slope = mean_slope(medium, x, state.temperature, gap, spread)
        return state

    def _rods(self, medium: Medium, closure: Closure, shared: Array, spread: Array) -> MeanState:
        """Return the state on cells of whole rods. ``shared``: h, and ``spread``: h_uu at cells."""
        cells, labels = self.cells, self.labels
        share = 1.0 if labels else contact_share(self.chain, medium, cells, self.T + shared)

        def forces(T: Array) -> Balance:
            if labels:
                T, h = (np.interp(labels.fine.centres, cells.centres, each) for each in (T, spread))
                return labels.of_rods(labels.balanced(T, h))
            balance = balanced(medium, cells, self.place, share * cells.between(T), spread)
            self.place = balance.place
            return balance

        self.T, balance = heated(medium, cells, self.T, forces, closure.strength, shared)
        return MeanState(balance.place, self.T, means(self.T), balance.force, balance.gap)

    def _points(self, labels: Labels, medium: Medium, closure: Closure, spread: Array) -> MeanState:
        """Return the state on fine cells, averaged over the labels at which rods are found."""
        cells, fine = self.cells, labels.fine
        # A point meets L - 1 of L. In the mean field T is that about the centre of mass and lacks a
        # share 1/L of the noise as well.
        met = 1.0 if self.mean_field else 1 - 1 / medium.size
        along = closure.at(cells.contacts, fine.contacts)
        shared = closure.at(cells.contacts, fine.centres).collective
        h = np.interp(fine.centres, cells.centres, spread)
        self.T_of_points, balance = heated(
            medium,
            fine,
            self.T_of_points,
            lambda T: labels.balanced(T, h),
            lambda T: met * along.strength(T),
            shared,
        )
        return labels.averaged(self.T_of_points, balance)

    def widths(self, medium: Medium, state: MeanState) -> Array:
        """Return the width of each rod in its neighbourhood; NaN if rods are not resolved."""
        if not are_resolved(self.chain):
            return np.full(medium.size, np.nan)
        if labels := self.labels:
            law, ends = exchangeable(medium.size), labels.score[[0, -1]]
            y = PchipInterpolator(labels.score, labels.place)(np.clip(law.places, *ends))
            return np.asarray(np.sqrt(law.mean(y**2) - law.mean(y) ** 2))
        T = np.interp(np.arange(0.5, medium.size), self.cells.centres, state.temperature)
        mean = float(T.mean())
        elastic = elastic_rods(at_temperature(self.chain, mean * self.chain.temperature))
        return elastic.width() / medium.length * np.sqrt(T / mean)


def contact_share(chain: Chain, medium: Medium, cells: Cells, temperature: Array) -> Array:
    """Return phi at all contacts. ``temperature``: W_v^2 of the cells."""
    edge = float(temperature[[0, -1]].mean())
    places, share = _elastic_share(at_temperature(chain, edge * chain.temperature))
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
def _elastic_share(chain: Chain) -> tuple[Array, Array]:
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
