"""How far is a time step from the limit dt -> 0? docs/tables/time_step.csv.

    python -m studies.time_step [--size 100 ...] [--restitution 0 ...] [--longer 1] [--share 1]
           [--runs 8] [--strength 1]

For restitutions and sizes: widths, displacements and the kurtosis of the velocities at the default
step (or ``--longer`` times it) and at a quarter of it, from eight runs unless told otherwise. Both
steps are driven by the same noise, so that much of the statistical error cancels in their ratio.
What the finer step is still off is taken from an error ~ dt^(3/2) below the critical restitution
and at e = 1, and ~ dt^(3/4) elsewhere. The whole table takes hours on one core; ``--share 0.1``
takes a tenth of the time. With ``--strength`` the kicks that open closed contacts are that many
times as strong at the longer step. 1 is no correction, as in version 0.1. The deviation from the
finer step, which has the default strength, is then given as it is below the critical restitution.
"""

import math
from typing import NamedTuple

import numpy as np

from crazybilliards.model import Array, Chain
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.model.kernels import inlined, kernel
from crazybilliards.particles.dynamics import Dynamics, make_dynamics
from crazybilliards.particles.laws import law as laws
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION, strengthen
from crazybilliards.particles.laws.law import Scratch, make_scratch
from crazybilliards.particles.noise import Noise, fill, make_noise
from crazybilliards.particles.scales import default_time_step
from crazybilliards.reproduction.claims.study import error_of_mean
from studies.common import Table, options, percents, print_table

WARM_UP = 60.0
FINER = 4
CASES = [  # restitution, damping, size, time units in all
    (0.0, 1.0, 10, 400_000),
    (0.1, 1.0, 10, 200_000),
    (0.5, 1.0, 10, 200_000),
    (0.95, 1.0, 10, 200_000),
    (1.0, 1.0, 10, 400_000),
    (1.05, 4.0, 10, 200_000),
    (0.0, 1.0, 100, 20_000),
    (0.1, 1.0, 100, 10_000),
    (0.2, 1.0, 100, 10_000),
    (0.3, 1.0, 100, 10_000),
    (0.5, 1.0, 100, 10_000),
    (0.95, 1.0, 100, 30_000),
    (1.0, 1.0, 100, 200_000),
    (1.05, 4.0, 100, 30_000),
    (0.0, 1.0, 1000, 1600),
    (0.1, 1.0, 1000, 1600),
    (0.5, 1.0, 1000, 1600),
    (0.95, 1.0, 1000, 12_000),
    (1.0, 1.0, 1000, 80_000),
    (0.0, 1.0, 10_000, 300),
]
QUANTITIES = ("W_v, centre", "W_v, border", "W_x, centre", "<dx>, outer tenth", "kurtosis of v")


class Copy(NamedTuple):
    """A chain at one time step: its state, what moves it, and sums over the measurements."""

    y: np.ndarray
    v: np.ndarray
    dynamics: Dynamics
    scratch: Scratch
    kicks: np.ndarray  # (L,)
    sums: np.ndarray  # of d, d^2, v^2, v^4, (4, L)


def make_copy(chain: Chain, time_step: float) -> Copy:
    dynamics = make_dynamics(chain, time_step, speed=chain.free_velocity_width)
    v, kicks = np.zeros((2, chain.size))
    scratch, sums = make_scratch(chain.size), np.zeros((4, chain.size))
    return Copy(chain.reduced_anchors.copy(), v, dynamics, scratch, kicks, sums)


@kernel
def drift(y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Do what one of the laws does, which is a part of kernels and in no cache of its own."""
    return laws.drift(y, v, anchors, dt, law, scratch, tally)


@inlined(once=True)
def advance(copy: Copy, tally: Tally) -> None:
    """One step: kick by the noise in ``copy.kicks`` and the spring, drift, half a spring kick."""
    y, v, step, anchors = copy.y, copy.v, copy.dynamics.step, copy.dynamics.anchors
    if step.closed != 1.0:
        strengthen(copy.kicks, copy.scratch.clusters, step.closed)
    for i in range(v.size):
        v[i] = step.decay * v[i] + step.noise * copy.kicks[i] - step.kick * (y[i] - anchors[i])
    drift(y, v, anchors, step.time_step, copy.dynamics.law, copy.scratch, tally)
    for i in range(v.size):
        v[i] -= step.kick * (y[i] - anchors[i])


@kernel
def measure(copy: Copy) -> None:
    sums, anchors = copy.sums, copy.dynamics.anchors
    for i in range(copy.v.size):
        d, square = copy.y[i] - anchors[i], copy.v[i] ** 2
        sums[0, i] += d
        sums[1, i] += d * d
        sums[2, i] += square
        sums[3, i] += square * square


@kernel
def run(
    copies: tuple[Copy, ...],
    noise: Noise,
    xi: Array,
    tally: Tally,
    steps: int,
    measured: bool,
    finer: int,
) -> None:
    """Take steps, each ``finer`` times as long as that of the copy before it, under one noise.

    All copies are measured after each of the longest steps, whose number is given. ``xi`` has
    room for the noise of a step.
    """
    longest = finer ** (len(copies) - 1)
    step = copies[0].dynamics.step
    for taken in range(1, steps * longest + 1):
        fill(noise, xi)
        ratio = 1
        for number in range(len(copies)):
            copy = copies[number]
            for i in range(xi.size):
                if number == 0:
                    copy.kicks[i] = xi[i]
                else:  # the Ornstein-Uhlenbeck noise of all finest steps in one of this copy
                    copy.kicks[i] = step.decay * copy.kicks[i] + step.noise * xi[i]
            if taken % ratio == 0:
                if number > 0:
                    for i in range(xi.size):
                        copy.kicks[i] /= copy.dynamics.step.noise
                advance(copy, tally)
                for i in range(xi.size):
                    copy.kicks[i] = 0.0
            ratio *= finer
        if measured and taken % longest == 0:
            for copy in copies:
                measure(copy)


def measure_all(copies: tuple[Copy, ...], finer: int, duration: float, seed: int) -> int:
    """Run the copies, the finest one first, and return the number of the longest steps."""
    noise = make_noise(np.random.SeedSequence(seed))
    tally = make_tally(copies[0].y.size, contacts=False)
    xi, longest = np.empty(copies[0].y.size), copies[-1].dynamics.step.time_step
    steps = math.ceil(duration / longest)
    for taken, measured in ((math.ceil(WARM_UP / longest), False), (steps, True)):
        run(copies, noise, xi, tally, taken, measured, finer)
    return steps


def reported(copy: Copy, steps: int) -> np.ndarray:
    """Work out the quantities as ``simulate`` takes them: half a step of noise later."""
    mean, square, v2, v4 = copy.sums / steps
    c, h = copy.dynamics.step.outer_decay, copy.dynamics.step.outer_noise
    second = c**2 * v2 + h**2
    fourth = c**4 * v4 + 6 * c**2 * h**2 * v2 + 3 * h**4
    middle, tenth = middle_tenth(mean.size), max(mean.size // 10, 1)
    return np.array(
        [
            math.sqrt(second[middle].mean()),
            math.sqrt((second[0] + second[-1]) / 2),
            math.sqrt((square - mean**2)[middle].mean()),
            (mean[-tenth:].mean() - mean[:tenth].mean()) / 2,
            (fourth[middle] / second[middle] ** 2).mean(),
        ]
    )


def compared(
    chain: Chain, time_step: float, duration: float, seed: int, strength: float = math.nan
) -> np.ndarray:
    """Coarse over fine - 1 for every quantity, of one run; NaN: with the default strength."""
    fine, coarse = (make_copy(chain, dt) for dt in (time_step / FINER, time_step))
    if not math.isnan(strength):
        step = coarse.dynamics.step._replace(closed=strength)
        coarse = coarse._replace(dynamics=coarse.dynamics._replace(step=step))
    steps = measure_all((fine, coarse), FINER, duration, seed)
    return reported(coarse, steps) / reported(fine, steps) - 1


def table() -> Table:
    sizes, restitutions = (sorted({case[place] for case in CASES}) for place in (2, 0))
    asked = options(
        __doc__,
        size=sizes,
        restitution=restitutions,
        longer=1.0,
        share=1.0,
        runs=8,
        strength=math.nan,
    )
    yield "e", "L", "gamma", "time step", *(f"{name}, %" for name in QUANTITIES)
    for e, damping, size, duration in CASES:
        if size not in asked.size or e not in asked.restitution:
            continue
        chain = Chain(size=size, restitution=e, damping=damping)
        step = asked.longer * default_time_step(chain)
        each = asked.share * duration / asked.runs
        found = [compared(chain, step, each, seed, asked.strength) for seed in range(asked.runs)]
        corrected = e < CRITICAL_RESTITUTION
        order = 1.5 if corrected or e == 1 else 0.75
        rest = 0.0 if corrected and not math.isnan(asked.strength) else FINER**-order
        deviation = 100 / (1 - rest) * np.array(found)
        shown = percents(deviation.mean(axis=0), error_of_mean(deviation))
        yield f"{e:g}", size, f"{damping:g}", f"{step:.1e}", *shown


if __name__ == "__main__":
    print_table(table())
