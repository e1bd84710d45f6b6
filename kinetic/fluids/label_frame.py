r"""Hydrodynamics on labels (Lagrangian): the unknown is the position of the rods of each label.

A label nu = N/L - 1/2 in (-1/2, 1/2) is carried by the flow, N_t + V N_x = 0, so that the
displacement <dx> is known exactly. Lengths are in thermal lengths s, velocities in W, times in s/W,
and eta(nu, t) = y/s. The continuity equation holds by construction, and the velocity equation reads

    eta_t = V,      V_t = -dp/dnu - K u |u|^(n-2) - Gamma V,        p = theta / eta_nu,

    u = eta - Lam nu,      Lam = g L/s,      Gamma = gamma s/(m W),      K = 1,

with theta = T/(m W^2), which is 1 in the isothermal case. With a temperature theta and the third
moment q of the velocities, in W^3, obey

    theta_t = -2 theta V_y - (q/eta_nu)_nu - 2 Gamma_T (theta - 1) - L a zeta theta^(3/2)/eta_nu,
    q_t = -3 theta theta_y - 3 q V_y - (3 Gamma_T + L a c sqrt(theta)/eta_nu) q,

with f_y = f_nu/eta_nu for any f, and Gamma_T = gamma <1/m> s/W. zeta, c, a and the limits of q are
those of :mod:`.equations`. The flow does not change S = theta eta_nu^2.

**Between walls** the unit of length and the strength K of the springs are those of
:mod:`crazybilliards.kinetic.statics.label_closure`. V = 0 at a wall, which is a mirror: two more
cells are the images of the outermost ones.

**Discretisation.** M cells of labels, equally wide at the edges, hold eta, V and q. S and p are
defined on the faces between them, p = kappa S/d^3 with d the distance of neighbouring cells. kappa
and the positions of the cells are calibrated on the stationary state. This state, its rigid motions
and, without a gap, every breathing motion are therefore exact for any M. The ends are free, p = 0.
At shocks there is an artificial viscosity of von Neumann and Richtmyer on the velocity jump that
remains after a limited linear reconstruction. With a temperature its work becomes heat.
"""

from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.fluids.label_cells import LabelCells, make_cells, mirrored, on_positions
from crazybilliards.kinetic.fluids.label_rates import CLOSEST, Constants, label_rate
from crazybilliards.kinetic.fluids.pde_solver import FlowFields, solve
from crazybilliards.kinetic.gas.collision_moments import decay_of_two_masses, moments_of_collisions
from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.label_closure import Stationary, stationary
from crazybilliards.model import Array, Chain

_THINNEST = 1e-6  # density of the state at rest at the walls, in L/s
_EMPTIEST = 5.0  # room of a cell at a wall at the start, in units of that at rest
_DIVERGED = 1e3  # times the energy of the start, that of springs included, or of free rods
_MOST_BROKEN = 0.5  # share of the rods whose heat flux may be at its limit


class Exchange(NamedTuple):
    """What the noise and the collisions do to the temperature and the heat flux."""

    noise: float  # Gamma_T/Gamma
    loss: float  # L a zeta
    mixing: float  # L a c


def exchange_of(chain: Chain) -> Exchange:
    """Return what a chain has: a rod collides with the L - 1 others, L a = L - 1."""
    others, moments = chain.size - 1, moments_of_collisions(chain.restitution)
    decay = moments.decay + decay_of_two_masses(chain.mass_ratio)
    noise = chain.mean_mass * float((1 / chain.rod_masses).mean())
    return Exchange(noise, others * moments.energy, others * decay)


def solve_on_labels(
    chain: Chain,
    start: Start,
    times: Array,
    number: int | None,
    *,
    thermal: bool,
    exchange: Exchange,
    progress: bool,
) -> FlowFields:
    """Solve from a start with ``number`` cells, by DOP853 of scipy through py-pde."""
    state, W = stationary(chain), chain.free_velocity_width
    s, walled = state.unit, chain.box > 0
    if walled and state.at_walls < _THINNEST / s:
        raise ValueError(
            "frame='label' needs walls that rods reach at rest, and these are too far out; use "
            "frame='eulerian' (at restitution 1) or box=0"
        )
    cells = make_cells(state, chain.potential_exponent, number)
    constants = _constants(chain, cells, state, exchange)
    fields = _starting_fields(chain, cells, state, start, thermal=thermal)
    values = np.array(list(fields.values()))
    most = _DIVERGED * max(1.0, _energy(cells, values, walled) + _spring_energy(constants, values))

    def watch(values: Array, time: float) -> bool:
        """Refuse what the equations do not describe; return whether the energy diverges."""
        if why := _breakdown(cells, values):
            raise ValueError(f"the hydrodynamic equations do not hold beyond t = {time:g}: {why}")
        return _energy(cells, values, walled) > most

    # In the unit of time of `solve`: py-pde drops outputs that are less than 1e-8 units apart.
    interval = times[1] * W / s
    # A trial step may overflow if rods are very light. The solver refuses what is not a number.
    with np.errstate(over="ignore", invalid="ignore"):
        solution = solve(
            lambda values, time: interval * label_rate(values, constants),
            fields,
            (0, cells.labels.size),  # numbers of cells that are not equally wide
            np.arange(float(times.size)),
            unit=times[1],
            progress=progress,
            watch=watch,
            solver="scipy",
            backend="numpy",  # the rate is compiled already
            method="DOP853",
            rtol=1e-7,
            atol=1e-7,
        )
    diverged = _energy(cells, solution[-1], walled) > most
    solution = solution[:-1] if diverged else solution
    rates = np.array([label_rate(values, constants)[:2] for values in solution])
    own = slice(1, -1) if walled else slice(None)
    unsteadiness = np.sqrt(np.sum(rates[..., own] ** 2, axis=1) @ cells.shares[own])
    energy = W**2 * np.array([_energy(cells, values, walled) for values in solution])
    found = on_positions(chain, cells, state, solution, unsteadiness, energy)
    return found._replace(diverged=diverged)


def _constants(chain: Chain, cells: LabelCells, state: Stationary, exchange: Exchange) -> Constants:
    gamma = chain.damping * state.unit / (chain.mass * chain.free_velocity_width)
    return Constants(
        cells.labels,
        cells.shares,
        cells.kappa,
        np.diff(cells.eta),
        lam=float(state.lam),
        stiffness=float(state.stiffness),
        damping=gamma,
        heating=exchange.noise * gamma,
        loss=exchange.loss,
        mixing=exchange.mixing,
        walled=chain.box > 0,
        exponent=chain.potential_exponent,
    )


def _temperature(cells: LabelCells, values: Array) -> Array:
    """Return theta at the faces between the cells."""
    if len(values) == 2:
        return np.ones(cells.kappa.size)
    return np.asarray(values[2, :-1] / np.diff(values[0]) ** 2)


def _energy(cells: LabelCells, values: Array, walled: bool) -> float:
    """Return the mean of v^2 over the rods: of the flow and of the heat."""
    own = slice(1, -1) if walled else slice(None)
    weights = cells.kappa.copy()
    if walled:  # half of the outermost faces' rods are images
        weights[[0, -1]] /= 2
    heat = weights @ _temperature(cells, values) / weights.sum()
    return float(cells.shares[own] @ values[1, own] ** 2 + heat)


def _spring_energy(constants: Constants, values: Array) -> float:
    """Return the mean of v^2 that rods at rest get where springs release them."""
    own, power = slice(1, -1) if constants.walled else slice(None), constants.exponent
    stretched = np.abs(values[0] - constants.lam * constants.labels)[own]
    return float(2 * constants.stiffness / power * constants.shares[own] @ stretched**power)


def _breakdown(cells: LabelCells, values: Array) -> str:
    """Return why the equations do not hold any longer, or nothing."""
    if not (np.diff(values[0]) > CLOSEST * np.diff(cells.eta)).all():
        return f"the fluid collapses to less than {CLOSEST:g} of its width at rest"
    if len(values) == 2:
        return ""
    theta = _temperature(cells, values)
    if not (theta > 0).all():
        return "the cells do not resolve the temperature; more cells can help"
    largest = ((theta[1:] + theta[:-1]) / 2) ** 1.5
    broken = float(cells.shares[1:-1] @ (np.abs(values[3, 1:-1]) > largest))
    if broken > _MOST_BROKEN:
        return (
            f"{broken:.0%} of the rods carry more heat than their velocities can, and their "
            "temperature means nothing"
        )
    return ""


def _starting_fields(
    chain: Chain, cells: LabelCells, state: Stationary, start: Start, *, thermal: bool
) -> dict[str, Array]:
    """Put a start on the cells, each a weighted mean of two points, as in the stationary state."""
    s, W, L = state.unit, chain.free_velocity_width, chain.size
    own = slice(1, -1) if chain.box else slice(None)

    def at(labels: Array) -> tuple[Array, Array, Array]:
        x = start.positions(L * (labels + 0.5))
        eta = (x - 2 * chain.radius * L * labels) / s
        return eta, start.velocity(x) / W, start.variance(x) / W**2

    offset = cells.shares[own] / (2 * np.sqrt(3))
    left, right = cells.labels[own] - offset, cells.labels[own] + offset
    inner, outer = state.at(left), state.at(right)
    weight = (cells.eta[own] - inner) / (outer - inner)
    eta_left, v_left, _ = at(left)
    eta_right, v_right, _ = at(right)
    eta = eta_left + weight * (eta_right - eta_left)
    if not (np.diff(eta) > 0).all():
        raise ValueError("start: it is too steep for its grid of positions")
    v = (v_left + v_right) / 2
    if chain.box:
        eta, v = mirrored(eta, state.wall), mirrored(v, 0.0)
    fields = {"eta": eta, "V": v}
    empty = np.diff(eta)[[0, -1]] > _EMPTIEST * np.diff(cells.eta)[[0, -1]]
    if thermal and chain.box and empty.any():
        raise ValueError(
            "frame='label' does not resolve the temperature where there is hardly a rod at a wall "
            "at the start; use frame='eulerian' (at restitution 1)"
        )
    if thermal:
        faces = np.clip(cells.faces, left[0], right[-1])
        fields["S"] = np.append(at(faces)[2] * np.diff(eta) ** 2, 0.0)
        fields["q"] = np.zeros(eta.size)
    return fields
