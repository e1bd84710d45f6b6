r"""Continuation of the steady state of the kinetic equation from e = 1, on an adapted mesh.

At e = 1 the state is known. Each step changes the drag lambda L by a bounded factor. A step that
does not converge, or leaves the physical branch, is halved. Above the critical size the energy
grows without bound as e approaches its critical value. Then no step is small enough, and the error
states this reason. At the end the mesh is refined until the widths no longer change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from crazybilliards.kinetic.kinetic_equation.newton import NotSolvedError, stationary_state
from crazybilliards.kinetic.kinetic_equation.order_statistics import Rods
from crazybilliards.kinetic.kinetic_equation.velocity_moments import fitting_box
from crazybilliards.kinetic.kinetic_equation.velocity_space import Box, VelocitySpace
from crazybilliards.kinetic.kinetic_equation.weak_form import Factors, Units, coefficients
from crazybilliards.kinetic.statics.label_closure import stationary
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_integer, check_real
from crazybilliards.model.memory import require_memory

CELLS = 22  # of the mesh on which a state is found
_FINER = 1.5
_LARGEST_MESH = 150
_BYTES_PER_CELL = 4e4
_ROUGHLY = 1e-3  # tolerance of the intermediate states
_LARGEST_CHANGE = 2.2  # of the energy, in one step
_NEGATIVE = 0.03
_MOST_HALVINGS = 6


@dataclass(frozen=True)
class OnMesh:
    """A distribution on its mesh."""

    space: VelocitySpace
    f: Array


S = TypeVar("S", bound=OnMesh)


@dataclass(frozen=True)
class State(OnMesh):
    """A steady state on its mesh, in the free rod's thermal length and velocity width."""

    chain: Chain
    order: int  # of the collision operator in lambda
    residual: float
    factors: Factors | None = None  # of collisions and noise along the label

    def energy(self) -> float:
        """Mean of v^2, 1 at restitution 1."""
        return float(self.space.whole_energy @ self.f)


def check_mesh(tolerance: float, cells: int | None) -> None:
    """Raise for a tolerance or a number of cells that the theories do not take."""
    check_real("tolerance", tolerance, positive=True)
    if cells is not None:
        check_integer("cells", cells, least=4, most=_LARGEST_MESH)
    # Without ``cells`` the mesh is refined at least once, to compare two meshes.
    _require_mesh(max(CELLS, cells or round(_FINER * CELLS)))


def free_units(chain: Chain) -> Units:
    """Thermal length and velocity width of the free rod."""
    return Units(chain.thermal_length, chain.free_velocity_width)


def elastic_state(chain: Chain, order: int, cells: int) -> State:
    """Return the state at restitution 1: Maxwellian, with the density of the force balance."""
    elastic = chain.replace(restitution=1.0)
    lattice = chain.lattice_gap * chain.size / (2 * chain.thermal_length)
    reach = 6.5 if chain.spring == "linear" else 4.5
    space = VelocitySpace(Box(lattice + reach, 6.5, lattice + 1.5, 1.5), cells)
    y, v = space.axes
    log_density = stationary(elastic).profile(y)[1]
    maxwellian = space.nodal(np.exp(log_density[:, None] - v**2 / 2))
    return solved(State(space, maxwellian, elastic, order, np.nan))


def continued(chain: Chain, state: State) -> State:
    """Follow the steady state from ``state`` to the restitution of ``chain``."""
    goal = (1 - chain.restitution) / 2 * chain.size
    reached = (1 - state.chain.restitution) / 2 * chain.size

    def step(state: State, drag: float) -> State:
        # The last step goes exactly to the goal and not to a rounded neighbour.
        e = chain.restitution if drag == goal else 1 - 2 * drag / chain.size
        found = solved(replace(state, chain=chain.replace(restitution=e)), _ROUGHLY)
        _require_physical(found, state)
        return fitted(found)

    def refused(drag: float) -> ValueError:
        return _no_steady_state(chain, drag)

    for found in followed(state, step, reached, _path(goal), _MOST_HALVINGS, refused):
        if chain.restitution > 1 and abs(goal) > (limit := _limit(state, found)):
            raise _no_steady_state(chain, limit)
        state = found
    return state


def followed(
    state: S,
    step: Callable[[S, float], S],
    reached: float,
    goals: Iterable[float],
    most_halvings: int,
    refused: Callable[[float], ValueError],
) -> Iterator[S]:
    """Change a parameter from ``reached`` to each goal in turn; give out the state of every step.

    ``step`` returns the state at another value. Where it raises a ValueError, the way is halved.
    """
    halvings = 0
    for goal in goals:
        while reached != goal:
            trial = reached + (goal - reached) / 2**halvings
            try:
                state = step(state, trial)
            except ValueError as error:
                halvings += 1
                if halvings > most_halvings:
                    raise refused(trial) from error
                continue
            reached, halvings = trial, max(halvings - 1, 0)
            yield state


def _limit(before: State, after: State) -> float:
    """Estimate from above the |drag| at which 1/energy, nearly linear in it, reaches zero."""
    drags = [(s.chain.restitution - 1) / 2 * s.chain.size for s in (before, after)]
    inverses = [1 / s.energy() for s in (before, after)]
    zero = drags[1] + inverses[1] * (drags[1] - drags[0]) / (inverses[0] - inverses[1])
    # The slope varies by a third from e = 1 to the limit.
    return zero * (1.01 + 0.3 * inverses[1])


def _path(goal: float) -> Iterator[float]:
    """Intermediate drags: multiples by 2.5, from 0.5."""
    drag = 0.5
    while drag < abs(goal):
        yield drag * np.sign(goal)
        drag *= 2.5
    yield goal


def fitted(state: State) -> State:
    """Move the state to a mesh that fits it, unless the present mesh does."""
    return on_fitting_mesh(state, lambda guess: solved(guess, _ROUGHLY), 5)


def on_fitting_mesh(state: S, solve: Callable[[S], S], most: int) -> S:
    """Move the state to a mesh that fits it, in as many steps at ``most``; ``solve`` it on each."""
    for _ in range(most):
        wanted = fitting_box(state.space, state.f)
        if wanted.fits(state.space.box):
            break
        state = solve(_moved(state, VelocitySpace(wanted, state.space.cells)))
    return state


def refined(state: State, cells: int) -> State:
    """Return the state on this number of cells, converged to full accuracy."""
    return solved(_moved(state, VelocitySpace(state.space.box, cells)))


def on_fine_mesh(
    state: State,
    rods_of: Callable[[State], Rods],
    tolerance: float,
    cells: int | None,
    most_cells: int,
) -> tuple[State, Rods, float]:
    """Refine the mesh until no velocity width changes by more than ``tolerance``, relatively.

    Returns the state, its rods, and the largest change in the last refinement; with ``cells`` those
    on this mesh, and NaN. ValueError if the tolerance needs a mesh of more than ``most_cells``.
    """
    if cells is not None:
        state = refined(state, cells)
        return state, rods_of(state), np.nan
    rods = rods_of(state)
    while True:
        more = round(_FINER * state.space.cells)
        _require_mesh(more)
        state, before = refined(state, more), rods
        rods = rods_of(state)
        change = np.sqrt(before.velocity_variance / rods.velocity_variance) - 1
        error = float(np.abs(change).max())
        if error < tolerance:
            return state, rods, error
        if more * _FINER > most_cells:
            raise ValueError(
                f"the kinetic equation's widths are accurate to {error:.3g} only, not to "
                f"tolerance={tolerance:g}; cells={more} accepts that"
            )


def _require_mesh(cells: int) -> None:
    require_memory(f"cells={cells}", _BYTES_PER_CELL * cells**2)


def _moved(state: S, space: VelocitySpace) -> S:
    return replace(state, space=space, f=space.take_over(state.space, state.f))


def solved(guess: State, tolerance: float = 1e-10) -> State:
    """Return the steady state of the chain and mesh of ``guess``, found from it."""
    space = guess.space
    f = guess.f / (space.whole_mass @ guess.f)
    numbers = coefficients(guess.chain, free_units(guess.chain), guess.order)
    f, residual, _ = stationary_state(space, numbers, f, tolerance, guess.factors)
    return replace(guess, f=f, residual=residual)


def _require_physical(found: State, before: State) -> None:
    change = found.energy() / before.energy()
    if not 1 / _LARGEST_CHANGE < change < _LARGEST_CHANGE:
        raise ValueError(f"the energy changed by a factor {change:.2g} in one step")
    if found.f.min() < -_NEGATIVE * found.f.max():
        raise ValueError("the density became negative")


def _no_steady_state(chain: Chain, drag: float) -> ValueError:
    e = 1 + 2 * abs(drag) / chain.size
    if chain.restitution > 1:
        return ValueError(
            f"no steady state: with {chain.size} rods and damping={chain.damping:g} the energy "
            f"grows without bound before restitution {e:.4g}, below the {chain.restitution:g} of "
            "this chain; critical_size gives the largest size"
        )
    return NotSolvedError(
        f"the kinetic equation could not be solved at restitution {1 - 2 * drag / chain.size:.4g}"
    )
