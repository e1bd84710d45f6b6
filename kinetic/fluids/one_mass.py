r"""How far a fluid is from a gas of equal elastic rods in a box, which only exchange velocities.

Without springs, and in the reduced coordinate, each point of such a gas moves as if it were alone.
The slowest wave of density, k = pi/(X - 2RL), then decays exactly as

    exp(-k^2 M(t)/2),      G = gamma/m,      M(t) as in :mod:`crazybilliards.kinetic.exact.points`,

while the relative density r, velocity w, temperature h and heat flux f of the fluid obey, for small
amplitudes,

    r' = -k w,      w' = k W^2 (r + h) - G w,      h' = -2 k w - k f - 2 G h,
    f' = 3 k W^2 h - 3 G f,

without the last line if there is no heat flux, f = 0, and without the last two if the fluid is
isothermal, h = 0. The two agree if damping is strong, where both diffuse. With weak damping the
fluid has sound, and such a gas has none.

Without a gap equal elastic rods on linear springs are such points, too. From any start the position
of a point is then normal, with the mean and the variance

    y(t) = a y + b V,      s^2 (1 - a^2) + b^2 (W_0^2 - W^2),      s^2 (1 - a^2) = M(t) at k = 0,

where a and b are the first row of exp(B t), B = [[0, 1], [-k/m, -G]], and W_0^2 is the variance at
the start. In a box every cosine of the density decays by itself. Streams pass through one another,
as those of a fluid do not.
"""

import math

import numpy as np
from scipy.linalg import expm

from crazybilliards.kinetic.exact.points import free_spread
from crazybilliards.kinetic.fluids.pde_solver import FlowFields
from crazybilliards.kinetic.starts import Start
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_TIMES = 400
_MOMENTS, _POINTS, _WAVES, _PLACES = 20, 1000, 200, 300
_FARTHEST = 8.0  # standard deviations of a point


def has_one_mass(chain: Chain) -> bool:
    """Return whether the rods are such a gas."""
    alone = chain.box > 0 == chain.stiffness
    return alone and chain.restitution == chain.wall_restitution == chain.mass_ratio == 1


def wave_model_error(chain: Chain, duration: float, *, moments: int) -> float:
    """Return the largest error of the fluid's slowest wave, in units of its first height.

    ``moments`` of the fluid: 2 if it is isothermal, 3 with a temperature, 4 with the heat flux.
    """
    W, G = chain.free_velocity_width, chain.damping / chain.mass
    k = math.pi / (2 * chain.walls[1])
    rates = np.array(
        [
            [0, -k, 0, 0],
            [k * W**2, -G, k * W**2, 0],
            [0, -2 * k, -2 * G, -k],
            [0, 0, 3 * k * W**2, -3 * G],
        ]
    )[:moments, :moments]
    t = np.linspace(0, duration, _TIMES)
    step, state, wave = expm(rates * t[1]), np.eye(moments)[0], []
    for _ in t:
        wave.append(state[0])
        state = step @ state
    exact = np.exp(-(k**2) * free_spread(chain, t) / 2)
    return float(np.abs(wave - exact).max())


def label_model_error(chain: Chain, start: Start, fields: FlowFields, times: Array) -> float:
    """Return the largest error of the fluid's label, over L, at some of the times.

    It is NaN, not known, unless the rods are independent points.
    """
    points = has_one_mass(chain) or (chain.exchangeable and not chain.box)
    alike = chain.restitution == chain.mass_ratio == 1 and chain.spring == "linear"
    if not (points and alike):
        return math.nan
    L, W, G = chain.size, chain.free_velocity_width, chain.damping / chain.mass
    x = start.positions(L * (np.arange(_POINTS) + 0.5) / _POINTS)
    y = x - 2 * chain.radius * (start.label(x) - L / 2)
    rates = np.array([[0, 1], [-chain.stiffness / chain.mass, -G]])
    nodes = np.linspace(0, fields.x.size - 1, _PLACES).astype(int)
    errors = []
    for k in np.unique(np.linspace(0, times.size - 1, _MOMENTS).astype(int)):
        a, b = expm(rates * times[k])[0]
        if chain.stiffness:
            spread = np.asarray(chain.thermal_length**2 * (1 - a**2))
        else:
            spread = free_spread(chain, times[k])
        variance = np.maximum(spread + b**2 * (start.variance(x) - W**2), 0.0)
        label = fields.label[k, nodes] / L
        at = fields.x[nodes] - 2 * chain.radius * L * (label - 0.5)
        exact = _share_below(at, a * y + b * start.velocity(x), np.sqrt(variance), chain.walls[1])
        errors.append(np.abs(label - exact).max())
    return float(max(errors))


def _share_below(at: Array, mean: Array, width: Array, wall: float) -> Array:
    """Return which share of normal points is below some places; walls at +-wall fold their laws."""
    end = min(wall, float(np.abs([at[0], at[-1], *(np.abs(mean) + _FARTHEST * width)]).max()))
    k = np.pi * np.arange(1, _WAVES + 1) / (2 * end)
    waves = (np.cos(np.outer(k, mean + end)) * np.exp(-(np.outer(k, width) ** 2) / 2)).mean(axis=1)
    place = np.clip(at + end, 0, 2 * end)
    return np.asarray(place / (2 * end) + (waves / (k * end)) @ np.sin(np.outer(k, place)))
