"""The times of a run: its time step and what error it makes, its warm-up, and how long is enough.

* time step: see :func:`crazybilliards.particles.scales.default_time_step`. Where the motion of the
  chain is known exactly (``laws/exact_flight.py``), any step is right, and it is the time between
  snapshots. So it is for rods without springs, damping and noise, and their step is the time in
  which they cross the mean free room between them.
* warm-up: 12 relaxation times of the slowest mode, so that the start has decayed to exp(-12). There
  is none with a given start or for an ensemble, whose time begins with the start.
* blocks: a block lasts at least 4 correlation times, because the means of blocks must not be
  correlated. When there are 64 over all replicas, neighbours are added up in pairs, and the next
  blocks are twice as long. So a long run has 32 to 64 blocks, and what it has measured at a time
  does not depend on how long it goes on. From 64 replicas on each is one block.
* snapshots: every 10 steps, or more often where an observer asks for it; for an ensemble every
  hundredth of the duration. With exact motion they are as far apart as 10 steps would be.
"""

import math

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.model.checks import check_real
from crazybilliards.particles.dynamics import Stepper, longest_step
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION
from crazybilliards.particles.scales import (
    correlation_time,
    default_time_step,
    relaxation_time,
    settling_time,
    spring_rate,
)

_STRIDE = 10  # steps from snapshot to snapshot
_RELAXATIONS = 12  # of the warm-up
_BLOCKS, _FEWEST_BLOCKS = 64, 10
_ENDLESS = 2**62  # snapshots
# Of a block in correlation times. The standard error of a mean is then too small by an eighth for
# exponential correlations, which are the worst case.
_BLOCK = 4.0
# Warm-up from which on a start has decayed enough, in relaxation times.
_ENOUGH = 5.0
# A short time between snapshots shortens the step. Only in a short run may it become so much
# shorter than the chain needs.
_MOST_SHORTENED, _MOST_SHORT_STEPS = 1000, 1_000_000
# Relative errors of W_v for a kick of r W_v, in units of r^3, r^(3/2), |1 - e| r^(3/2) and r^4.
_CORRECTED, _UNCORRECTED, _REBOUNDS, _LONG = 0.1, 0.24, 0.1, 0.05
_AT_WALLS = 0.12  # in units of r^(3/2), where walls take nearly all, but not all
_HEATING = 1.5e-3  # by collisions with a gap, in units of (m w0/gamma) (w0 dt)^4
_HEATING_UNEQUAL = 1.5e-2  # the same with walls, or of unequal masses


def default_warmup(chain: Chain) -> float:
    """Return the warm-up of a steady state; 0 without damping, because the chain never forgets."""
    return 0.0 if chain.damping == 0 else _RELAXATIONS * settling_time(chain)


def choose_step(
    chain: Chain,
    time_step: float | None,
    every: float | None,
    warmup: float,
    duration: float,
    *,
    stepper: Stepper,
    exact: bool,
    crossing: float,
    finest: float,
) -> tuple[float, int]:
    """Return the step and the steps between snapshots; refuse a run that would not end.

    ``every``, the time between snapshots, is kept exactly, and the step becomes a whole fraction of
    it. An ``every`` that makes it over a thousand times as short and the run over a million steps
    long is refused. ``exact``: every step is right, whatever its length. ``crossing``: the step of
    rods without springs, damping and noise; else inf. ``finest``: what observers need for ``every``
    where it is not given.
    """
    every = None if every is None else check_real("every", every, positive=True)
    if time_step is not None:
        needed = least = check_real("time_step", time_step, positive=True)
        limit = math.inf if exact else longest_step(chain, stepper)
        if needed >= limit:
            raise ValueError(f"time_step must be below {limit:.3g} to be stable, got {needed:g}")
    else:
        try:
            needed = default_time_step(chain)
        except ValueError:
            # Free rods have no time scale, and need none if snapshots have one.
            needed = every if exact and every else crossing
            if needed == math.inf:
                raise
        least = needed / _MOST_SHORTENED
    longest, finest = needed, min(max(finest, least), _STRIDE * needed)
    if exact and time_step is None:
        every = every or finest
        # The warm-up is a whole number of steps, which must not make it much longer.
        longest = max(_STRIDE * needed, warmup / 100) if warmup > 0 else every
    if every is None:
        step, stride = min(needed, finest), max(math.floor(finest / needed + 1e-9), 1)
    else:
        stride = max(math.ceil(every / longest - 1e-9), 1)
        step = every / stride
    time = warmup + duration
    if needed > _MOST_SHORTENED * step and time > _MOST_SHORT_STEPS * step:
        raise ValueError(
            f"every = {step:g} is too small: the time step would be as short, where {needed:.3g} "
            f"is enough, and warm-up and duration would take {time / step:.1g} steps; at most "
            f"{_MOST_SHORT_STEPS} may be shorter than {needed / _MOST_SHORTENED:.3g}"
        )
    if time / step > 1e15:
        raise ValueError(
            f"warm-up and duration, {time:g} t_0, would take {time / step:.1g} steps of {step:g}: "
            "give less of both or, where every step is right, every"
        )
    return step, stride


def count_blocks(
    chain: Chain, duration: float, interval: float, replicas: int
) -> tuple[int, int, int]:
    """Return the snapshots of each replica, its blocks, and the snapshots of the first blocks.

    ``interval`` is the time between snapshots. The duration is rounded up to whole snapshots.
    """
    snapshots = duration / interval
    fewest = math.ceil(_FEWEST_BLOCKS / replicas)
    if snapshots < fewest * (1 - 1e-9):
        raise ValueError(
            f"duration must be at least {fewest * interval:.4g} ({fewest} snapshots), got "
            f"{duration:g}; average='ensemble' takes any duration"
        )
    whole = math.ceil(snapshots - 1e-9)
    if replicas >= _BLOCKS:
        return whole, 1, _ENDLESS
    block = max(math.ceil(_BLOCK * correlation_time(chain) / interval - 1e-9), 1)
    return whole, 2 * math.ceil(_BLOCKS / replicas / 2), block


def too_short(chain: Chain, duration: float, warmup: float, replicas: int, at_rest: bool) -> str:
    """Return in what an average over time is too short for the memory of the chain, or nothing.

    ``at_rest``: the start is no state of the steady state, so that the warm-up must forget it.
    A chain that neither gains nor loses energy has averages over time, which its start decides.
    """
    if chain.amplitude == chain.damping == 0 < max(chain.stiffness, chain.box):
        return ""
    if reason := chain.why_unsteady:
        return (
            f"{reason}. Without a steady state the error bars of averages over time mean nothing; "
            "average='ensemble' averages over replicas at equal times"
        )
    memory = f"is short for a chain with the relaxation time {relaxation_time(chain):.3g}: "
    least = _BLOCK * correlation_time(chain) * math.ceil(_FEWEST_BLOCKS / replicas)
    if replicas < _FEWEST_BLOCKS and duration < least * (1 - 1e-9):
        return (
            f"duration={duration:g} {memory}error bars are too small; take at least {least:.4g}, "
            f"or {_FEWEST_BLOCKS} replicas"
        )
    enough = _ENOUGH * relaxation_time(chain)
    if at_rest and warmup < enough * (1 - 1e-9):
        return (
            f"warmup={warmup:g} {memory}averages still contain the start; take at least "
            f"{enough:.4g}"
        )
    return ""


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
