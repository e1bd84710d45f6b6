r"""The physical scales of a chain, from which a run is planned.

The scales of a chain are the spring's rate w0 = sqrt(F'(d)/m), taken for a quadratic spring at
the displacement d that ten times the temperature reaches, and the damping rate gamma/m.

**Time step.** 0.05 / max(w0, gamma/m), which gives the splitting scheme W_x right to 3e-4 (linear
springs, no gap). For e != 1 the noise must be resolved too, most where the chain is coldest, in the
centre. What counts is r = (A sqrt(dt)/m)/W_v, the velocity kick of one step over W_v. It is held at
0.3, W_v being estimated by :func:`centre_width`; W_v then comes out wrong by 1 % at most. Whatever
the step, the result states this error (:func:`time_step_error`).

**Relaxation time.** A rod on a linear spring k' relaxes with its slowest mode,

    1/tau = Re [b - sqrt(b^2 - k'/m)],      b = gamma/2m:

2m/gamma if weakly damped, gamma/k' if strongly. A quadratic spring has no stiffness of its own, but
strongly damped its rod diffuses in the potential k |d|^3/3, and the slowest mode of that decays at
the rate 1.241 k s/gamma, s = (T/k)^(1/3): the smallest eigenvalue but 0 of the Fokker-Planck
operator -d^2/dz^2 + z|z| d/dz, z = d/s. So k' = 1.241 k s is right in this limit. Weakly damped,
2m/gamma is an upper estimate for quadratic springs: the energy relaxes at the rate 6 gamma/5m
(virial theorem), and the phases mix faster; at gamma s/m W = 0.2 it is twice too long.

In a chain, rods that collide move together, and the stiffness that holds a group is the mean of
2 k |d| over its rods, whose displacements are smaller than those of a free rod, s. Two parts make
them up. Fluctuations: neighbours a gap g apart are coupled by T/g^2, the stiffness of a gas of
points, so that <d^2> = (g/2) sqrt(T/k'); with k' = 2 k <|d|> this is <d^2> = 0.78 s^2 z^2 with
z = (0.54 g/s)^(2/5). The pressure, which pushes rods from their anchors within some s of the ends
of a lattice of length g L: on average by about s/(1 + g L/2s). Together

    k' = 1.241 k s min[1, sqrt(z^2 + 1/(1 + g L/2s)^2)],

1 without gap (rods pass their velocities on and are free in all but name), less in a long, dense
lattice. It is right to a third for 1 to 300 rods with gaps from 0.03 s to s, at restitution 1.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION

Array = NDArray[np.float64]

_RESOLUTION = 0.05
_KICK = 0.3
# Relative errors of W_v for a kick of r W_v, in units of r^3, r^(3/2) and r^(3/2).
_CORRECTED, _UNCORRECTED, _NOT_CRITICAL = 0.1, 0.24, 0.06
_SLOWEST_MODE = 1.241  # rate of a strongly damped rod on a quadratic spring, in k s/gamma


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
    return min(step, ratio**2 * chain.mass / (2 * chain.damping))


def time_step_error(
    chain: Chain, time_step: float, velocity_width: float, *, corrected: bool = True
) -> float:
    """Relative error of a ``velocity_width`` for e != 1 that is due to the kicks of the noise.

    With r = (A sqrt(dt)/m)/W_v, from simulations of 10 to 100 rods with r = 0.2 to 0.6:

    * 0.1 r^3 below the critical restitution, with the correction for closed contacts
      (``laws/closed_contacts.py``);
    * 0.24 r^(3/2) there without it, in the Euler scheme and with Contact Dynamics: excursions from
      one contact to the next have lengths t > dt in a number ~ dt^(-1/4), and each loses what one
      kick gave it, ~ dt;
    * 0.06 r^(3/2) at higher restitutions: what is found at e = 0.2 and 0.3, less above.

    Mean displacements are off by about as much.
    """
    if chain.restitution == 1 or velocity_width == 0:
        return 0.0
    ratio = chain.amplitude / chain.mass * math.sqrt(time_step) / velocity_width
    if corrected and chain.restitution < CRITICAL_RESTITUTION:
        return _CORRECTED * ratio**3
    uncorrected = _UNCORRECTED if not corrected else _NOT_CRITICAL
    return uncorrected * ratio**1.5


def relaxation_time(chain: Chain) -> float:
    """Time constant of the slowest mode of a chain [T]; 0 where nothing relaxes.

    Exact for linear springs at restitution 1; for quadratic ones see the top of this module.
    """
    if chain.damping == 0:
        return 0.0
    half_damping = chain.damping / (2 * chain.mass)
    rate = math.sqrt(_relaxing_stiffness(chain) / chain.mass)
    if rate == 0:
        return 1 / (2 * half_damping)
    if rate >= half_damping:
        return 1 / half_damping
    # 1/(b - sqrt(b^2 - w^2)), written without cancellation.
    return (half_damping + math.sqrt(half_damping**2 - rate**2)) / rate**2


def _relaxing_stiffness(chain: Chain) -> float:
    """Stiffness k' of the linear spring that relaxes as slowly as the chain's own [M/T^2]."""
    if chain.spring == "linear":
        return chain.stiffness
    if chain.stiffness == 0 or chain.temperature == 0:
        return 0.0
    s, gap = chain.thermal_length, chain.lattice_gap
    fluctuation = (0.54 * gap / s) ** 0.4
    pushed = 1 / (1 + gap * chain.size / (2 * s))
    return _SLOWEST_MODE * chain.stiffness * s * min(1.0, math.hypot(fluctuation, pushed))


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
