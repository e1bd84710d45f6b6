r"""How far a fluid is from a gas of equal elastic rods in a box, which only exchange velocities.

Without springs, and in the reduced coordinate, each point of such a gas moves as if it were alone.
The slowest wave of density, k = pi/(X - 2RL), then decays exactly as

    exp(-k^2 M(t)/2),      G = gamma/m,      M(t) as in :mod:`crazybilliards.kinetic.exact.points`,

while the relative density r, velocity w, temperature h and heat flux f of the fluid obey, for small
amplitudes,

    r' = -k w,      w' = k W^2 (r + h) - G w,      h' = -2 k w - k f - 2 G h,
    f' = 3 k W^2 h - 3 G f,

without the last line if there is no heat flux, f = 0, and without the last two if the fluid is
isothermal, h = 0. With the heat flux the undamped waves have the frequencies
k W sqrt(3 +- sqrt(6)). The two agree if damping is strong, where both diffuse. With weak damping
the fluid has sound, and such a gas has none: the damping that would keep its temperature takes the
wave away.
"""

import math

import numpy as np
from scipy.linalg import expm

from crazybilliards.kinetic.exact.points import free_spread
from crazybilliards.model import Chain

_TIMES = 400


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
