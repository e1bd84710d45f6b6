"""The relative error of a velocity width that is due to the time step; see docs/particles.md."""

import math

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION
from crazybilliards.particles.scales import spring_rate

# Relative errors of W_v for a kick of r W_v, in units of r^3, r^(3/2), |1 - e| r^(3/2) and r^4.
_CORRECTED, _UNCORRECTED, _REBOUNDS, _LONG = 0.1, 0.24, 0.1, 0.05
_AT_WALLS = 0.12  # in units of r^(3/2), where walls take nearly all, but not all
_HEATING = 1.5e-3  # by collisions with a gap, in units of (m w0/gamma) (w0 dt)^4
_HEATING_UNEQUAL = 1.5e-2  # the same with walls, or of unequal masses


def time_step_error(
    chain: Chain,
    time_step: float,
    velocity_width: float,
    *,
    stepper: str = "splitting",
    method: str = "event-driven",
) -> float:
    """Relative error of a ``velocity_width`` above 0 that is due to the time step; NaN: not known.

    It is the sum of those of the noise and of the springs in the table of docs/particles.md. Errors
    of the noise were measured in simulations of 10 to 100 rods, for r = (A sqrt(dt)/m)/W_v from 0.2
    to 0.6 below the critical restitution, and from 0.06 to 1.3 above it
    (``studies/time_step_law.py``). Errors of mean displacements are up to three times as large at
    e = 0.1. The heating by collisions was measured at dt = 0.1 and 0.5 for gaps of one and two
    radii, and for mass ratios from 0.3 to 30.

    ``velocity_width`` is that of a light rod, or m W_v of a heavier one over the mass of a light
    one, whichever is smaller.
    """
    unequal = chain.mass_ratio != 1 or chain.box > 0
    alike = chain.lattice_gap == 0 and not unequal
    differing = chain.stiffness > 0 and not alike
    restitutions = [chain.restitution] if chain.size > 1 else []
    restitutions += [chain.wall_restitution] if chain.box else []
    if (
        not 0 < velocity_width < math.inf
        or (chain.amplitude == 0 and any(e != 1 for e in restitutions))
        or (chain.damping == 0 and (differing or chain.spring == "quadratic"))
        or (stepper == "euler" and not alike)
    ):
        return math.nan
    lightest, rate = float(chain.rod_masses[:2].min()), spring_rate(chain)
    swing = (rate * time_step) ** 2
    springs = swing / 8 if chain.spring == "quadratic" else 0.0
    if stepper == "euler":
        heat = 1 - chain.damping * time_step / (2 * chain.mass) - swing / 4
        springs += 1 / math.sqrt(heat) - 1 if heat > 0 else math.inf
    if differing:
        heating = _HEATING_UNEQUAL if unequal else _HEATING
        springs += heating * lightest * rate / chain.damping * swing**2
    ratio = chain.amplitude / lightest * math.sqrt(time_step) / velocity_width
    corrected = stepper == "splitting" and method == "event-driven"
    noise = [_noise_error(e, ratio, method, corrected) for e in restitutions]
    if corrected and 0 < chain.wall_restitution < CRITICAL_RESTITUTION:
        noise.append(_AT_WALLS * ratio**1.5)
    return springs + float(np.max(noise, initial=0.0))  # NaN if one of them is


def _noise_error(e: float, ratio: float, method: str, corrected: bool) -> float:
    """Return the error of W_v by collisions at restitution e, with kicks of ``ratio`` W_v."""
    sticking = e < CRITICAL_RESTITUTION
    if method != "event-driven" and not (method == "contact-dynamics" and sticking):
        return math.nan
    if e == 1:
        return 0.0
    if not corrected:
        return _UNCORRECTED * ratio**1.5
    if sticking:
        return _in_true_widths(_CORRECTED * ratio**3, 3)
    return max(_REBOUNDS * abs(1 - e) * ratio**1.5, _in_true_widths(_LONG * ratio**4, 4))


def _in_true_widths(error: float, power: int) -> float:
    """Return the error x that c r^power states for the true W_v; ``error``: for the measured one.

    The error makes W_v too large and so r too small: x = error (1 + x)^power. Above the largest
    error with a solution, 0.15 or 0.11, the true one is a third or more, and not known.
    """
    if error > (power - 1) ** (power - 1) / power**power:
        return math.inf
    x = 0.0
    for _ in range(100):
        x = error * (1 + x) ** power
    return x
