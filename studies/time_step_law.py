"""How does the error of a time step depend on its length? What is behind the stated error.

    python -m studies.time_step_law RESTITUTION [--size 100] [--damping 1] [--longest 0.5]
           [--levels 3] [--duration 60000] [--runs 8]

Chains at several steps, each three times as long as the one before, are driven by the same noise,
so that much of the statistical error cancels in their ratios. ``--longest`` is the kick of the
longest step over W_v in the centre, r = (A sqrt(dt)/m)/W_v, as it is estimated beforehand. The
table gives the deviations from the shortest step: of W_v in the centre and in the middle third of
the rods, of the mean displacement of the outer tenth, and of W_v in the middle third right after
the drift, before the half kick that makes it larger by about the fraction r^2/4. ``--duration`` is
that of all runs together.
"""

import math

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles.scales import centre_width
from studies.common import Table, options, percents, print_table
from studies.time_step import Copy, make_copy, measure_all, reported

RATIO = 3
QUANTITIES = ("W_v, centre", "W_v, middle third", "<dx>, outer tenth", "W_v after the drift")


def quantities(copy: Copy, steps: int) -> np.ndarray:
    centre, _, _, displacement, _ = reported(copy, steps)
    size = copy.y.size
    squares = (copy.sums[2] / steps)[size // 3 : size - size // 3].mean()
    step = copy.dynamics.step
    later = step.outer_decay**2 * squares + step.outer_noise**2
    return np.array([centre, math.sqrt(later), displacement, math.sqrt(squares)])


def table(chain: Chain, longest: float, levels: int, duration: float, runs: int) -> Table:
    yield "r", "compared with r", *QUANTITIES
    width = centre_width(chain) * chain.free_velocity_width
    time_step = (longest * width * chain.mass / chain.amplitude) ** 2
    steps = [time_step / RATIO**level for level in reversed(range(levels))]
    rows = []
    for seed in range(runs):
        copies = tuple(make_copy(chain, step) for step in steps)
        number = measure_all(copies, RATIO, duration / runs, seed)
        rows.append([quantities(copy, number) for copy in copies])
    values = np.array(rows)
    deviation = 100 * np.log(values[:, 1:] / values[:, :1])
    mean, error = deviation.mean(axis=0), deviation.std(axis=0, ddof=1) / math.sqrt(runs)
    kicks = chain.amplitude / chain.mass * np.sqrt(steps) / values[:, 0, 0].mean()
    for kick, *row in zip(kicks[1:], mean, error, strict=True):
        yield f"{kick:.2f}", f"{kicks[0]:.2f}", *percents(*row)


if __name__ == "__main__":
    asked = options(
        __doc__,
        restitution=float,
        size=100,
        damping=1.0,
        longest=0.5,
        levels=3,
        duration=60_000.0,
        runs=8,
    )
    chain = Chain(size=asked.size, restitution=asked.restitution, damping=asked.damping)
    print_table(table(chain, asked.longest, asked.levels, asked.duration, asked.runs))
