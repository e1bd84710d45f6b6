"""The times of a run: its time step, its warm-up, and whether it is long enough.

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

from crazybilliards.model import Chain
from crazybilliards.model.checks import check_real
from crazybilliards.particles.dynamics import Stepper, longest_step
from crazybilliards.particles.scales import (
    correlation_time,
    default_time_step,
    relaxation_time,
    settling_time,
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
    blocks, block = 2 * math.ceil(_BLOCKS / replicas / 2), _ENDLESS
    if replicas >= _BLOCKS:
        blocks = 1
    else:
        block = max(math.ceil(_BLOCK * correlation_time(chain) / interval - 1e-9), 1)
    return math.ceil(snapshots - 1e-9), blocks, block


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
