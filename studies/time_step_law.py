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
from studies.common import options, percents, print_heads, print_row
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


def main() -> None:
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
    width = centre_width(chain) * chain.free_velocity_width
    longest = (asked.longest * width * chain.mass / chain.amplitude) ** 2
    steps = [longest / RATIO**level for level in reversed(range(asked.levels))]
    found = []
    for seed in range(asked.runs):
        copies = tuple(make_copy(chain, step) for step in steps)
        number = measure_all(copies, RATIO, asked.duration / asked.runs, seed)
        found.append([quantities(copy, number) for copy in copies])
    values = np.array(found)
    deviation = 100 * np.log(values[:, 1:] / values[:, :1])
    mean, error = deviation.mean(axis=0), deviation.std(axis=0, ddof=1) / math.sqrt(asked.runs)
    kicks = chain.amplitude / chain.mass * np.sqrt(steps) / values[:, 0, 0].mean()
    print(f"e = {asked.restitution:g}, L = {asked.size}, gamma = {asked.damping:g}, in %")
    print_heads("r", "compared with r", *QUANTITIES)
    for kick, of_step in zip(kicks[1:], zip(mean, error, strict=True), strict=True):
        print_row(f"{kick:.2f}", f"{kicks[0]:.2f}", *percents(*of_step))


if __name__ == "__main__":
    main()
