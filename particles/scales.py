r"""The physical scales of a chain, from which a run is planned.

The scales of a chain are the spring's rate w0 = sqrt(F'(d)/m), taken for a quadratic spring at
the displacement d that ten times the temperature reaches, and the damping rate gamma/m.

**Time step.** 0.05 / max(w0, gamma/m), which gives the splitting scheme W_x right to 3e-4 (linear
springs, no gap). For e != 1 the noise must be resolved too: rods that touch lose what one kick
gave them before the next one, and W_v of a dissipative chain comes out too small where it is
smallest, in the centre, by about 0.24 r^(3/2) with r = (A sqrt(dt)/m)/W_v, the velocity kick
of one step over W_v. r is held at 0.12 (1 %), W_v being estimated by :func:`centre_width`,
but the step is not made shorter than 1/500 of the above, which about 1000 rods
need at e = 0. Whatever the step, the result states this error (:func:`time_step_error`).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain

Array = NDArray[np.float64]

_RESOLUTION = 0.05
_KICK = 0.12
_KICK_ERROR = 0.24  # relative error of W_v for a kick of r W_v is this times r^(3/2)
_MOST_REFINED = 500


def spring_rate(chain: Chain) -> float:
    """w0 = sqrt(F'(d)/m) [1/T]; a quadratic spring's is taken at U(d) = 10 T."""
    if chain.spring == "linear":
        return math.sqrt(chain.stiffness / chain.mass)
    if chain.stiffness == 0 or chain.temperature == 0:
        return 0.0
    if math.isinf(chain.temperature):
        raise ValueError(
            "time_step: a quadratic spring without damping has no typical displacement to choose "
            "a step from; give time_step"
        )
    displacement = chain.reach(10 * chain.temperature)
    return math.sqrt(2 * chain.stiffness * displacement / chain.mass)


def centre_width(chain: Chain) -> float:
    """Estimate of W_v in the centre of the chain over the free one, within a fifth for e < 1.

    Heating by the noise balances damping and collisions, whose cooling grows as the chain cools
    and contracts: 1/w^2 = 1 + q with q = c (1 - e^2) n sqrt(k m)/gamma, n the number of rods that
    lie within a few thermal lengths. c = 0.1 + 0.14 e^4 fits simulations from L = 10 to 1000. For
    e >= 1, where collisions do not cool, w = 1.
    """
    e = chain.restitution
    if e >= 1 or chain.damping == 0 or chain.stiffness == 0:
        return 1.0
    neighbours = chain.size / (1 + chain.gap * chain.size / max(2.5 * chain.thermal_length, 1e-60))
    rate = spring_rate(chain) * chain.mass / chain.damping
    return 1 / math.sqrt(1 + (0.1 + 0.14 * e**4) * (1 - e**2) * neighbours * rate)


def default_time_step(chain: Chain) -> float:
    """Resolve spring, damping and, for e != 1, the noise; see the top of this module."""
    fastest = max(spring_rate(chain), chain.damping / chain.mass)
    if fastest == 0:
        raise ValueError(
            "time_step: a chain without damping and without a working spring has no time scale "
            "to choose a step from; give time_step"
        )
    step = _RESOLUTION / fastest
    if chain.restitution == 1 or chain.amplitude == 0 or chain.damping == 0:
        return step
    # A sqrt(dt)/m = ratio * W, W = A/sqrt(2 m gamma)
    ratio = _KICK * centre_width(chain)
    return max(min(step, ratio**2 * chain.mass / (2 * chain.damping)), step / _MOST_REFINED)


def time_step_error(chain: Chain, time_step: float, velocity_width: float) -> float:
    """Relative error of a ``velocity_width`` off e = 1 that is due to the kicks of the noise.

    0.24 r^(3/2), r = (A sqrt(dt)/m)/W_v: from simulations at e = 0, where it is largest, of 30 to
    1000 rods. The exponent is that of contacts: excursions from one contact to the next have
    lengths t > dt in a number ~ dt^(-1/4), and each loses what one kick gave it, ~ dt.
    """
    if chain.restitution == 1 or velocity_width == 0:
        return 0.0
    kick = chain.amplitude / chain.mass * math.sqrt(time_step)
    return _KICK_ERROR * (kick / velocity_width) ** 1.5


def relaxation_time(chain: Chain) -> float:
    """Time constant of the slowest mode of one damped spring; 0 where nothing relaxes."""
    if chain.damping == 0:
        return 0.0
    half_damping, rate = chain.damping / (2 * chain.mass), spring_rate(chain)
    if rate == 0:
        return 1 / (2 * half_damping)
    if rate >= half_damping:
        return 1 / half_damping
    # 1/(b - sqrt(b^2 - w^2)), written without cancellation.
    return (half_damping + math.sqrt(half_damping**2 - rate**2)) / rate**2


def typical_speed(chain: Chain, duration: float, y: Array, v: Array) -> float:
    """Upper estimate of the speed that noise and the start's own energy give a rod [R/T]."""
    heating = min(duration, chain.mass / (2 * chain.damping) if chain.damping else np.inf)
    noise = chain.amplitude / chain.mass * np.sqrt(heating)
    spring = np.sqrt(2 * chain.potential(y - chain.reduced_anchors).max() / chain.mass)
    return float(noise + spring + np.abs(v).max())


def start_swing(chain: Chain, y: Array, v: Array) -> float:
    """Largest displacement that the start's own energy takes a free rod to [R]."""
    energy = chain.potential(y - chain.reduced_anchors) + chain.mass / 2 * v**2
    if chain.stiffness == 0:
        return 0.0  # no bound, and no grid asks for one
    return chain.reach(float(energy.max()))
