"""What the threshold below which rods merge changes, and what it costs.

    python -m studies.merging RESTITUTION [--size 100] [--duration 30000]
           [--thresholds 0.03 0.1 0.3]

Chains at the default step are driven by the same noise, each with its own threshold. The table
gives their collisions per rod and step and their computing time, both as ratios to the first
threshold, and the deviations from it, in %, of W_v and of the relative velocity of neighbours, both
in the middle third of the rods and of W_v of the two rods at the ends. Errors are those of a
jackknife over 32 parts of the run.
"""

import math
import time

import numpy as np

from crazybilliards.model import Array, Chain
from crazybilliards.model.kernels import kernel
from crazybilliards.particles.dynamics import Dynamics, make_dynamics
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.law import Scratch, make_scratch
from crazybilliards.particles.noise import fill, make_noise
from crazybilliards.particles.scales import centre_width, default_time_step
from crazybilliards.particles.stepping import WHOLE, take_step
from studies.common import Table, options, percents, print_table

WARM_UP = 60.0
PARTS = 32
STEPS = 200  # of one call
QUANTITIES = ("W_v, middle third", "relative velocity", "W_v, ends")


@kernel(allocates=True)
def run(
    y: Array,
    v: Array,
    noise: Array,
    dynamics: Dynamics,
    scratch: Scratch,
    tally: Tally,
    sums: Array,
) -> int:
    """Take a step for each row of ``noise``; add the squares after each, and return collisions."""
    size, collisions, step = y.size, 0, dynamics.step
    low, high = size // 3, size - size // 3
    kicks, now = np.empty(size), np.empty(size)
    for row in range(noise.shape[0]):
        for i in range(size):
            kicks[i] = noise[row, i]
        collisions += take_step(y, v, kicks, WHOLE, dynamics, scratch, tally)
        for i in range(size):
            pull = step.kick * (y[i] - dynamics.anchors[i])
            now[i] = step.outer_decay * (v[i] - pull)
        for i in range(low, high):
            sums[0] += (now[i] ** 2 + step.outer_noise**2) / (high - low)
            sums[1] += ((now[i + 1] - now[i]) ** 2 + 2 * step.outer_noise**2) / (high - low)
        sums[2] += (now[0] ** 2 + now[-1] ** 2) / 2 + step.outer_noise**2
    return collisions


def measured(
    chain: Chain, thresholds: list[float], duration: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the squares (parts, thresholds, 3), collisions and seconds of all thresholds."""
    step = default_time_step(chain)
    chains = []
    for threshold in thresholds:
        random = np.random.default_rng(0)
        y = np.sort(random.normal(scale=chain.thermal_length / 2, size=chain.size))
        v = random.normal(scale=centre_width(chain) * chain.free_velocity_width, size=chain.size)
        chains.append((y, v, make_dynamics(chain, step, speed=1.0, merging=threshold)))
    noise, rows = make_noise(np.random.SeedSequence(0)), np.zeros((STEPS, chain.size))
    scratches = [make_scratch(chain.size) for _ in thresholds]
    tally, sums = make_tally(chain.size, contacts=False), np.zeros((PARTS, len(thresholds), 3))
    collisions, seconds = np.zeros((2, len(thresholds)))
    calls = math.ceil(duration / PARTS / step / STEPS)
    warming = math.ceil(WARM_UP / step / STEPS)
    for call in range(-warming, PARTS * calls):
        fill(noise, rows.ravel())
        into = sums[call // calls] if call >= 0 else np.zeros((len(thresholds), 3))
        for number, (y, v, dynamics) in enumerate(chains):
            started = time.thread_time()
            met = run(y, v, rows, dynamics, scratches[number], tally, into[number])
            if call >= 0:
                collisions[number] += met
                seconds[number] += time.thread_time() - started
    return sums, collisions / (PARTS * calls * STEPS * chain.size), seconds


def deviations(sums: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    without = sums.sum(axis=0) - sums
    each = 50 * np.log(without[:, 1:] / without[:, :1])
    whole = 50 * np.log(sums.sum(axis=0)[1:] / sums.sum(axis=0)[:1])
    return whole, np.sqrt((PARTS - 1) * each.var(axis=0))


def table(chain: Chain, thresholds: list[float], duration: float) -> Table:
    yield "threshold", "collisions", "time", *QUANTITIES
    sums, collisions, seconds = measured(chain, thresholds, duration)
    rows = zip(*deviations(sums), strict=True)
    for number, (threshold, row) in enumerate(zip(thresholds[1:], rows, strict=True), start=1):
        ratios = (f"{values[number] / values[0]:.2f}" for values in (collisions, seconds))
        yield f"{threshold:g}", *ratios, *percents(*row)


if __name__ == "__main__":
    asked = options(
        __doc__, restitution=float, size=100, duration=30_000.0, thresholds=[0.03, 0.1, 0.3]
    )
    chain = Chain(size=asked.size, restitution=asked.restitution)
    print_table(table(chain, asked.thresholds, asked.duration))
