r"""Finite volumes for the eulerian frame: fluxes, reconstruction, rates of change.

The equations are those of :mod:`.eulerian_frame`. Fluxes are those of Harten, Lax and van Leer
between states that are reconstructed linearly in ln p, V and ln W^2 with the minmod limiter. For
every p = rho W^2/(1 - 2 R rho) the density is between vacuum and close packing. The scheme is well
balanced: the limiter acts on the deviation of ln p from the state at rest, where
(ln p)' = -(F/m)(1 - 2 R rho)/W^2, and the springs' force is the difference of the pressures that it
balances there. No flux passes the outermost faces, but for the momentum at walls, whose flux is
that between the flow and its mirror image.
"""

from typing import NamedTuple

import numpy as np

from crazybilliards.model import Array, spring
from crazybilliards.model.kernels import copy, inlined, kernel

_pull = inlined(spring.force)

VACUUM = 1e-13  # these two in units of ``Constants.dilute``
_THIN = 1e-10
_COLDEST = 1e-6  # in units of the free velocity variance
_LEAST_ROOM = 1e-12  # 1 - 2 R rho, at close packing
_STEEPEST = 10.0  # change of ln p over a cell at rest


class Constants(NamedTuple):
    """The quantities besides the fields that the rates depend on; see ``eulerian_rate``."""

    x: Array  # the cells' middles [R]
    spacing: float  # their width [R]
    variance: Array  # W^2 at the cells [R^2/t_0^2], where no equation determines it
    frozen: Array  # <dx> at the cells [R], or empty: labels are carried along
    size: int  # number of rods
    rod: float  # 2 R
    lattice: float  # 2 R + g, the distance of the anchors [R]
    stiffness: float  # k/m
    damping: float  # gamma/m [1/t_0]
    heating: float  # Gamma_T = gamma <1/m> [1/t_0]
    exponent: int  # of the springs' potential
    heat: float  # the free W^2 [R^2/t_0^2]
    dilute: float  # L/s, the density of rods without a length [1/R]
    walled: bool  # the outermost faces are walls


@kernel
def minmod(a, b):  # type: ignore[no-untyped-def]
    """Return the smaller of two slopes of equal sign, 0 if their signs differ: no new extrema."""
    if a * b <= 0:
        return 0.0
    return a if abs(a) < abs(b) else b


@kernel
def _hll(left, right, constants, sound):  # type: ignore[no-untyped-def]
    """Flux of rho, rho V and E between two states of ``primitive``."""
    _, _, _, _, _, rod, _, _, _, _, _, heat, dilute, _ = constants
    p_l, p_r = dilute * heat * np.exp(left[0]), dilute * heat * np.exp(right[0])
    hot_l, hot_r, v_l, v_r = heat * np.exp(left[2]), heat * np.exp(right[2]), left[1], right[1]
    free_l, free_r = p_l / hot_l, p_r / hot_r
    n_l, n_r = free_l / (1 + rod * free_l), free_r / (1 + rod * free_r)
    e_l, e_r = n_l * (v_l**2 + hot_l) / 2, n_r * (v_r**2 + hot_r) / 2
    c_l = sound * np.sqrt(hot_l) * (1 + rod * free_l)
    c_r = sound * np.sqrt(hot_r) * (1 + rod * free_r)
    slow, fast = min(v_l - c_l, v_r - c_r, 0.0), max(v_l + c_l, v_r + c_r, 0.0)
    a, b, across = fast / (fast - slow), -slow / (fast - slow), slow * fast / (fast - slow)
    return (
        a * n_l * v_l + b * n_r * v_r + across * (n_r - n_l),
        a * (n_l * v_l**2 + p_l) + b * (n_r * v_r**2 + p_r) + across * (n_r * v_r - n_l * v_l),
        a * v_l * (e_l + p_l) + b * v_r * (e_r + p_r) + across * (e_r - e_l),
    )


@kernel(allocates=True)
def primitive(fields, constants):  # type: ignore[no-untyped-def]
    """Return ln p, V and ln W^2, (M, 3); with an energy, W^2 follows from it.

    p and W^2 are in units of ``dilute * heat`` and ``heat``, so that the bits of the logarithms are
    the same in all units of length and time. In a vacuum V = 0 and W^2 is the given one.
    """
    _, _, variance, _, _, rod, _, _, _, _, _, heat, dilute, _ = constants
    cells = fields.shape[1]
    state = np.empty((cells, 3))
    for i in range(cells):
        n = max(fields[0, i], VACUUM * dilute)
        weight = n / (n**2 + (_THIN * dilute) ** 2)
        v = fields[1, i] * weight
        hot = variance[i]
        if fields.shape[0] == 3:
            hot += n * weight * (2 * fields[2, i] / n - v**2 - hot)
        hot = max(hot, _COLDEST * heat)
        room = max(1 - rod * n, _LEAST_ROOM)
        hot /= heat
        state[i, 0], state[i, 1], state[i, 2] = np.log(n / dilute * hot / room), v, np.log(hot)
    return state


@kernel(allocates=True)
def eulerian_rate(fields, constants):  # type: ignore[no-untyped-def]
    """Rates of change of (rho, rho V) or (rho, rho V, E), (2 or 3, M); see ``Constants``."""
    number, cells = fields.shape
    x, spacing, _, frozen, size, rod, lattice, stiffness, damping = constants[:9]
    heating, exponent, heat, dilute, walled = constants[9:]
    state = primitive(fields, constants)
    sound = np.sqrt(3.0) if number == 3 else 1.0
    rates, rest = np.zeros_like(fields), np.zeros((cells, 3))
    label = -size / 2  # N - L/2
    for i in range(cells):
        n, momentum = fields[0, i], fields[1, i]
        label += 0.5 * n * spacing
        u = frozen[i] if frozen.size > 0 else x[i] - lattice * label
        label += 0.5 * n * spacing
        force = stiffness * _pull(u, exponent)
        # The change of ln p over a cell at rest; these pressures balance the force on the cell.
        change = -force * max(1 - rod * n, _LEAST_ROOM) * spacing / (heat * np.exp(state[i, 2]))
        rest[i, 0] = min(max(change, -_STEEPEST), _STEEPEST)
        push = 2 * dilute * heat * np.exp(state[i, 0]) * np.sinh(rest[i, 0] / 2) / spacing
        rates[1, i] += push - damping * momentum
        if number == 3:
            hotter = 2 * fields[2, i] - n * heat
            rates[2, i] += state[i, 1] * push - damping * hotter
            rates[2, i] -= (heating - damping) * (hotter - n * state[i, 1] ** 2)
    left, right, slope, following = np.zeros((4, 3))
    copy(rest[0], following)
    for i in range(cells - 1):
        copy(following, slope)
        for j in range(3):
            following[j] = rest[i + 1, j]
            if i + 2 < cells:
                before = state[i + 1, j] - state[i, j] - (rest[i, j] + rest[i + 1, j]) / 2
                after = state[i + 2, j] - state[i + 1, j]
                after -= (rest[i + 1, j] + rest[i + 2, j]) / 2
                following[j] += minmod(before, after)
            left[j] = state[i, j] + slope[j] / 2
            right[j] = state[i + 1, j] - following[j] / 2
        flux = _hll(left, right, constants, sound)
        for j in range(number):
            rates[j, i] -= flux[j] / spacing
            rates[j, i + 1] += flux[j] / spacing
    for end in range(2 if walled else 0):
        i, outwards = (0, -1.0) if end == 0 else (cells - 1, 1.0)
        for j in range(3):
            left[j] = right[j] = state[i, j] + outwards * rest[i, j] / 2
        left[1], right[1] = outwards * state[i, 1], -outwards * state[i, 1]
        rates[1, i] -= outwards * _hll(left, right, constants, sound)[1] / spacing
    return rates
