"""The cells of labels of :mod:`.label_frame`, and the solution on them put onto positions."""

from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.fluids.pde_solver import FlowFields
from crazybilliards.kinetic.statics.label_closure import Stationary
from crazybilliards.model import Array, Chain, spring
from crazybilliards.model.grid import position_grid

_EDGE_CELL = 0.045  # width of a cell at the edge, in thermal lengths
_LAST_SHARE = 1e-5  # of the rods, beyond the outermost face
_FEWEST_CELLS, _FEWEST_IN_A_BOX, _MOST_CELLS = 100, 400, 4000
_SPACING = 0.05  # of the points that a solution is read out at, in thermal lengths
_WEAKEST = 1e-8  # springs, K, that hold cells at their places


class LabelCells(NamedTuple):
    """The cells of labels and their calibration by the stationary state."""

    labels: Array  # of the cells' middles, (M,); between walls the first and the last are images
    shares: Array  # of all rods, (M,)
    faces: Array  # labels of the faces between them, (M - 1,)
    eta: Array  # stationary, (M,)
    kappa: Array  # p d at the inner faces, (M - 1,)
    weights: Array  # where a face lies between its two cells, (M - 1,)


def make_cells(state: Stationary, exponent: int, number: int | None) -> LabelCells:
    """Calibrate cells on the stationary state; ``number`` None: 0.045 s wide at the edges."""
    eta_faces = _faces(state, number)
    faces, log_density = state.profile(eta_faces)
    bounds = np.concatenate([[-0.5], faces, [0.5]])
    shares, labels = np.diff(bounds), (bounds[1:] + bounds[:-1]) / 2
    density = np.exp(log_density)
    at_walls = state.unit * state.at_walls
    pressure = np.concatenate([[at_walls], density, [at_walls]])
    # The mean force on a cell balances the pressures at its faces: K u |u|^(n-2) = -dp/dnu.
    force = -np.diff(pressure) / shares
    if state.stiffness > _WEAKEST:
        eta = state.lam * labels + spring.displacement(force / state.stiffness, exponent)
    else:
        eta = state.at(labels)
    if at_walls:
        end = state.wall
        labels, eta = mirrored(labels, 0.5), mirrored(eta, end)
        shares, density = np.pad(shares, 1, mode="edge"), pressure
        faces, eta_faces = bounds, np.concatenate([[-end], eta_faces, [end]])
    distance = np.diff(eta)
    weights = (eta_faces - eta[:-1]) / distance
    return LabelCells(labels, shares, faces, eta, density * distance, weights)


def mirrored(values: Array, end: float) -> Array:
    """Return values with the images of the first and the last one in mirrors at -end and end."""
    return np.concatenate([[-2 * end - values[0]], values, [2 * end - values[-1]]])


def _faces(state: Stationary, number: int | None) -> Array:
    """Return the stationary eta of the inner faces: even at the edges, wider in a plateau."""
    end = state.wall if state.at_walls else float(state.at(np.array([0.5 - _LAST_SHARE]))[0])
    fine = np.linspace(0, end, 20_001)
    depth = state.lam / 2 - fine
    cells_up_to = cumulative_trapezoid(1 / np.clip(1 + (depth - 6) / 3, 1, 8), fine, initial=0)
    if number is None:
        fewest = _FEWEST_IN_A_BOX if state.at_walls else _FEWEST_CELLS
        number = int(np.clip(2 * cells_up_to[-1] / _EDGE_CELL, fewest, _MOST_CELLS))
    walls = 1 if state.at_walls else 0  # are faces, too
    count = cells_up_to[-1] * np.linspace(-1, 1, number - 1 + 2 * walls)
    count = count[walls : count.size - walls]
    return np.asarray(np.sign(count) * np.interp(np.abs(count), cells_up_to, fine))


def on_positions(
    chain: Chain,
    cells: LabelCells,
    state: Stationary,
    solution: Array,
    unsteadiness: Array,
    energy: Array,
) -> FlowFields:
    """Put the solution onto positions and particles, in the chain's units.

    eta is a smooth function of the stationary eta of the same label, linear for shifts and
    stretches. Densities are those of the stationary state over its slope.
    """
    s, W, L, R = state.unit, chain.free_velocity_width, chain.size, chain.radius
    weights = cells.weights
    rest = cells.eta[:-1] + weights * np.diff(cells.eta)
    distance = np.diff(solution[:, 0], axis=1)
    moved = solution[:, 0, :-1] + weights * distance
    flow = solution[:, 1, :-1] + weights * np.diff(solution[:, 1], axis=1)
    theta, flux = np.ones_like(distance), None
    if solution.shape[1] == 4:
        theta = solution[:, 2, :-1] / distance**2
        flux = _heat_flux(chain, cells, solution[:, 3], distance)
    # Stay just inside: at the end itself rounding may put a node into the vacuum.
    nodes = _refined(rest[1:-1] if chain.box else rest, state.eta[-1] * (1 - 1e-12))
    labels, log_density = state.profile(nodes)
    rod_nodes = state.at(chain.rank / L)

    place, slope = _continued(rest, moved, nodes)
    position, speed = s * place + 2 * R * L * labels, _continued(rest, flow, nodes)[0]
    farthest = float(np.abs(position[:, [0, -1]]).max()) - chain.anchors[-1]
    x = position_grid(chain, max(farthest, chain.thermal_reach))
    density, label, velocity, variance, heat = np.zeros((5, len(solution), x.size))
    for i, edges in enumerate(position):
        within = np.clip(x, edges[0], edges[-1])
        log_reduced = PchipInterpolator(edges, log_density - np.log(slope[i]))(within)
        reduced = np.where(x == within, L / s * np.exp(log_reduced), 0.0)
        density[i] = reduced / (1 + 2 * R * reduced)
        label[i] = L * (0.5 + PchipInterpolator(edges, labels)(within))
        label[i][x < edges[0]], label[i][x > edges[-1]] = 0.0, L
        velocity[i] = W * np.interp(within, edges, speed[i])
        variance[i] = W**2 * np.interp(within, s * moved[i] + 2 * R * L * cells.faces, theta[i])
        if flux is not None:
            middle = s * solution[i, 0] + 2 * R * L * cells.labels
            heat[i] = L * W**3 / s * np.interp(x, middle, flux[i], left=0.0, right=0.0)
    rods = s * _continued(rest, moved, rod_nodes)[0] + 2 * R * chain.rank
    rod_velocities = W * _continued(rest, flow, rod_nodes)[0]
    return FlowFields(
        x,
        density,
        label,
        velocity,
        variance,
        rods,
        rod_velocities,
        cells.labels.size,
        unsteadiness,
        energy,
        None if flux is None else heat,
    )


def _heat_flux(chain: Chain, cells: LabelCells, q: Array, distance: Array) -> Array:
    """Return n q/2 at the cells; that of the images beyond walls has the other sign."""
    density = cells.kappa / distance
    flux = np.zeros_like(q)
    flux[:, 1:-1] = q[:, 1:-1] * (density[:, 1:] + density[:, :-1]) / 4
    if chain.box:
        flux[:, [0, -1]] = -flux[:, [1, -2]]
    return flux


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
    """Interpolate, linearly beyond the ends, along the last axis; return values and slopes."""
    spline = PchipInterpolator(nodes, values, axis=-1)
    inside = np.clip(wanted, nodes[0], nodes[-1])
    slopes = np.diff(values)[..., [0, -1]] / np.diff(nodes)[[0, -1]]
    slope = np.where(wanted < nodes[0], slopes[..., :1], slopes[..., 1:])
    slope = np.where(wanted == inside, spline(inside, 1), slope)
    return spline(inside) + (wanted - inside) * slope, slope
