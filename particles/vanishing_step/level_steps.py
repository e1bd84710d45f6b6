"""The time steps of the levels of a limit dt -> 0, chosen before anything is computed.

The shortest step is chosen so that its expected error is a quarter of the accuracy. This error is
that of velocities (``scales.time_step_error``) plus, on linear springs, (w0 dt)^2/8, which only
displacements have there. Each longer step is nine times the one before. Runs at two steps are
correlated about equally for the ratios three and nine (0.97 to 0.99 for 100 rods at e = 0), and
nine needs fewer levels. A step whose velocity kicks exceed 1.5 W_v is not correlated with any
other. One level with a third of the shortest step is planned in reserve, in case the shortest step
turns out to be too long.

For e = 1 the step need not resolve the noise. Its error is that of the springs, which is known, and
one level is enough. Where the motion of the chain is known exactly (``laws/exact_flight.py``) there
is no error, and the step is the time between snapshots.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from crazybilliards.model import Chain
from crazybilliards.particles.laws.exact_flight import independent_rods
from crazybilliards.particles.scales import (
    centre_width,
    correlation_time,
    default_time_step,
    settling_time,
    spring_rate,
    time_step_error,
)
from crazybilliards.particles.schedule import RELAXATIONS, STRIDE

GROUPS = 32  # of a level: a standard error is then known to an eighth
_RATIO, _NARROW_RATIO = 9, 3  # of successive steps; of the one in reserve
_EXPECTED = 0.25  # bias, in units of the accuracy
_LONGEST_KICK = 1.5  # in W_v: with a longer step nothing is correlated
_SPRINGS = 0.5  # longest step, over that of spring or damping
# Least duration of a group, in correlation times. The means of successive groups of the base are
# then correlated by 0.06 at most, which makes a standard error 5 % too small.
_LEAST, _PILOT = 10.0, 2.5  # of the base, of a difference


class Steps(NamedTuple):
    """The levels in whole numbers: the steps, the longest first, and their snapshots."""

    time_steps: list[float]
    ratios: list[int]  # of the step before to this one; 1 for the first
    warmup: int  # longest steps
    stride: int  # longest steps from snapshot to snapshot
    least: int  # snapshots of a group of the base
    pilot: int  # of a group of a difference, in the pilot round

    @property
    def interval(self) -> float:
        """Time from snapshot to snapshot."""
        return self.stride * self.time_steps[0]

    def per_step(self, level: int) -> int:
        """Return how many steps of a level the longest one has."""
        return math.prod(self.ratios[: level + 1])


def expected_bias(chain: Chain, time_step: float, width: float) -> tuple[float, float]:
    """Relative errors of velocities and of displacements that a step is expected to cause."""
    if independent_rods(chain):
        return 0.0, 0.0
    bias = time_step_error(chain, time_step, width)
    springs = (spring_rate(chain) * time_step) ** 2 / 8 if chain.spring == "linear" else 0.0
    return bias, bias + springs


def plan_steps(chain: Chain, accuracy: float, warmup: float | None) -> Steps:
    """Choose the steps of the levels; the last one is used only if the bias is too large."""
    interval = STRIDE * default_time_step(chain)
    step, ratios = interval, [1]
    if not independent_rods(chain):
        step, ratios = _inexact_steps(chain, accuracy)
    time_steps = [step * math.prod(ratios[level + 1 :]) for level in range(len(ratios))]
    first = time_steps[0]
    stride = max(round(interval / first), 1)
    warm = math.ceil((RELAXATIONS * settling_time(chain) if warmup is None else warmup) / first)
    least, pilot = (
        max(math.ceil(each * correlation_time(chain) / (stride * first)), 1)
        for each in (_LEAST, _PILOT)
    )
    return Steps(time_steps, ratios, warm, stride, least, pilot)


def _inexact_steps(chain: Chain, accuracy: float) -> tuple[float, list[int]]:
    """Return the shortest step and the ratios of the steps, for motion that is not exact."""
    width = centre_width(chain) * chain.free_velocity_width
    fastest = max(spring_rate(chain), chain.damping / chain.mass)
    longest = step = _SPRINGS / fastest
    while expected_bias(chain, step, width)[1] > _EXPECTED * accuracy:
        step *= 0.98
    ratios = [1]
    if chain.restitution != 1:
        kick = chain.amplitude / chain.mass / width
        longest = min(longest, (_LONGEST_KICK / kick) ** 2)
        while step * math.prod(ratios) * _RATIO <= longest:
            ratios.append(_RATIO)
        ratios.append(_NARROW_RATIO)
        step /= _NARROW_RATIO
    return step, ratios
