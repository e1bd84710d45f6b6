"""How the error of a time step depends on its length: the measurements behind the stated error.

    python benchmarks/accuracy/time_step_law.py RESTITUTION [--size 100] [--longest 0.5]
           [--levels 3] [--duration 60000] [--runs 8]

Chains at several steps, each three times as long as the one before, are driven by the same noise,
so that much of the statistical error cancels in their ratios. ``--longest`` is the kick of the
longest step over W_v in the centre, r = (A sqrt(dt)/m)/W_v, as it is estimated beforehand. The
table gives the deviations from the shortest step: of W_v in the centre and in the middle third of
the rods, of the mean displacement of the outer tenth, and of W_v in the middle third right after
the drift, before the half kick that makes it larger by about the fraction r^2/4.
"""

import argparse
import math

import numpy as np
from time_step import WARM_UP, Copy, advance, make_copy, measure, reported

from crazybilliards.model import Chain
from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.noise import fill, make_noise
from crazybilliards.particles.scales import centre_width

RATIO = 3
QUANTITIES = ("W_v, centre", "W_v, middle third", "<dx>, outer tenth", "W_v after the drift")


@kernel(allocates=True)
def run(copies, anchors, noise, tally, steps, measured):
    """Take longest steps of all chains under the same noise; measure all after each."""
    xi = np.empty(anchors.size)
    finest, longest = copies[0], RATIO ** (len(copies) - 1)
    for taken in range(1, steps * longest + 1):
        fill(noise, xi)
        finest.kicks[:] = xi
        advance(finest, anchors, tally)
        ratio = 1
        for number in range(1, len(copies)):
            copy, ratio = copies[number], ratio * RATIO
            # The Ornstein-Uhlenbeck noise of all finest steps in one of this chain.
            for i in range(xi.size):
                copy.kicks[i] = finest.step.decay * copy.kicks[i] + finest.step.noise * xi[i]
            if taken % ratio == 0:
                copy.kicks[:] /= copy.step.noise
                advance(copy, anchors, tally)
                copy.kicks[:] = 0.0
        if measured and taken % longest == 0:
            for copy in copies:
                measure(copy, anchors)


def quantities(copy: Copy, steps: int) -> np.ndarray:
    centre, _, _, displacement, _ = reported(copy, steps)
    size = copy.y.size
    squares = (copy.sums[2] / steps)[size // 3 : size - size // 3].mean()
    later = copy.step.outer_decay**2 * squares + copy.step.outer_noise**2
    return np.array([centre, math.sqrt(later), displacement, math.sqrt(squares)])


def measured(chain: Chain, longest: float, levels: int, duration: float, seed: int) -> np.ndarray:
    """Return the quantities of one run at every step, (levels, 4)."""
    steps = [longest / RATIO**level for level in reversed(range(levels))]
    copies = tuple(make_copy(chain, step) for step in steps)
    noise = make_noise(np.random.SeedSequence(seed))
    tally = make_tally(chain.size, contacts=False)
    anchors, number = chain.reduced_anchors, math.ceil(duration / longest)
    run(copies, anchors, noise, tally, math.ceil(WARM_UP / longest), False)
    run(copies, anchors, noise, tally, number, True)
    return np.array([quantities(copy, number) for copy in copies])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("restitution", type=float)
    parser.add_argument("--size", type=int, default=100)
    parser.add_argument("--damping", type=float, default=1.0)
    parser.add_argument("--longest", type=float, default=0.5, help="kick over W_v in the centre")
    parser.add_argument("--levels", type=int, default=3)
    parser.add_argument("--duration", type=float, default=60_000.0, help="of all runs together")
    parser.add_argument("--runs", type=int, default=8)
    asked = parser.parse_args()
    chain = Chain(size=asked.size, restitution=asked.restitution, damping=asked.damping)
    width = centre_width(chain) * chain.free_velocity_width
    longest = (asked.longest * width * chain.mass / chain.amplitude) ** 2
    each = asked.duration / asked.runs
    found = np.array(
        [measured(chain, longest, asked.levels, each, seed) for seed in range(asked.runs)]
    )
    deviation = 100 * np.log(found[:, 1:] / found[:, :1])
    mean, error = deviation.mean(axis=0), deviation.std(axis=0, ddof=1) / math.sqrt(asked.runs)
    kicks = [
        chain.amplitude / chain.mass * math.sqrt(longest / RATIO**level) / found[:, 0, 0].mean()
        for level in reversed(range(asked.levels))
    ]
    print(f"e = {asked.restitution:g}, L = {asked.size}, gamma = {asked.damping:g}, in %")
    print(f"| r | compared with r | {' | '.join(QUANTITIES)} |")
    print("|---" * (2 + len(QUANTITIES)) + "|")
    for level in range(1, asked.levels):
        shown = [
            f"{d:+.2f} ± {s:.2f}" for d, s in zip(mean[level - 1], error[level - 1], strict=True)
        ]
        print(f"| {kicks[level]:.2f} | {kicks[0]:.2f} | {' | '.join(shown)} |")


if __name__ == "__main__":
    main()
