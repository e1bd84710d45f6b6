"""The linear solver within Newton's method: a step that it did not find is never taken."""

import numpy as np
import pytest

from crazybilliards.kinetic.kinetic_equation import newton, weak_form
from crazybilliards.kinetic.kinetic_equation.continuation import (
    continued,
    elastic_state,
    free_units,
    solved,
)
from crazybilliards.kinetic.kinetic_equation.newton import NotSolvedError, stationary_state
from crazybilliards.kinetic.kinetic_equation.weak_form import coefficients
from crazybilliards.model import Chain

CHAIN = Chain(size=100, restitution=0.9)


@pytest.fixture(scope="module")
def state():
    return solved(continued(CHAIN, elastic_state(CHAIN, 2, 12)))


@pytest.mark.parametrize(("of", "converges"), [(0.97, True), (1.05, False)])
def test_the_factors_of_another_matrix_give_the_same_solution_or_none(
    state, monkeypatch, of, converges
):
    """GMRES needs more iterations with the factors of another restitution, or finds no step."""
    numbers = coefficients(CHAIN.replace(restitution=of), free_units(CHAIN), 2)
    equation = weak_form.Equation(state.space, numbers)
    other, fresh = equation.matrix(equation.mean(state.f)), newton.factorised

    def stale(matrix):
        replaced = matrix.tolil()
        replaced[: other.shape[0], : other.shape[0]] = other
        return fresh(replaced.tocsc())

    monkeypatch.setattr(newton, "factorised", stale)
    if converges:
        np.testing.assert_allclose(
            solved(state).f, state.f, atol=1e-9 * float(np.abs(state.f).max())
        )
    else:
        with pytest.raises(NotSolvedError, match="GMRES did not converge in 80 iterations"):
            solved(state)


def test_a_step_that_was_not_found_is_not_taken(state, monkeypatch):
    monkeypatch.setattr(newton, "_GMRES", 1)
    numbers = coefficients(CHAIN.replace(restitution=0.89), free_units(CHAIN), 2)
    with pytest.raises(NotSolvedError, match="GMRES did not converge"):
        stationary_state(state.space, numbers, state.f)
