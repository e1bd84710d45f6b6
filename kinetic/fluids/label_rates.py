r"""Rates of change of the gas on labels, cell by cell; see :mod:`.label_frame`.

The faces between cells hold S = theta d^2 and the density n = kappa/d, with d the distance of the
two cells and kappa the share of the rods that belongs to a face. The pressure's work and the heat
flux move energy between cells and faces without loss.
"""

from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.fluids.finite_volumes import minmod
from crazybilliards.model import Array, spring
from crazybilliards.model.kernels import inlined, kernel

_pull = inlined(spring.force)

CLOSEST = 1e-3  # distance of cells, as a share of that at rest
_HOTTEST = 1e6  # in a trial step


class Constants(NamedTuple):
    """The quantities besides the fields that the rates depend on."""

    labels: Array  # of the cells' middles, (M,)
    shares: Array  # of all rods, (M,)
    kappa: Array  # of the faces right of a cell, (M - 1,)
    distance: Array  # of neighbouring cells at rest, (M - 1,)
    lam: float  # Lam
    stiffness: float  # K
    damping: float  # Gamma
    heating: float  # Gamma_T
    loss: float  # of heat, L a zeta
    mixing: float  # decay of the heat flux in collisions, L a c
    walled: bool
    exponent: int  # of the springs' potential


@kernel
def _viscous(v, i, theta, density):  # type: ignore[no-untyped-def]
    """Pressure of von Neumann and Richtmyer, on what a limited reconstruction leaves of a jump."""
    jump = v[i + 1] - v[i]
    if jump >= 0:
        return 0.0
    left = minmod(v[i] - v[i - 1], jump) if i > 0 else 0.0
    right = minmod(v[i + 2] - v[i + 1], jump) if i < v.size - 2 else 0.0
    rest = max(min(jump - (left + right) / 2, 0.0), -1e3)
    return density * (2 * rest**2 - 0.5 * np.sqrt(theta) * rest)


@kernel
def _flux_rate(q, cell, constants):  # type: ignore[no-untyped-def]
    """Rate of change of q in a cell, from what lies at the two faces of it."""
    _, _, _, _, _, _, _, heating, _, mixing, _, _ = constants
    theta_left, theta_right, density, width, jump = cell
    theta = (theta_left + theta_right) / 2
    gradient = (theta_right - theta_left) / width
    limited = min(max(q, -(theta**1.5)), theta**1.5)
    # For e > 1 collisions may feed q. No steady state lets them win over the noise's decay.
    decay = max(3 * heating + mixing * density * np.sqrt(theta), 0.0)
    # One more for rods that fly further than the gradient is long.
    decay += abs(gradient) / np.sqrt(max(theta, 1e-12))
    return -3 * theta * gradient - 3 * limited * jump / width - decay * q, limited * density


@kernel(allocates=True)
def label_rate(fields, constants):  # type: ignore[no-untyped-def]
    """Rates of change of (eta, V) or, with a temperature, of (eta, V, S, q).

    ``fields`` has the shape (2 or 4, M). S of the face right of a cell is stored at the cell.
    """
    labels, shares, kappa, distance, lam, stiffness, damping, heating = constants[:8]
    loss, _, walled, exponent = constants[8:]
    eta, v = fields[0], fields[1]
    thermal = fields.shape[0] == 4
    cells = eta.size
    rates = np.zeros_like(fields)
    before, theta_before, d_before, density_before = 0.0, 1.0, 1.0, 0.0  # at the left face
    for i in range(cells):
        pressure, theta, d, density = 0.0, 1.0, 1.0, 0.0
        if i < cells - 1:
            # Cells may cross in trial stages of an integrator. Finite rates drive them back.
            d = max(eta[i + 1] - eta[i], CLOSEST * distance[i])
            density = kappa[i] / d
            if thermal:
                theta = min(max(fields[2, i], 0.0) / d**2, _HOTTEST)
            viscous = _viscous(v, i, theta, density)
            pressure = density * theta + viscous
            if thermal:
                heat = 2 * heating * (1 - theta) - loss * density * theta**1.5
                heat -= 2 * viscous * (v[i + 1] - v[i]) / kappa[i]
                rates[2, i] += heat * d**2
        if thermal and 0 < i < cells - 1:
            cell = (
                theta_before,
                theta,
                (density_before + density) / 2,
                (d_before + d) / 2,
                (v[i + 1] - v[i - 1]) / 2,
            )
            rates[3, i], flux = _flux_rate(fields[3, i], cell, constants)
            # The image of this cell beyond a wall takes as much heat from the face at the wall.
            from_left = 2 if walled and i == 1 else 1
            to_right = 2 if walled and i == cells - 2 else 1
            rates[2, i - 1] -= from_left * flux / kappa[i - 1] * d_before**2
            rates[2, i] += to_right * flux / kappa[i] * d**2
        force = stiffness * _pull(eta[i] - lam * labels[i], exponent)
        rates[0, i] = v[i]
        rates[1, i] = (before - pressure) / shares[i] - force - damping * v[i]
        before, theta_before, d_before, density_before = pressure, theta, d, density
    if walled:
        for j in range(2):
            rates[j, 0], rates[j, cells - 1] = -rates[j, 1], -rates[j, cells - 2]
    return rates
