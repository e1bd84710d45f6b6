"""How long and how finely to simulate: time step, warm-up and sampling, from the chain's scales.

The scales of a chain are the spring's rate w0 = sqrt(F'(d)/m), taken for a quadratic spring at
the displacement d that ten times the temperature reaches, and the damping rate gamma/m.

* time step: 0.05 / max(w0, gamma/m), which gives the splitting scheme W_x right to 3e-4 (linear
  springs, no gap). Off e = 1 the noise must be resolved too: between two kicks rods that touch
  lose the memory of the first one, and W_v in the centre of a dissipative chain comes out too
  small, by an amount that falls only like sqrt(dt). The velocity kick of one step, A sqrt(dt)/m,
  is held at 0.12 of W_v there, estimated by :func:`centre_width`; compare with a smaller
  ``time_step`` where a per cent matters.
* warm-up: 12 relaxation times of the slowest mode, so the start has decayed to exp(-12).
* snapshots: every 10 steps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from crazybilliards.model import Chain
from crazybilliards.model.chain import check_real

_RESOLUTION = 0.05
_KICK = 0.12
_STRIDE = 10
_RELAXATIONS = 12
_BLOCKS = 64


@dataclass(frozen=True)
class Schedule:
    """A run in whole numbers: steps of warm-up, then blocks of snapshots for each replica."""

    time_step: float
    warmup_steps: int
    stride: int
    blocks: int
    snapshots_per_block: int

    @property
    def warmup(self) -> float:
        """Duration of the warm-up."""
        return self.warmup_steps * self.time_step

    @property
    def duration(self) -> float:
        """Duration that is measured, per replica."""
        return self.blocks * self.snapshots_per_block * self.stride * self.time_step


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
    displacement = (30 * chain.temperature / chain.stiffness) ** (1 / 3)
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
    crowd = chain.size / (1 + chain.gap * chain.size / max(2.5 * chain.thermal_length, 1e-60))
    rate = spring_rate(chain) * chain.mass / chain.damping
    return 1 / math.sqrt(1 + (0.1 + 0.14 * e**4) * (1 - e**2) * crowd * rate)


def default_time_step(chain: Chain) -> float:
    """Resolve spring, damping and, off restitution 1, the noise; see the top of this module."""
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


def make_schedule(
    chain: Chain,
    *,
    duration: float,
    warmup: float | None = None,
    time_step: float | None = None,
    replicas: int = 1,
    started: bool = False,
) -> Schedule:
    """Check the times a user gave, fill in those not given, and return whole numbers of steps.

    Block averages over 64 blocks in all give the standard errors; the measured duration is
    rounded up so that they are equally long. A run with a given start is not warmed up unless
    asked.
    """
    duration = check_real("duration", duration, positive=True)
    if time_step is None:
        step = default_time_step(chain)
    else:
        step = check_real("time_step", time_step, positive=True)
        if step * spring_rate(chain) >= 2:
            limit = 2 / spring_rate(chain)
            raise ValueError(f"time_step must be below 2/w0 = {limit:.3g} to be stable, got {step}")
    if warmup is None:
        warmup = 0.0 if started else _RELAXATIONS * relaxation_time(chain)
    warmup = check_real("warmup", warmup)
    blocks = math.ceil(_BLOCKS / replicas)
    snapshots = duration / (_STRIDE * step)
    # A hair of tolerance: a duration that is a whole number of blocks stays one.
    per_block = math.ceil(snapshots / blocks - 1e-9)
    if snapshots < blocks:
        least = blocks * _STRIDE * step
        raise ValueError(
            f"duration must be at least {least:.4g} (one snapshot in each of {blocks} blocks), "
            f"got {duration:g}"
        )
    if (warmup + duration) / step > 1e15:
        raise ValueError(f"time_step {step:g} is too small for {warmup + duration:g} time units")
    return Schedule(step, math.ceil(warmup / step - 1e-9), _STRIDE, blocks, per_block)
