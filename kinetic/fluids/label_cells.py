"""The cells of labels of :mod:`.label_frame`, calibrated on the stationary state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid

from crazybilliards.kinetic.statics.label_closure import Stationary
from crazybilliards.model import spring
from crazybilliards.model.arrays import Array

_EDGE_CELL = 0.045  # width of a cell at the edge, in thermal lengths
_LAST_SHARE = 1e-5  # of the rods, beyond the outermost face
_FEWEST_CELLS, _FEWEST_IN_A_BOX, _MOST_CELLS = 100, 400, 4000
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
    return LabelCells(
        labels, shares, faces, eta, density * distance, (eta_faces - eta[:-1]) / distance
    )


def mirrored(values: Array, end: float) -> Array:
    """Return values with the images of the first and the last one in mirrors at -end and end."""
    return np.concatenate([[-2 * end - values[0]], values, [2 * end - values[-1]]])


def _faces(state: Stationary, number: int | None) -> Array:
    """Return the stationary eta of the inner faces: even at the edges, wider in a plateau."""
    end = state.wall
    if not state.at_walls:
        end = float(state.at(np.array([0.5 - _LAST_SHARE]))[0])
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
