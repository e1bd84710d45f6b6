r"""The physical scales of a chain, from which a run is planned.

**Time step.** The step is 0.05 / max(w0, gamma/m), w0 from :func:`spring_rate`. The splitting
scheme then has W_x right to 3e-4 (linear springs, no gap). For e != 1 the step must also be short
enough to resolve the noise, most of all in the centre, where the chain is coldest. What matters is
r = (A sqrt(dt)/m)/W_v, the ratio of the velocity kick of one step to W_v. It is held at 0.3, with
the estimate of W_v by :func:`centre_width`. The error of W_v is then at most 1 %. For every step
the result states the expected error (:func:`time_step_error`).

**Relaxation time.** A rod on a linear spring k' relaxes with its slowest mode,

    1/tau = Re [b - sqrt(b^2 - k'/m)],      b = gamma/2m:

so tau is 2m/gamma for weak damping and gamma/k' for strong damping. A quadratic spring has no
constant stiffness. With strong damping its rod diffuses in the potential k |d|^3/3. The slowest
mode of this diffusion decays at the rate 1.241 k s/gamma, s = (T/k)^(1/3), which is the smallest
eigenvalue above 0 of the Fokker-Planck operator -d^2/dz^2 + z|z| d/dz, z = d/s. So k' = 1.241 k s
is right in this limit. With weak damping 2m/gamma is an upper estimate for quadratic springs: the
energy relaxes at the rate 6 gamma/5m (virial theorem), and the phases mix faster. At gamma s/m W =
0.2 the estimate is twice too long.

In a chain, rods that collide move together. The stiffness that holds a group is the mean of 2 k |d|
over its rods, whose displacements are smaller than those of a free rod, s. The displacements have
two causes. (1) Fluctuations: neighbours a gap g apart are coupled by T/g^2, the stiffness of a gas
of points, so that <d^2> = (g/2) sqrt(T/k'). With k' = 2 k <|d|> this is <d^2> = 0.78 s^2 z^2 with z
= (0.54 g/s)^(2/5). (2) Pressure: it pushes rods from their anchors within some s of the ends of a
lattice of length g L, on average by about s/(1 + g L/2s). Together

    k' = 1.241 k s min[1, sqrt(z^2 + 1/(1 + g L/2s)^2)],

The minimum is 1 without a gap, where relabelled rods are free, and less in a long, dense lattice.
The estimate is right to a third for 1 to 300 rods with gaps from 0.03 s to s, at restitution 1.
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
# Relative errors of W_v for a kick of r W_v, in units of r^3, r^(3/2), |1 - e| r^(3/2) and r^4.
_CORRECTED, _UNCORRECTED, _REBOUNDS, _LONG = 0.1, 0.24, 0.1, 0.05
_SLOWEST_MODE = 1.241  # rate of a strongly damped rod on a quadratic spring, in k s/gamma


def spring_rate(chain: Chain) -> float:
    """w0 = sqrt(F'(d)/m) [1/T]; a quadratic spring's is taken at U(d) = 10 T, the temperature."""
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
    """Estimate the ratio of W_v in the centre of the chain to W, within a fifth for e < 1.

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
    """Return a step that resolves spring, damping and, for e != 1, the noise; see the module."""
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

    With r = (A sqrt(dt)/m)/W_v, from simulations of 10 to 100 rods:

    * 0.1 r^3 below the critical restitution, with the correction for closed contacts
      (``laws/closed_contacts.py``), r = 0.2 to 0.6;
    * 0.24 r^(3/2) in the Euler scheme and with Contact Dynamics, which have no correction;
    * the larger of 0.1 |1 - e| r^(3/2) and 0.05 r^4 at higher restitutions, r = 0.06 to 1.3.

    The last one is an empirical law, an upper estimate of the paired differences that
    ``benchmarks/accuracy/time_step_law.py`` measures (docs/particles.md). The relative errors of
    mean displacements are of the same size, for e = 0.1 up to three times as large.
    """
    if chain.restitution == 1 or velocity_width == 0:
        return 0.0
    ratio = chain.amplitude / chain.mass * math.sqrt(time_step) / velocity_width
    if corrected and chain.restitution < CRITICAL_RESTITUTION:
        return _CORRECTED * ratio**3
    if not corrected:
        return _UNCORRECTED * ratio**1.5
    return max(_REBOUNDS * abs(1 - chain.restitution) * ratio**1.5, _LONG * ratio**4)


def relaxation_time(chain: Chain) -> float:
    """Time constant of the slowest mode of a chain [T]; 0 if nothing relaxes.

    It is exact for linear springs at restitution 1. For quadratic springs see the module.
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


def correlation_time(chain: Chain) -> float:
    """Longest integral of an autocorrelation function from 0 on [T]; 0 if nothing relaxes.

    It is m/gamma for energies under weak damping, and gamma/k' for displacements under strong
    damping. With the critical damping, displacements are correlated for twice
    :func:`relaxation_time`.
    """
    if chain.damping == 0:
        return 0.0
    stiffness = _relaxing_stiffness(chain)
    swings = chain.damping / stiffness if stiffness > 0 else 0.0
    return max(chain.mass / chain.damping, swings)


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
    """Largest displacement of a free rod with the energy of the start [R]."""
    energy = chain.potential(y - chain.reduced_anchors) + chain.mass / 2 * v**2
    if chain.stiffness == 0:
        return 0.0  # no bound, and no grid asks for one
    return chain.reach(float(energy.max()))
