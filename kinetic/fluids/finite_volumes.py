r"""Finite volumes for the eulerian frame: fluxes, reconstruction, rates of change.

The equations are those of :mod:`.eulerian_frame`. Fluxes are those of Harten,
Lax and van Leer between states that are reconstructed linearly in ln p, V and ln theta with the
minmod limiter. For every value of p = theta n/(1 - B n) the density n is between vacuum and close
packing. The scheme is well balanced. The limiter acts on the deviation of ln p from the state at
rest, where (ln p)' = -f (1 - B n)/theta, and the springs' force is the difference of the pressures
that it balances at rest. Fluxes and forces therefore cancel at rest. No flux passes the outermost
faces.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.kinetic.fluids.limiter import minmod
from crazybilliards.kinetic.fluids.pde_solver import Rate
from crazybilliards.model import spring
from crazybilliards.model.kernels import inlined, kernel

Array = NDArray[np.float64]

_pull = inlined(spring.force)

VACUUM = 1e-13
_THIN = 1e-10
_COLDEST = 1e-6
_LEAST_ROOM = 1e-12  # 1 - B n, at close packing
_STEEPEST = 10.0  # change of ln p over a cell at rest


class Constants(NamedTuple):
    """The quantities besides the fields that the rates depend on; see ``eulerian_rate``."""

    x: Array
    spacing: float
    theta: Array
    frozen: Array
    crowd: float  # B: length of all rods in thermal lengths
    lam: float
    gamma: float
    exponent: int


@kernel
def _hll(left, right, crowd, stiffness):  # type: ignore[no-untyped-def]
    """Flux of n, nV and E between two states (ln p, V, ln theta)."""
    p_l, p_r, v_l, v_r = np.exp(left[0]), np.exp(right[0]), left[1], right[1]
    hot_l, hot_r = np.exp(left[2]), np.exp(right[2])
    free_l, free_r = p_l / hot_l, p_r / hot_r
    n_l, n_r = free_l / (1 + crowd * free_l), free_r / (1 + crowd * free_r)
    e_l, e_r = n_l * (v_l**2 + hot_l) / 2, n_r * (v_r**2 + hot_r) / 2
    c_l = stiffness * np.sqrt(hot_l) * (1 + crowd * free_l)
    c_r = stiffness * np.sqrt(hot_r) * (1 + crowd * free_r)
    slow, fast = min(v_l - c_l, v_r - c_r, 0.0), max(v_l + c_l, v_r + c_r, 0.0)
    a, b, across = fast / (fast - slow), -slow / (fast - slow), slow * fast / (fast - slow)
    return (
        a * n_l * v_l + b * n_r * v_r + across * (n_r - n_l),
        a * (n_l * v_l**2 + p_l) + b * (n_r * v_r**2 + p_r) + across * (n_r * v_r - n_l * v_l),
        a * v_l * (e_l + p_l) + b * v_r * (e_r + p_r) + across * (e_r - e_l),
    )


@kernel
def primitive(fields, theta, crowd):  # type: ignore[no-untyped-def]
    """Return ln p, V and ln theta, (M, 3); with an energy, theta follows from it.

    In a vacuum the quotients would be rounding errors. There V = 0 and theta is the given one.
    """
    cells = fields.shape[1]
    state = np.empty((cells, 3))
    for i in range(cells):
        n = max(fields[0, i], VACUUM)
        weight = n / (n**2 + _THIN**2)
        v = fields[1, i] * weight
        hot = theta[i]
        if fields.shape[0] == 3:
            hot += n * weight * (2 * fields[2, i] / n - v**2 - hot)
        hot = max(hot, _COLDEST)
        room = max(1 - crowd * n, _LEAST_ROOM)
        state[i, 0], state[i, 1], state[i, 2] = np.log(n * hot / room), v, np.log(hot)
    return state


@kernel
def eulerian_rate(fields, x, spacing, theta, frozen, crowd, lam, gamma, exponent):  # type: ignore[no-untyped-def]
    """Rates of change of (n, nV) at the given ``theta`` (M,), or of (n, nV, E).

    ``frozen``: u at the cells, (M,), or empty: carried labels. ``crowd``: B.
    """
    number, cells = fields.shape
    state = primitive(fields, theta, crowd)
    stiffness = np.sqrt(3.0) if number == 3 else 1.0
    rates, rest = np.zeros_like(fields), np.zeros((cells, 3))
    label = -0.5
    for i in range(cells):
        n, momentum = fields[0, i], fields[1, i]
        label += 0.5 * n * spacing
        u = frozen[i] if frozen.size > 0 else x[i] - (crowd + lam) * label
        label += 0.5 * n * spacing
        force = _pull(u, exponent)
        # The change of ln p over a cell at rest; these pressures balance the force on the cell.
        change = -force * max(1 - crowd * n, _LEAST_ROOM) * spacing / np.exp(state[i, 2])
        rest[i, 0] = min(max(change, -_STEEPEST), _STEEPEST)
        push = 2 * np.exp(state[i, 0]) * np.sinh(rest[i, 0] / 2) / spacing
        rates[1, i] += push - gamma * momentum
        if number == 3:
            rates[2, i] += state[i, 1] * push - gamma * (2 * fields[2, i] - n)
    left, right, slope, following = np.zeros((4, 3))
    following[:] = rest[0]
    for i in range(cells - 1):
        slope[:] = following
        for j in range(3):
            following[j] = rest[i + 1, j]
            if i + 2 < cells:
                before = state[i + 1, j] - state[i, j] - (rest[i, j] + rest[i + 1, j]) / 2
                after = state[i + 2, j] - state[i + 1, j]
                after -= (rest[i + 1, j] + rest[i + 2, j]) / 2
                following[j] += minmod(before, after)
            left[j] = state[i, j] + slope[j] / 2
            right[j] = state[i + 1, j] - following[j] / 2
        flux = _hll(left, right, crowd, stiffness)
        for j in range(number):
            rates[j, i] -= flux[j] / spacing
            rates[j, i + 1] += flux[j] / spacing
    return rates


def make_rate(constants: Constants) -> Rate:
    """Return the rates of change as a function that py-pde can compile its steps around."""
    x, spacing, theta, frozen, crowd, lam, gamma, exponent = constants

    def rate(values, time=0.0):  # type: ignore[no-untyped-def]
        return eulerian_rate(values, x, spacing, theta, frozen, crowd, lam, gamma, exponent)

    return rate
