r"""The largest chain with a steady state for restitution e > 1, by the kinetic equation.

For linear springs the equation without noise is homogeneous: positions and velocities can be
scaled by any factor. At the critical size the energy therefore diverges. In units in which
<v^2> = 1 the noise has the factor

    tau = W_free^2 / <v^2>,

which is 1 at e = 1 and 0 where the energy is infinite. The steady state is followed from tau = 1
down, with the drag lambda L of each tau as an unknown. In these units nothing diverges. The
critical drag depends only on the damping Gamma = gamma/sqrt(k m), because the gap drops out with
the noise:

    L_c = 2 kappa_c(Gamma)/(e - 1).

For weak damping each pair meets once in half a period and gains the energy that damping takes out
in this time, so kappa_c = (pi/2) Gamma (:mod:`.weak_damping`). The numerical solution agrees with
this to 3e-6 at Gamma = 1e-3. Below, where its matrices are hard to factorise, the closed form is
used. For strong damping Newton's method finds no critical state beyond Gamma = 3.5.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.kinetic_equation.continuation import OnMesh, followed, on_fitting_mesh
from crazybilliards.kinetic.kinetic_equation.newton import stationary_state
from crazybilliards.kinetic.kinetic_equation.velocity_space import Box, VelocitySpace, one_thread
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_drag
from crazybilliards.kinetic.kinetic_equation.weak_form import Coefficients
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.words import check_chain

_CELLS = 24
_NOISE = (0.85, 0.7, 0.4, 0.2, 0.1, 0.05, 0.025)  # values of tau
_FITTED = 4  # the last ones, for the limit
_TOLERANCE = 1e-6
_MOST_HALVINGS = 4
_WEAK, _STRONG = 1e-3, 3.5  # Gamma: the closed form below, nothing beyond
_EXTRAPOLATED = 0.2  # the error, as a share of the way to the limit


@dataclass(frozen=True)
class _State(OnMesh):
    drag: float


class CriticalValue(NamedTuple):
    """A critical value and its numerical error."""

    value: float
    error: float


def critical_size(chain: Chain) -> CriticalValue:
    """Return the number of rods from which on a chain with e > 1 has no steady state.

    It is that of the kinetic equation of first order in lambda, for linear springs. ``chain.size``
    and ``chain.gap`` do not matter. It takes about a second; a second call with the same damping
    takes no time.

    Raises
    ------
    ValueError
        For e <= 1, where chains of every size have a steady state; for quadratic springs, where
        no chain has one; for a damping gamma/sqrt(k m) above 3.5, for which there is no solver.

    Examples
    --------
    >>> critical = critical_size(Chain(restitution=1.05, damping=4.0))
    >>> round(critical.value)
    122
    """
    damping = _require_drive(chain)
    drag, error = _critical_drag(damping)
    share = (chain.restitution - 1) / 2
    return CriticalValue(drag / share, error / share)


def _require_drive(chain: Chain) -> float:
    """Return the damping gamma/sqrt(k m), or raise if the chain has no critical size."""
    check_chain(chain)
    if chain.restitution <= 1:
        raise ValueError(
            "every size has a steady state unless restitution is above 1, got "
            f"{chain.restitution:g}"
        )
    if chain.spring != "linear":
        raise ValueError(
            "with quadratic springs and e > 1 there is no critical size: rods collide the more "
            "often the faster they are, and a fluctuation large enough always runs away"
        )
    require_chain(chain, "the critical size", steady=False)
    for name in ("damping", "stiffness"):
        if getattr(chain, name) == 0:
            raise ValueError(f"{name}=0: no size has a steady state with e > 1")
    return chain.relative_damping


@lru_cache(maxsize=256)
def _critical_drag(damping: float) -> tuple[float, float]:
    """Return kappa_c = |lambda| L, and its error: a fifth of the extrapolated distance."""
    if damping < _WEAK:
        drag = weak_damping_drag(damping)
        return drag, _EXTRAPOLATED * _NOISE[-1] * drag
    if damping > _STRONG:
        raise ValueError(
            f"gamma/sqrt(k m) = {damping:.3g} is too strong a damping: the critical state is known "
            f"up to {_STRONG:g}"
        )
    drags = drag_at_noise(damping, _NOISE)
    tau, kappa = np.array(_NOISE[-_FITTED:]), drags[-_FITTED:]
    limit = float(np.polynomial.Polynomial.fit(tau, kappa, _FITTED - 1)(0.0))
    return limit, _EXTRAPOLATED * abs(limit - float(drags[-1]))


@one_thread
def drag_at_noise(damping: float, noise: tuple[float, ...], cells: int = _CELLS) -> Array:
    """Return |lambda| L of the steady states whose energy is 1/tau of the free one.

    ``noise``: values of tau, descending from below 1.
    """
    space = VelocitySpace(Box(6.5, 6.5, 1.5, 1.5), cells)
    y, v = space.axes
    maxwellian = space.nodal(np.exp(-(y[:, None] ** 2 + v**2) / 2))
    state = _State(space, maxwellian / (space.whole_mass @ maxwellian), 0.0)

    def step(state: _State, tau: float) -> _State:
        def solve(guess: _State) -> _State:
            numbers = Coefficients(1.0, 2, 0.0, damping, tau * damping, guess.drag, 0.0)
            found = stationary_state(guess.space, numbers, guess.f, _TOLERANCE, of_unit_energy=True)
            return replace(guess, f=found.f, drag=found.drag)

        return on_fitting_mesh(solve(state), solve, 2)

    def refused(tau: float) -> ValueError:
        return ValueError(f"no critical state found at damping gamma/sqrt(k m) = {damping:.3g}")

    drags = []
    for reached, goal in pairwise((1.0, *noise)):
        *_, state = followed(state, step, reached, (goal,), _MOST_HALVINGS, refused)
        drags.append(-state.drag)
    return np.array(drags)
