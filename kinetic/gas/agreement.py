r"""The steady state of the gas: mean state and fluctuations in agreement.

The mean state needs the strength of collisions and the motion that neighbourhoods share
(:mod:`.closure`), which follow from the fluctuations about it (:mod:`.fluctuations`). Both are
solved in turn until they agree. No number is fitted, and nothing from a simulation goes in.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.gas.cells import Cells, make_cells
from crazybilliards.kinetic.gas.closure import Closure, Independent, implied, pair_strength
from crazybilliards.kinetic.gas.descriptions import Descriptions, Labels, MeanState
from crazybilliards.kinetic.gas.displacements import relaxing_pairs
from crazybilliards.kinetic.gas.driven import driven_points
from crazybilliards.kinetic.gas.fixed_point import NoFixedPointError, find_fixed_point
from crazybilliards.kinetic.gas.fluctuations import (
    Background,
    LinearResponse,
    PairCovariance,
    Problem,
    covariances,
    linear_response,
)
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_MOST_ITERATIONS = 60
_CELLS_OF_DISPLACEMENTS = 130
_WAY = 0.9, 0.75, 0.5, 0.2  # restitutions that smaller ones are reached from
_AGREEMENT, _AGREEMENT_ON_THE_WAY = 2e-3, 0.05


class Fluctuations(NamedTuple):
    """Pairs about a mean state, and the closure that belongs to them."""

    closure: Closure
    background: Background
    response: LinearResponse
    pairs: PairCovariance


class Displaced(NamedTuple):
    """h' and the cells that it belongs to."""

    cells: Cells
    pairs: PairCovariance


class Steady(NamedTuple):
    """A steady state: the mean state and, with correlations, its fluctuations in agreement."""

    problem: Problem
    mean: MeanState
    labels: Labels | None  # of exchangeable points
    fluctuations: Fluctuations | None = None
    displaced: Displaced | None = None
    residual: float = 0.0
    iterations: int = 0
    flux: Array | None = None  # n q at the fine cells of labels; None: that of the closure


def mean_field(chain: Chain, cells: Cells) -> Steady:
    """Return the steady state in which colliding rods are independent."""
    problem = Problem.of(chain, cells)
    if is_driven(chain):
        return _driven(chain, problem)
    descriptions = Descriptions(chain, problem.medium, cells, mean_field=True)
    mean = descriptions.solve(problem.medium, Independent(), chain.restitution)
    return Steady(problem, mean, descriptions.labels)


def is_driven(chain: Chain) -> bool:
    """Return whether the points of a chain have the heavy tails that a closure does not know."""
    bare = chain.exchangeable and not chain.box and chain.spring == "linear"
    return chain.restitution > 1 and chain.size > 1 and bare


def _driven(chain: Chain, problem: Problem) -> Steady:
    """Return the mean field with the temperatures of points in phase space."""
    labels, found = Labels(problem.medium, problem.cells), driven_points(chain)
    T, flux = found.at(labels.score)
    mean = labels.averaged(T, labels.balanced(T, np.zeros(T.size)))
    return Steady(problem, mean, labels, residual=found.residual, flux=chain.size * flux)


def in_agreement(chain: Chain, cells: Cells) -> Steady:
    """Bring mean state and fluctuations of a chain with e <= 1 to agreement.

    A state without correlations is too far from long chains at small restitutions: the iteration
    fails there. It goes by way of larger restitutions, from each to the next.
    """
    closure, iterations = Closure(*np.zeros((3, cells.contacts.size))), 0
    descriptions = Descriptions(chain, Problem.of(chain, cells).medium, cells)
    for e in (*(e for e in _WAY if e > chain.restitution), chain.restitution):
        problem, known = Problem.of(chain.replace(restitution=e), cells), list[Steady]()

        def image(
            vector: Array, problem: Problem = problem, known: list[Steady] = known, e: float = e
        ) -> Array:
            known[:] = [state := _state(problem, descriptions, Closure.unpacked(vector), e)]
            of = state.fluctuations
            assert of is not None
            return implied(cells, of.background, problem.inner, of.pairs).packed()

        agreement = _AGREEMENT if e == chain.restitution else _AGREEMENT_ON_THE_WAY
        end = find_fixed_point(image, closure.packed(), agreement, _MOST_ITERATIONS)
        closure, iterations = Closure.unpacked(end.x), iterations + end.evaluations
    return _checked(known[0])._replace(residual=end.residual, iterations=iterations)


def _checked(found: Steady) -> Steady:
    """Add the displacements; raise if the agreement is at a bound, or not stable."""
    of, problem = found.fluctuations, found.problem
    assert of is not None
    if not of.closure.is_possible:
        raise NoFixedPointError("the correlations are too large for a linear theory of them")
    coarse, around, collective = _on_fewer_cells(problem, of)
    relaxing, displaced = relaxing_pairs(coarse, around, collective)
    if (growth := max(each.largest_growth() for each in (of.response, relaxing))) > 0:
        raise NoFixedPointError(f"the state is not stable: deviations grow at the rate {growth:g}")
    return found._replace(displaced=Displaced(coarse.cells, displaced))


def _on_fewer_cells(problem: Problem, of: Fluctuations) -> tuple[Problem, Background, Array]:
    """Return problem, background and K h_uu, at all contacts, on the cells of displacements.

    They vary slowly along the chain, and their equation takes longer.
    """
    cells, walled = problem.cells, problem.medium.walled
    fewer = make_cells(problem.medium.size, _CELLS_OF_DISPLACEMENTS, whole=True)
    coarse = problem._replace(cells=fewer)
    labels, wanted = cells.all_labels(walled), fewer.all_labels(walled)
    collective = np.interp(labels, cells.contacts, of.closure.collective)
    fields = {
        name: np.interp(wanted, labels, field)
        for name, field in of.background._asdict().items()
        if name != "stiffness"
    }
    slope = np.interp(fewer.centres, cells.centres, of.background.stiffness)
    around = Background(**fields, stiffness=slope)
    return coarse, around, np.interp(wanted, labels, collective)


def _state(problem: Problem, descriptions: Descriptions, closure: Closure, e: float) -> Steady:
    """Solve for the mean state with a closure, and for its fluctuations."""
    slope = descriptions.slope
    mean = descriptions.solve(problem.medium, closure, e)
    around = _background(problem, mean, slope, closure, e)
    response = linear_response(problem, around)
    pairs = covariances(problem, around, response)
    of = Fluctuations(closure, around, response, pairs)
    return Steady(problem, mean, descriptions.labels, of)


def _background(
    problem: Problem, mean: MeanState, slope: Array, closure: Closure, e: float
) -> Background:
    """Return what pairs fluctuate about; at a wall, what its rod has at its other contact."""
    inner, walled = problem.inner, problem.medium.walled

    def everywhere(values: Array) -> Array:
        return np.pad(values, 1, mode="edge") if walled else values

    T, P, gap = (each[inner] for each in (mean.contact_temperature, mean.force, mean.gap))
    Theta = closure.relative_temperature(T)
    b = pair_strength(e, closure)
    return Background(
        density=everywhere(P / Theta),
        gap=everywhere(gap),
        temperature=everywhere(Theta),
        pressure=mean.force,
        strength=np.pad(b, 1) if walled else b,
        shared=everywhere(T + closure.collective - Theta),
        stiffness=slope,
    )
