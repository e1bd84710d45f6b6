r"""The kinetic equation with pair correlations: rods that have hit one another before.

In the kinetic equation of :mod:`..kinetic_equation.stationary` colliding rods are independent of
one another. Here its collision terms carry the factor a(l) of :mod:`.closure`, which follows from
the covariances of pairs of rods of :mod:`.pair_covariance`; these follow from the density and the
temperature that the kinetic equation has. Both are solved in turn until they agree:

    f with the factor a  ->  T(l), P(l)  ->  covariances h  ->  Theta, F, h_uu  ->  a.

No number is fitted, and nothing from a simulation goes in. At e = 1 all h vanish.

f holds the rods within their neighbourhood, h_uu the motion of whole neighbourhoods, and h'_uu of
:mod:`.displacements` their displacement. With y_i, q_i and w_i the mean, width and velocity width
of the i-th of L independent points,

    <y_i> = y_i,      W_x(i)^2 = q_i^2 + h'_uu(i),      W_v(i)^2 = w_i^2 + h_uu(i).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

from crazybilliards.kinetic.correlations.closure import Closure, background, implied
from crazybilliards.kinetic.correlations.displacements import relaxing_pairs
from crazybilliards.kinetic.correlations.one_rod import profiles_of_one_rod
from crazybilliards.kinetic.correlations.pair_covariance import (
    Problem,
    linear_response,
    solve_pairs,
)
from crazybilliards.kinetic.correlations.stationary_result import Correlated, assemble, rods
from crazybilliards.kinetic.gas.fixed_point import NoFixedPointError, find_fixed_point
from crazybilliards.kinetic.kinetic_equation.continuation import (
    CELLS,
    State,
    check_mesh,
    continued,
    elastic_state,
    fitted,
    on_fine_mesh,
    refined,
    solved,
)
from crazybilliards.kinetic.kinetic_equation.newton import NotSolvedError
from crazybilliards.kinetic.kinetic_equation.order_statistics import Rods
from crazybilliards.kinetic.kinetic_equation.velocity_space import one_thread
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_MOST_CELLS = 80  # of a mesh that is not asked for
_ROUGHLY = 1e-3
_AGREEMENT = 0.5  # of the tolerance: what ln a may be off; a width changes by less than half of it
_MOST_ITERATIONS = 40
_WAY = 0.5, 0.2  # restitutions that smaller ones are reached from
_AGREEMENT_ON_THE_WAY = 0.05
# Where the theory was solved. Simulations were compared with gamma from 0.4 to 3.
_SIZES = 10, 1000
_DAMPINGS = 0.14, 1.5  # gamma/sqrt(k m)


def correlated_phase_space(
    chain: Chain, *, tolerance: float = 2e-3, cells: int | None = None
) -> xr.Dataset:
    """Solve the kinetic equation with pair correlations for the stationary state.

    Parameters
    ----------
    chain
        10 to 1000 rods on linear springs without gap, restitution 0 to 1, damping 0.14 to 1.5
        sqrt(k m).
    tolerance
        One rod and pairs are brought to agree, and the mesh is refined, until no velocity width
        changes by more, relatively.
    cells
        Cells from the centre to the end of the mesh, in each direction, instead of a refinement;
        up to 150, which takes 0.9 GB: 40 kB times their square.

    Returns
    -------
    xarray.Dataset
        What ``phase_space`` returns, and over ``contact`` (i with i + 1):
        ``neighbour_covariance`` <v_i v_{i+1}>, ``relative_temperature`` <(v_i - v_{i+1})^2>/2,
        ``contact_force``, the mean force between the two, and ``contact_loss``, the power that
        collisions take; over (particle, separation) the ``velocity_covariance`` <v_i v_{i+r}>, NaN
        beyond the chain; over ``mode`` the ``mode_velocity_variance`` <|v_q|^2> of the waves
        cos(pi q (i - 1/2)/L), q = 0 being the centre of mass. Those of the covariance
        differ from it by up to 18 % in the shortest waves of 30 and 100 rods at e = 0.5 to 0.9, and
        by 10 % at e = 0.3.
        ``attrs``: ``residual``, the largest disagreement of one rod and pairs, relative;
        ``iterations``; ``mesh_error``, the largest relative change of a velocity width in the
        last refinement (NaN if ``cells`` was given); ``cells``; and the
        errors of the theory, the same as those of ``phase_space``.

    Raises
    ------
    ValueError
        For a wrong argument; for a chain outside the range above, which names what to use there;
        if one rod and pairs cannot be brought to agree.

    Examples
    --------
    >>> theory = correlated_phase_space(Chain(size=30, restitution=0.9), cells=16)
    >>> theory.velocity_width.values[[0, 7, 14]].round(3)
    array([0.26 , 0.206, 0.194])
    """
    check_correlated_phase_space(chain, tolerance=tolerance, cells=cells)
    try:
        return assemble(*_solve(chain, tolerance, cells))
    except (NotSolvedError, NoFixedPointError) as error:
        raise ValueError(
            f"the kinetic equation with pair correlations could not be solved: {error}; "
            "phase_space and simulate take this chain"
        ) from error


def check_correlated_phase_space(chain: Chain, *, tolerance: float, cells: int | None) -> None:
    """Raise for what ``correlated_phase_space`` does not take."""
    check_mesh(tolerance, cells)
    theory = "the kinetic equation with pair correlations"
    require_chain(chain, theory, linear=True, gapless=True)
    for name, value, (low, high) in (
        ("restitution", chain.restitution, (0.0, 1.0)),
        ("size", chain.size, _SIZES),
        ("damping/sqrt(k m)", chain.relative_damping, _DAMPINGS),
    ):
        if not low <= value <= high:
            raise ValueError(
                f"{theory} has been solved for {name} from {low:g} to {high:g} only, got "
                f"{value:.4g}; phase_space and simulate take other values"
            )


@one_thread
def _solve(chain: Chain, tolerance: float, cells: int | None) -> tuple[Correlated, Rods, float]:
    """Return the solution on a mesh that is fine enough, its rods, and the error of the mesh."""
    found = in_agreement(chain, tolerance)

    def rods_of(state: State) -> Rods:
        return rods(found._replace(state=state))

    state, of_rods, error = on_fine_mesh(found.state, rods_of, tolerance, cells, _MOST_CELLS)
    return found._replace(state=state), of_rods, error


def in_agreement(chain: Chain, tolerance: float) -> Correlated:
    """Bring one rod and pairs to agreement, from the state of independent points.

    Independent points are too far from long chains at small restitutions: the iteration fails
    there. It goes by way of larger restitutions, from each to the next.
    """
    way = [chain.replace(restitution=e) for e in _WAY if e > chain.restitution]
    problems = [Problem.of(each) for each in (*way, chain)]
    state = elastic_state(problems[0].chain, 2, CELLS)
    state = refined(continued(problems[0].chain, state), CELLS)
    closure, iterations = Closure.independent(problems[0].cells), 0
    for problem in problems:
        last = problem.chain is chain
        agreement = _AGREEMENT * tolerance if last else _AGREEMENT_ON_THE_WAY
        found = _agreed(problem, state, closure, agreement)
        state, closure, iterations = found.state, found.closure, iterations + found.iterations
    return _checked(found._replace(iterations=iterations))


def _agreed(problem: Problem, state: State, closure: Closure, agreement: float) -> Correlated:
    """Find the state and closure that agree, from these two, which may be of other restitutions."""
    chain, known = problem.chain, list[Correlated]()

    def image(vector: Array) -> Array:
        nonlocal state
        closure = Closure.unpacked(vector)
        guess = replace(state, chain=chain, factors=closure.factors(problem))
        state = fitted(solved(guess, _ROUGHLY))
        rod = profiles_of_one_rod(problem.cells, state)
        around = background(problem, rod, closure)
        pairs = solve_pairs(problem, around)
        known[:] = [Correlated(problem, state, closure, around, pairs, pairs, np.nan, 0)]
        return implied(problem, rod, around, pairs).packed()

    end = find_fixed_point(image, closure.packed(), agreement, _MOST_ITERATIONS)
    return known[0]._replace(residual=end.residual, iterations=end.evaluations)


def _checked(found: Correlated) -> Correlated:
    """Add the displacements; raise if the agreement is at a bound, or not stable."""
    if not found.closure.is_possible:
        raise NoFixedPointError("the correlations are too large for a linear theory of them")
    problem, around = found.problem, found.background
    relaxing, displaced = relaxing_pairs(problem, around, found.closure.collective)
    responses = linear_response(problem, around), relaxing
    if (growth := max(each.largest_growth() for each in responses)) > 0:
        raise NoFixedPointError(f"the state is not stable: deviations grow at the rate {growth:g}")
    return found._replace(displaced=displaced)
