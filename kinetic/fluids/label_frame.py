r"""Hydrodynamics on labels (Lagrangian): the unknown is the position of the rods of each label.

A label nu = N/L - 1/2 in (-1/2, 1/2) is carried by the flow, N_t + V N_x = 0, so the displacement
<dx> = x - (2R + g)(N - L/2) that closes the equations is known exactly. Lengths are in thermal
lengths s, velocities in W, times in s/W, and eta(nu, t) = y/s. The continuity equation holds by
construction, and the velocity equation reads

    eta_t = V,      V_t = -dp/dnu - K u |u|^(n-2) - Gamma V,        p = theta / eta_nu,

    u = eta - Lam nu,      Lam = g L/s,      Gamma = gamma s/(m W),      K = 1,

with theta = T/(m W^2), which is 1 in the isothermal case. The temperature equation is that of a gas
with one degree of freedom and no heat flux, in contact with the noise:

    theta_t + V theta_y = -2 theta V_y - 2 Gamma_T (theta - 1),      Gamma_T = gamma <1/m> s/W.

The quantity S = theta eta_nu^2 obeys the linear law S_t = 2 Gamma_T (eta_nu^2 - S), so it stays
positive.

**Between walls** the unit of length is that of the state at rest, which may be shorter than s, and
K is the strength of the springs in it (:mod:`crazybilliards.kinetic.statics.label_closure`). V = 0
at a wall, which is a mirror: two more cells are the images of the outermost ones.

**Discretisation.** M cells of labels, equally wide at the edges, hold eta and V. S and p are
defined on the faces between them, p = kappa S/d^3 with d the distance of neighbouring cells. kappa
and the positions of the cells are calibrated on the stationary state. This state, its rigid motions
and, without a gap, every breathing motion are therefore exact for any M. The ends are free, p = 0.
Shocks are stabilised by an artificial viscosity of von Neumann and Richtmyer on the velocity jump
that remains after a limited linear reconstruction. It vanishes for smooth flows. With a temperature
its work becomes heat.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.fluids.finite_volumes import minmod
from crazybilliards.kinetic.fluids.label_cells import LabelCells, make_cells, mirrored
from crazybilliards.kinetic.fluids.pde_solver import FlowFields, make_state, solve
from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.label_closure import Stationary, stationary
from crazybilliards.model import Chain, spring
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import position_grid, thermal_reach
from crazybilliards.model.kernels import inlined, kernel

_pull = inlined(spring.force)

_THINNEST = 1e-6  # density of the state at rest at the walls, in L/s
_EMPTIEST = 5.0  # room of a cell at a wall at the start, in units of that at rest
_CLOSEST = 1e-3  # distance of cells, as a share of that at rest
_SPACING = 0.05  # of the points that a solution is read out at, in thermal lengths


@kernel(allocates=True)
def label_rate(  # type: ignore[no-untyped-def]
    fields,
    labels,
    shares,
    kappa,
    stationary_distance,
    lam,
    stiffness,
    gamma,
    heating_rate,
    walled,
    exponent,
):
    """Rates of change of (eta, V) or, with a temperature, of (eta, V, S).

    ``gamma`` is Gamma and ``heating_rate`` Gamma_T.

    ``fields`` has the shape (2 or 3, M). S of the face right of a cell is stored at the cell, in
    units in which it is ``stationary_distance`` squared at rest. Its last value is not used.
    """
    eta, v = fields[0], fields[1]
    thermal = fields.shape[0] == 3
    cells = eta.size
    rates = np.empty_like(fields)
    before = 0.0  # pressure at the left face
    for i in range(cells):
        pressure = 0.0
        if i < cells - 1:
            # Cells may cross in trial stages of an integrator. The rates stay finite and drive them
            # back.
            d = max(eta[i + 1] - eta[i], _CLOSEST * stationary_distance[i])
            theta = 1.0
            if thermal:
                theta = min(max(fields[2, i], 0.0) / d**2, 1e6)
            pressure = kappa[i] * theta / d
            jump = v[i + 1] - v[i]
            viscous = 0.0
            if jump < 0:
                left = minmod(v[i] - v[i - 1], jump) if i > 0 else 0.0
                right = minmod(v[i + 2] - v[i + 1], jump) if i < cells - 2 else 0.0
                rest = max(min(jump - (left + right) / 2, 0.0), -1e3)
                viscous = kappa[i] / d * (2 * rest**2 - 0.5 * np.sqrt(theta) * rest)
                pressure += viscous
            if thermal:
                heating = -4 * viscous * jump * d**2 / (shares[i] + shares[i + 1])
                rates[2, i] = 2 * heating_rate * (d**2 - fields[2, i]) + heating
        elif thermal:
            rates[2, i] = 0.0
        force = stiffness * _pull(eta[i] - lam * labels[i], exponent)
        rates[0, i] = v[i]
        rates[1, i] = (before - pressure) / shares[i] - force - gamma * v[i]
        before = pressure
    if walled:
        for j in range(2):
            rates[j, 0], rates[j, cells - 1] = -rates[j, 1], -rates[j, cells - 2]
    return rates


def solve_on_labels(
    chain: Chain,
    start: Start,
    times: Array,
    number: int | None,
    *,
    thermal: bool,
    exchange: float,
    progress: bool,
) -> FlowFields:
    """Solve from a start with ``number`` cells, by DOP853 of scipy through py-pde.

    ``exchange`` is Gamma_T/Gamma.
    """
    state, W = stationary(chain), chain.free_velocity_width
    s, walled = state.unit, chain.box > 0
    if walled and state.at_walls < _THINNEST / s:
        raise ValueError(
            "frame='label' needs walls that rods reach at rest, and these are too far out; use "
            "frame='eulerian'"
        )
    cells = make_cells(state, chain.potential_exponent, number)
    gamma = chain.damping * s / (chain.mass * W)
    at_rest = cells.labels, cells.shares, cells.kappa, np.diff(cells.eta), state.lam
    constants = (*at_rest, state.stiffness, gamma, exchange * gamma, walled)
    # In the unit of time of `solve`: py-pde drops outputs that are less than 1e-8 units apart.
    interval = times[1] * W / s

    def rate(values: Array) -> Array:
        return np.asarray(label_rate(values, *constants, chain.potential_exponent))

    fields = _starting_fields(chain, cells, state, start, thermal=thermal)
    # A trial step may overflow if rods are very light. The solver refuses what is not a number.
    with np.errstate(over="ignore", invalid="ignore"):
        solution = solve(
            lambda values, time: interval * rate(values),
            # The cells are not equally wide. For py-pde they have numbers and not positions.
            make_state(fields, (0, cells.labels.size)),
            np.arange(float(times.size)),
            progress=progress,
            solver="scipy",
            backend="numpy",  # the rate is compiled already
            method="DOP853",
            rtol=1e-7,
            atol=1e-7,
        )
    closest = np.diff(solution[:, 0], axis=1) / np.diff(cells.eta)
    if not (closest > _CLOSEST).all():
        raise ValueError(
            "the hydrodynamic equations could not be solved: the fluid collapses to less than "
            f"{_CLOSEST:g} of its width at rest"
        )
    rates = np.array([rate(values)[:2] for values in solution])
    own = slice(1, -1) if walled else slice(None)
    unsteadiness = np.sqrt(np.sum(rates[..., own] ** 2, axis=1) @ cells.shares[own])
    return _on_positions(chain, cells, state, solution, unsteadiness)


def _starting_fields(
    chain: Chain, cells: LabelCells, state: Stationary, start: Start, *, thermal: bool
) -> dict[str, Array]:
    """Put a start on the cells.

    A cell is a weighted mean of two points in it, with the weights of the stationary state. A
    shifted or stretched stationary state then starts exactly.
    """
    s, W, L = state.unit, chain.free_velocity_width, chain.size
    own = slice(1, -1) if chain.box else slice(None)

    def at(labels: Array) -> tuple[Array, Array, Array]:
        x = start.positions(L * (labels + 0.5))
        eta = (x - 2 * chain.radius * L * labels) / s
        return eta, start.velocity(x) / W, start.variance(x) / W**2

    offset = cells.shares[own] / (2 * np.sqrt(3))
    left, right = cells.labels[own] - offset, cells.labels[own] + offset
    inner, outer = state.at(left)[0], state.at(right)[0]
    weight = (cells.eta[own] - inner) / (outer - inner)
    eta_left, v_left, _ = at(left)
    eta_right, v_right, _ = at(right)
    eta = eta_left + weight * (eta_right - eta_left)
    if not (np.diff(eta) > 0).all():
        raise ValueError("start: it is too steep for its grid of positions")
    v = (v_left + v_right) / 2
    if chain.box:
        eta, v = mirrored(eta, state.wall + state.lam / 2), mirrored(v, 0.0)
    fields = {"eta": eta, "V": v}
    empty = np.diff(eta)[[0, -1]] > _EMPTIEST * np.diff(cells.eta)[[0, -1]]
    if thermal and chain.box and empty.any():
        raise ValueError(
            "frame='label' does not resolve the temperature where there is hardly a rod at a wall "
            "at the start; use frame='eulerian'"
        )
    if thermal:
        faces = np.clip(cells.faces, left[0], right[-1])
        fields["S"] = np.append(at(faces)[2] * np.diff(eta) ** 2, 0.0)
    return fields


def _on_positions(
    chain: Chain, cells: LabelCells, state: Stationary, solution: Array, unsteadiness: Array
) -> FlowFields:
    """Put the solution onto positions and particles, in the chain's units.

    eta is interpolated as a function of the stationary eta of the same label, which is smooth and,
    for shifts and stretches, linear; beyond the outermost faces it is continued linearly.
    Densities are those of the stationary state over the slope of that function.
    """
    s, W, L, R = state.unit, chain.free_velocity_width, chain.size, chain.radius
    weights = cells.weights
    rest = cells.eta[:-1] + weights * np.diff(cells.eta)
    distance = np.diff(solution[:, 0], axis=1)
    moved = solution[:, 0, :-1] + weights * distance
    flow = solution[:, 1, :-1] + weights * np.diff(solution[:, 1], axis=1)
    theta = solution[:, 2, :-1] / distance**2 if solution.shape[1] == 3 else np.ones_like(distance)
    # Stay just inside: at the end itself rounding may put a node into the vacuum.
    inner_faces = rest[1:-1] if chain.box else rest
    nodes = _refined(inner_faces, (state.right + state.lam / 2) * (1 - 1e-12))
    labels, log_density = state.profile(nodes)
    rod_nodes = state.at(chain.rank / L)[0]

    place = [_continued(rest, y, nodes) for y in moved]
    position = [s * eta + 2 * R * L * labels for eta, _ in place]
    farthest = max(float(np.abs(y[[0, -1]]).max()) for y in position) - chain.anchors[-1]
    x = position_grid(chain, max(farthest, thermal_reach(chain)))
    density, label, velocity, variance = np.empty((4, len(solution), x.size))
    rods, rod_velocities = np.empty((2, len(solution), L))
    for i, (edges, (_, slope)) in enumerate(zip(position, place, strict=True)):
        within = np.clip(x, edges[0], edges[-1])
        log_reduced = PchipInterpolator(edges, log_density - np.log(slope))(within)
        reduced = np.where(x == within, L / s * np.exp(log_reduced), 0.0)
        density[i] = reduced / (1 + 2 * R * reduced)
        label[i] = L * (0.5 + PchipInterpolator(edges, labels)(within))
        label[i][x < edges[0]], label[i][x > edges[-1]] = 0.0, L
        velocity[i] = W * np.interp(within, edges, _continued(rest, flow[i], nodes)[0])
        inner = s * moved[i] + 2 * R * L * cells.faces
        variance[i] = W**2 * np.interp(within, inner, theta[i])
        rods[i] = s * _continued(rest, moved[i], rod_nodes)[0] + 2 * R * chain.rank
        rod_velocities[i] = W * _continued(rest, flow[i], rod_nodes)[0]
    fields = (density, label, velocity, variance, rods, rod_velocities)
    return FlowFields(x, *fields, cells.labels.size, unsteadiness)


def _refined(faces: Array, end: float) -> Array:
    """Return points from -end to end: the faces, the tails, and points in wide gaps between."""
    coarse = np.concatenate([[-end], faces, [end]])
    parts = np.ceil(np.diff(coarse) / _SPACING).astype(int)
    fine = [
        np.linspace(left, right, n, endpoint=False)
        for left, right, n in zip(coarse[:-1], coarse[1:], parts, strict=True)
    ]
    return np.append(np.concatenate(fine), end)


def _continued(nodes: Array, values: Array, wanted: Array) -> tuple[Array, Array]:
    """Interpolate, linearly beyond the ends; return values and slopes."""
    spline = PchipInterpolator(nodes, values)
    inside = np.clip(wanted, nodes[0], nodes[-1])
    slopes = np.diff(values)[[0, -1]] / np.diff(nodes)[[0, -1]]
    slope = np.where(wanted < nodes[0], slopes[0], slopes[1])
    slope = np.where(wanted == inside, spline(inside, 1), slope)
    return spline(inside) + (wanted - inside) * slope, slope
