r"""The kinetic equation for restitution near 1: the stationary phase-space density f(y, v).

The paper's theory holds for e = 1 only. For small 1 - e collisions act as a drag towards the local
flow (as a drive for e > 1), and f(y, v) obeys the equation of :mod:`.weak_form`,

    v f_y - (F/m) f_v = d/dv [ (gamma/m) v f + (A^2/2m^2) f_v ]
                        + lambda d/dv [ f I1 ] + (lambda^2/2) d^2/dv^2 [ f I3 ],

with lambda = (1 - e)/2, int f dy dv = L, and f -> 0 far out. In the reduced coordinate
y = x - 2 R (N - L/2) the rods are points. Velocity widths and displacements follow from f without
any input from a simulation (:mod:`.order_statistics`).

The solution is found by continuation in e from e = 1, where f is Maxwellian with the density of the
force balance. The mesh follows the solution and is refined until the widths no longer change.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr

from crazybilliards.kinetic.accuracy import expected, warn_if_unmeasured
from crazybilliards.kinetic.kinetic_equation.continuation import (
    CELLS,
    State,
    check_mesh,
    continued,
    elastic_state,
    free_units,
    on_fine_mesh,
    refined,
)
from crazybilliards.kinetic.kinetic_equation.newton import NotSolvedError
from crazybilliards.kinetic.kinetic_equation.order_statistics import Rods, rods
from crazybilliards.kinetic.kinetic_equation.stationary_result import in_vocabulary, points_of
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.kinetic.kinetic_equation.weak_form import coefficients
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.kinetic.rods.places import (
    MOST_RODS_WITH_GAP,
    RodPlaces,
    are_resolved,
    at_temperature,
    elastic_rods,
    rods_of,
)
from crazybilliards.kinetic.rods.waves import displacement_widths
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_integer
from crazybilliards.model.words import check_chain

_MOST_CELLS = 80  # of a mesh that is not asked for: 22, 33, 50 and 75 cells are tried
_MOST_RODS = 100_000
# Where the equation was solved at e = 0.95 and 100 rods; s, W: a free rod's widths.
_SOLVED_DAMPINGS = 0.01, 25.0
_LARGEST_SOLVED_LATTICE = 80.0


def phase_space(
    chain: Chain,
    *,
    order: Literal[1, 2] | None = None,
    tolerance: float = 2e-3,
    cells: int | None = None,
) -> xr.Dataset:
    """Solve the kinetic equation of this module for the stationary state.

    Parameters
    ----------
    chain
        The chain, with a restitution near 1 (0.9 to 1.05 gives good results), both springs, and
        up to 100 000 rods. A gap enters f in mean field.
    order
        Order of the collision operator in lambda. None: 2 for e <= 1 and 1 for e > 1, which
        agree with simulations. The module of the equation gives the reason.
    tolerance
        The mesh is refined until no velocity width changes by more than this fraction.
    cells
        A fixed mesh instead: the number of cells from its centre to its end in each direction,
        up to 150. The memory is 40 kB times its square, 0.9 GB for 150.

    Returns
    -------
    xarray.Dataset
        ``phase_space_density`` over (y, velocity); ``density`` and ``label`` of the rods over x,
        and there ``displacement``, ``velocity_variance``, ``flow_velocity`` and ``heat_flux`` of
        the points, as in a fluid; ``velocity_width``, ``mean_displacement`` and
        ``displacement_width`` over particle. Of more than 10 000 rods, or 3000 with a gap, the
        density is that of a fluid (``attrs["density_of"]``), and with a gap there is no
        ``displacement_width``.
        ``attrs``: ``residual``, the last Newton step relative to max f; ``mesh_error``, the
        largest relative change of a velocity width in the last refinement (NaN if ``cells`` was
        given); ``cells``; and the errors of the theory in simulations of chains like this one,
        NaN where none was measured: ``velocity_width_model_error`` and ``border_model_error``,
        relative, of W_v of the particles 3 to L - 2 and of the first and the last;
        ``displacement_width_model_error``, relative, of W_x; ``mean_displacement_model_error``, in
        thermal lengths; ``density_model_error``, of the smoothed density, relative to close
        packing. An ``UnmeasuredWarning`` says that ``velocity_width_model_error`` is not known.
        The flow velocity should vanish, and is below 1e-9 W wherever there are rods.

    Notes
    -----
    Compared with simulations (L = 100, gamma = 1, particles 3 to L - 2) velocity widths are
    within 1.2 % for e = 0.95 to 1, 1.3 % at 0.9, and 6.9 % at 0.8. Displacement widths of all
    rods are within 5 % at 0.95 and 7 % at 0.9 (:mod:`crazybilliards.kinetic.rods.waves`). With a
    gap the rods need an exact equilibrium (:mod:`crazybilliards.kinetic.rods.places`), which takes
    a second for 1000 rods.

    Raises
    ------
    ValueError
        For a wrong argument; if the chain has no steady state: no noise, damping or spring, or
        e > 1 and too many rods; if the equation cannot be solved, which is known for dampings
        outside 0.01 to 25 m W/s and gaps above 80 s/L (s and W: widths of a free rod).

    Examples
    --------
    >>> theory = phase_space(Chain(size=100, restitution=0.95))
    >>> theory.velocity_width.values[[0, 24, 49]].round(3)
    array([0.259, 0.167, 0.151])
    """
    order = check_phase_space(chain, order=order, tolerance=tolerance, cells=cells)
    try:
        state = continued(chain, elastic_state(chain, order, CELLS))
        if cells is None:
            state = refined(state, CELLS)
        found = _assemble(*on_fine_mesh(state, _rods, tolerance, cells, _MOST_CELLS))
    except NotSolvedError as error:
        raise ValueError(f"{error}: {_out_of_range(chain, order)}") from error
    warn_if_unmeasured("the kinetic equation", found.attrs["velocity_width_model_error"])
    return found


def _out_of_range(chain: Chain, order: Literal[1, 2]) -> str:
    """Return which parameters of a chain lie outside the range where the equation was solved."""
    numbers = coefficients(chain, free_units(chain), order)
    values = {
        "damping, as a multiple of m W/s": (numbers.damping, *_SOLVED_DAMPINGS),
        "gap * size, as a multiple of s": (numbers.gap, 0.0, _LARGEST_SOLVED_LATTICE),
    }
    reasons = [
        f"{name}, is {value:.3g} (solved for {low:g} to {high:g})"
        for name, (value, low, high) in values.items()
        if not low <= value <= high
    ] or ["the mesh cannot follow it"]
    return "; ".join([*reasons, "simulate takes any chain, and equilibrium any with restitution 1"])


def check_phase_space(
    chain: Chain, *, order: Literal[1, 2] | None, tolerance: float, cells: int | None
) -> Literal[1, 2]:
    """Raise for arguments that ``phase_space`` does not accept; return the order."""
    check_chain(chain)
    check_mesh(tolerance, cells)
    if chain.size > _MOST_RODS:
        raise ValueError(f"size must be at most {_MOST_RODS}, got {chain.size}")
    if order is not None:
        check_integer("order", order, least=1, most=2)
    require_chain(chain, "the kinetic equation")
    return order or (2 if chain.restitution <= 1 else 1)


def _rods(state: State) -> Rods:
    return rods(state.chain, moments(state.space, state.f), *free_units(state.chain))


def _rod_places(state: State, of_rods: Rods) -> RodPlaces:
    """Return where the rods are: the elastic chain's, moved and stretched to the theory's moments.

    The shapes of the elastic chain are closer to simulations than those of the theory's points.
    """
    chain, temperature = state.chain, state.chain.mass * float(of_rods.velocity_variance.mean())
    own = rods_of(chain, points_of(state), temperature)
    width = own.width()
    if chain.spring == "linear" and chain.size <= MOST_RODS_WITH_GAP:
        width = displacement_widths(chain, own, of_rods.velocity_variance)
    return elastic_rods(at_temperature(chain, temperature)).moved(own.mean(), width)


def _assemble(state: State, of_rods: Rods, mesh_error: float) -> xr.Dataset:
    """Put the solution into the common vocabulary."""
    chain = state.chain
    places = _rod_places(state, of_rods) if are_resolved(chain) else None
    position, width = of_rods.position, np.sqrt(of_rods.position_variance)
    if places is not None:
        position, width = places.mean(), places.width()
    variables = {
        "velocity_width": ("particle", np.sqrt(of_rods.velocity_variance)),
        "mean_displacement": ("particle", position - chain.reduced_anchors),
    }
    # With a gap each rod has its own anchor, and rods are not drawn from one distribution.
    if places is not None or chain.lattice_gap == 0:
        variables["displacement_width"] = ("particle", width)
    return in_vocabulary(
        state,
        places,
        variables,
        coordinates={},
        method={"theory": "kinetic equation", "order": state.order},
        residual=state.residual,
        mesh_error=mesh_error,
        expected=expected("phase_space", chain),
    )
