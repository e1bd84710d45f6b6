"""The solution on labels put onto positions and particles."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.fluids.label_cells import LabelCells
from crazybilliards.kinetic.fluids.pde_solver import FlowFields
from crazybilliards.kinetic.statics.label_closure import Stationary
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import position_grid, thermal_reach

_SPACING = 0.05  # of the points that a solution is read out at, in thermal lengths


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
    inner_faces = rest[1:-1] if chain.box else rest
    nodes = _refined(inner_faces, state.eta[-1] * (1 - 1e-12))
    labels, log_density = state.profile(nodes)
    rod_nodes = state.at(chain.rank / L)

    place = [_continued(rest, y, nodes) for y in moved]
    position = [s * eta + 2 * R * L * labels for eta, _ in place]
    farthest = max(float(np.abs(y[[0, -1]]).max()) for y in position) - chain.anchors[-1]
    x = position_grid(chain, max(farthest, thermal_reach(chain)))
    density, label, velocity, variance, heat = np.zeros((5, len(solution), x.size))
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
        if flux is not None:
            middle = s * solution[i, 0] + 2 * R * L * cells.labels
            heat[i] = L * W**3 / s * np.interp(x, middle, flux[i], left=0.0, right=0.0)
        rods[i] = s * _continued(rest, moved[i], rod_nodes)[0] + 2 * R * chain.rank
        rod_velocities[i] = W * _continued(rest, flow[i], rod_nodes)[0]
    fields = (density, label, velocity, variance, rods, rod_velocities)
    size, hot = cells.labels.size, heat if flux is not None else None
    return FlowFields(x, *fields, size, unsteadiness, energy, hot)


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
    """Interpolate, linearly beyond the ends; return values and slopes."""
    spline = PchipInterpolator(nodes, values)
    inside = np.clip(wanted, nodes[0], nodes[-1])
    slopes = np.diff(values)[[0, -1]] / np.diff(nodes)[[0, -1]]
    slope = np.where(wanted < nodes[0], slopes[0], slopes[1])
    slope = np.where(wanted == inside, spline(inside, 1), slope)
    return spline(inside) + (wanted - inside) * slope, slope
