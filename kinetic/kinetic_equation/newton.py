"""Newton's method for the stationary states of the kinetic equation."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_matrix, hstack, vstack
from scipy.sparse.linalg import LinearOperator, SuperLU, gmres

from crazybilliards.kinetic.kinetic_equation.velocity_space import (
    VelocitySpace,
    factorised,
    one_thread,
)
from crazybilliards.kinetic.kinetic_equation.weak_form import Coefficients, Equation, Factors
from crazybilliards.model.arrays import Array

_MOST_STEPS = 12
_GMRES = 40  # Krylov vectors; 5 to 15 are needed
_SOLVED, _KEPT = 2e-2, 3  # relative residual of a Newton step, and steps with the same factors


class NotSolvedError(ValueError):
    """Newton's method found no solution, although there may be one."""


class Solution(NamedTuple):
    """A stationary distribution, the last Newton step relative to max f, and the drag."""

    f: Array
    residual: float
    drag: float


@one_thread
def stationary_state(
    space: VelocitySpace,
    numbers: Coefficients,
    guess: Array,
    tolerance: float = 1e-10,
    factors: Factors | None = None,
    *,
    of_unit_energy: bool = False,
) -> Solution:
    """Solve the stationary equation with int f = 1 by Newton's method.

    ``tolerance`` is that of the last step, relative to max f. ``factors`` are those of the terms,
    see ``Equation``. ``of_unit_energy``: with <v^2> = 1, the drag being an unknown.
    """
    f, jacobian = guess, Jacobian()
    conditions = [space.whole_mass, space.whole_energy][: 2 if of_unit_energy else 1]
    for _ in range(_MOST_STEPS):
        equation = Equation(space, numbers, factors)
        mean = equation.mean(f)
        matrix = equation.matrix(mean)
        columns = [space.whole_mass, equation.by_drag(f, mean)][: len(conditions)]
        residual = np.concatenate([-(matrix @ f), [1 - row @ f for row in conditions]])
        step = jacobian.solve(
            matrix, np.column_stack(columns), conditions, equation.variation(f), residual
        )
        f = f + step[: f.size]
        if of_unit_energy:
            numbers = numbers._replace(drag=numbers.drag + float(step[-1]))
        size = float(np.abs(step[: f.size]).max() / np.abs(f).max())
        if not math.isfinite(size):
            break
        if size < tolerance:
            return Solution(f, size, numbers.drag)
    raise NotSolvedError(f"the kinetic equation did not converge in {_MOST_STEPS} Newton steps")


class Jacobian:
    """The linear equations of Newton's steps on one mesh.

    The sparse part of the Jacobian (with frozen integrals) is factorised. It preconditions GMRES
    for the whole Jacobian, which the integrals make dense, in the next steps as well.
    """

    def __init__(self) -> None:
        self._factors: SuperLU | None = None
        self._uses = 0

    def solve(
        self,
        matrix: csc_matrix,
        columns: Array,
        rows: list[Array],
        variation: Callable[[Array], Array],
        right: Array,
    ) -> Array:
        """Solve [matrix + variation, columns; rows, 0] step = right.

        Unknowns besides f have ``columns``, as many conditions on f have ``rows``. If GMRES fails,
        it raises NotSolvedError: with a wrong step Newton's method may end where no solution is.
        """
        borders = csc_matrix(columns), csc_matrix(np.array(rows))
        corner = csc_matrix((len(rows), len(rows)))
        bordered = vstack([hstack([matrix, borders[0]]), hstack([borders[1], corner])]).tocsc()
        size = matrix.shape[0]

        def step_with(factors: SuperLU, cycles: int) -> tuple[Array, int]:
            def apply(x: Array) -> Array:
                image = bordered @ x
                image[:size] += variation(x[:size])
                return np.asarray(factors.solve(image))

            operator = LinearOperator(bordered.shape, matvec=apply, dtype=float)
            found: tuple[Array, int] = gmres(
                operator, factors.solve(right), rtol=_SOLVED, restart=_GMRES, maxiter=cycles
            )
            return found

        if self._factors is not None and self._uses < _KEPT:
            self._uses += 1
            step, failed = step_with(self._factors, 1)
            if not failed:
                return step
        self._factors, self._uses = factorised(bordered), 1
        step, failed = step_with(self._factors, 2)
        if failed:
            raise NotSolvedError(f"GMRES did not converge in {2 * _GMRES} iterations")
        return step
