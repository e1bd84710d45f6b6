"""How long and how finely to simulate: time step, warm-up and sampling, from the chain's scales.

The scales of a chain are the spring's rate w0 = sqrt(F'(d)/m), taken for a quadratic spring at
the displacement d that ten times the temperature reaches, and the damping rate gamma/m.

* time step: 0.05 / max(w0, gamma/m), which gives the splitting scheme W_x right to 3e-4 (linear
  springs, no gap). Off e = 1 the noise must be resolved too: rods that touch lose what one kick
  gave them before the next one, and W_v of a dissipative chain comes out too small where it is
  smallest, in the centre, by about 0.24 r^(3/2) with r = (A sqrt(dt)/m)/W_v, the velocity kick
  of one step over W_v. r is held at 0.12 (1 %), W_v being estimated by :func:`centre_width`,
  but the step is not made shorter than 1/500 of the above, which about 1000 rods
  need at e = 0. Whatever the step, the result states this error (:func:`time_step_error`).
* warm-up: 12 relaxation times of the slowest mode, so the start has decayed to exp(-12); none
  with a given start or for an ensemble, whose time begins with the start.
* snapshots: every 10 steps; for an ensemble every hundredth of the duration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.chain import check_real

_RESOLUTION = 0.05
_KICK = 0.12
_KICK_ERROR = 0.24  # relative error of W_v for a kick of r W_v is this times r^(3/2)
_MOST_REFINED = 500
_STRIDE = 10
_RELAXATIONS = 12
_BLOCKS = 64
_OUTPUTS = 100

Average = Literal["time", "ensemble"]
Stepper = Literal["splitting", "euler"]


@dataclass(frozen=True)
class Schedule:
    """A run in whole numbers: steps of warm-up, then blocks of snapshots ``stride`` steps apart.

    In an ensemble every block is one snapshot, at one output time, the first one of the start.
    """

    time_step: float
    warmup_steps: int
    stride: int
    blocks: int
    snapshots_per_block: int
    ensemble: bool = False

    @property
    def warmup(self) -> float:
        """Duration of the warm-up."""
        return self.warmup_steps * self.time_step

    @property
    def snapshots(self) -> int:
        """Snapshots of each replica."""
        return self.blocks * self.snapshots_per_block

    @property
    def steps(self) -> int:
        """Steps that a replica takes, warm-up included."""
        return self.warmup_steps + (self.snapshots - self.ensemble) * self.stride

    def step_of(self, snapshot: int) -> int:
        """Return the steps that a replica has taken when a snapshot, counted from 0, is due."""
        return self.warmup_steps + (snapshot + (not self.ensemble)) * self.stride

    @property
    def duration(self) -> float:
        """Duration that is measured, per replica."""
        return (self.steps - self.warmup_steps) * self.time_step

    @property
    def times(self) -> NDArray[np.float64]:
        """Time of every snapshot of a replica, shape (snapshots,)."""
        return self.time(np.arange(float(self.snapshots)))

    def time(self, snapshot: NDArray[np.float64]) -> NDArray[np.float64]:
        """Time of snapshots by their numbers, from 0; of a half, the middle of two."""
        count = snapshot + (not self.ensemble)
        return np.asarray(self.warmup + count * (self.stride * self.time_step))


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
    return max(min(step, ratio**2 * chain.mass / (2 * chain.damping)), step / _MOST_REFINED)


def longest_step(chain: Chain, stepper: Stepper) -> float:
    """Time step from which on a swinging rod gains energy without end, or its damping does.

    2/w0 with the splitting; with euler 4/(g + sqrt(g^2 + 4 w0^2)), g = gamma/m. Infinite for a
    quadratic spring without damping, which has no rate: there the steps show whether it diverges.
    """
    if chain.spring == "quadratic" and math.isinf(chain.temperature):
        return math.inf
    rate = spring_rate(chain)
    damping = chain.damping / chain.mass if stepper == "euler" else 0.0
    slowest = damping + math.hypot(damping, 2 * rate)
    return 4 / slowest if slowest > 0 else math.inf


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


def make_schedule(
    chain: Chain,
    *,
    duration: float,
    warmup: float | None = None,
    time_step: float | None = None,
    every: float | None = None,
    average: Average = "time",
    replicas: int = 1,
    stepper: Stepper = "splitting",
    started: bool = False,
) -> Schedule:
    """Check the times a user gave, fill in those not given, and return whole numbers of steps.

    For averages in time 64 blocks in all give the standard errors; the measured duration is
    rounded up so that they are equally long. ``every``, the time between snapshots, is kept
    exactly: the step becomes a whole fraction of it.
    """
    ensemble = average == "ensemble"
    duration = check_real("duration", duration, positive=True)
    if every is None and ensemble:
        every = duration / _OUTPUTS
    step, stride = _step_and_stride(chain, time_step, every, stepper)
    if warmup is None:
        warmup = 0.0 if started or ensemble else _RELAXATIONS * relaxation_time(chain)
    warmup = check_real("warmup", warmup)
    if (warmup + duration) / step > 1e15:
        raise ValueError(f"time_step {step:g} is too small for {warmup + duration:g} time units")
    warmup_steps = math.ceil(warmup / step - 1e-9)
    snapshots = duration / (stride * step)
    if ensemble:
        if snapshots < 1 - 1e-9:
            raise ValueError(f"every must be at most the duration {duration:g}, got {every:g}")
        times = math.ceil(snapshots - 1e-9) + 1
        return Schedule(step, warmup_steps, stride, times, 1, ensemble=True)
    blocks = math.ceil(_BLOCKS / replicas)
    if snapshots < blocks:
        least = blocks * stride * step
        raise ValueError(
            f"duration must be at least {least:.4g} (one snapshot in each of {blocks} blocks), "
            f"got {duration:g}"
        )
    # A hair of tolerance: a duration that is a whole number of blocks stays one.
    return Schedule(step, warmup_steps, stride, blocks, math.ceil(snapshots / blocks - 1e-9))


def _step_and_stride(
    chain: Chain, time_step: float | None, every: float | None, stepper: Stepper
) -> tuple[float, int]:
    """Return the length of a step, checked or chosen, and the steps from snapshot to snapshot."""
    if time_step is None:
        step = default_time_step(chain)
    else:
        step = check_real("time_step", time_step, positive=True)
        limit = longest_step(chain, stepper)
        if step >= limit:
            raise ValueError(f"time_step must be below {limit:.3g} to be stable, got {step:g}")
    if every is None:
        return step, _STRIDE
    every = check_real("every", every, positive=True)
    if every / step > 1e15:
        raise ValueError(f"time_step {step:g} is too small for snapshots every {every:g}")
    stride = max(math.ceil(every / step - 1e-9), 1)
    return every / stride, stride
