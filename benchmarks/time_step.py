"""How far the default time step is from the limit dt -> 0: a table for the documentation.

    python benchmarks/time_step.py [L ...]

For restitutions and sizes: W_v in the centre (the middle tenth of the chain) and at the border at
the default step and at a quarter of it, from eight runs, and the limit that the two extrapolate to
with an error ~ dt^(3/4). Both steps are driven by the same noise, so that much of the statistical
error cancels in their ratio. Takes hours on one core.
"""

import math
import sys
from typing import NamedTuple

import numpy as np
from numba import njit

from crazybilliards.model import Chain
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import Law, drift, make_law, make_scratch
from crazybilliards.particles.scales import default_time_step
from crazybilliards.particles.stepping import Step, make_step

RUNS = 8
WARM_UP = 60.0
FINER = 4
CASES = [  # restitution, damping, size, time units in all
    (0.0, 1.0, 10, 400_000),
    (0.5, 1.0, 10, 200_000),
    (0.95, 1.0, 10, 200_000),
    (1.0, 1.0, 10, 400_000),
    (1.05, 4.0, 10, 200_000),
    (0.0, 1.0, 100, 5000),
    (0.5, 1.0, 100, 10_000),
    (0.95, 1.0, 100, 30_000),
    (1.0, 1.0, 100, 200_000),
    (1.05, 4.0, 100, 30_000),
    (0.0, 1.0, 1000, 1600),
    (1.0, 1.0, 1000, 80_000),
    (0.95, 1.0, 1000, 12_000),
    (0.5, 1.0, 1000, 1600),
]


class Copy(NamedTuple):
    """A chain at one time step: its state, what moves it, and the sums of v^2, shape (L,)."""

    y: np.ndarray
    v: np.ndarray
    step: Step
    law: Law
    scratch: NamedTuple
    squares: np.ndarray


def make_copy(chain: Chain, time_step: float) -> Copy:
    y = chain.reduced_anchors.copy()
    law = make_law(chain, time_step, "event-driven", 0.03, chain.free_velocity_width)
    step = make_step(chain, time_step, "splitting")
    zeros = np.zeros((2, chain.size))
    return Copy(y, zeros[0], step, law, make_scratch(chain.size), zeros[1])


@njit
def advance(copy, anchors, xi, tally):
    """One step: kick by the noise ``xi`` and the spring, drift, second half of the spring's."""
    y, v, step = copy.y, copy.v, copy.step
    v[:] = step.decay * v + step.noise * xi - step.kick * (y - anchors)
    drift(y, v, step.time_step, copy.law, copy.scratch, tally)
    v -= step.kick * (y - anchors)


@njit
def run(coarse, fine, anchors, generator, tally, steps, measure):
    """Take coarse steps and finer ones under the same noise; sum v^2 of both after each."""
    xi = np.empty((FINER, anchors.size))
    weights = np.array([fine.step.decay ** (FINER - 1 - j) for j in range(FINER)])
    weights *= fine.step.noise / coarse.step.noise  # the Ornstein-Uhlenbeck noise of all four
    for _ in range(steps):
        for j in range(FINER):
            for i in range(anchors.size):
                xi[j, i] = generator.standard_normal()
            advance(fine, anchors, xi[j], tally)
        advance(coarse, anchors, (weights.reshape(-1, 1) * xi).sum(axis=0), tally)
        if measure:
            coarse.squares[:] += coarse.v**2
            fine.squares[:] += fine.v**2


def widths(chain: Chain, time_step: float, duration: float, seed: int) -> np.ndarray:
    """W_v, shape (coarse or fine, centre or border), of one run."""
    copies = [make_copy(chain, dt) for dt in (time_step, time_step / FINER)]
    generator = np.random.default_rng(seed)
    tally = make_tally(chain.size, contacts=False)
    middle = slice(*np.round(chain.size * np.array([0.45, 0.55])).astype(int))
    steps = math.ceil(duration / time_step)
    for taken, measure in ((math.ceil(WARM_UP / time_step), False), (steps, True)):
        run(*copies, chain.reduced_anchors, generator, tally, taken, measure)
    found = []
    for copy in copies:
        # The results of `simulate` are taken after half a step more of damping and noise.
        square = copy.step.outer_decay**2 * copy.squares / steps + copy.step.outer_noise**2
        found.append(np.sqrt([square[middle].mean(), (square[0] + square[-1]) / 2]))
    return np.array(found)


def main() -> None:
    sizes = [int(size) for size in sys.argv[1:]] or [10, 100, 1000]
    print("| e | L | time step | centre, % | border, % |")
    print("|---|---|---|---|---|")
    for restitution, damping, size, duration in CASES:
        if size not in sizes:
            continue
        chain = Chain(size=size, restitution=restitution, damping=damping)
        step = default_time_step(chain)
        found = np.array([widths(chain, step, duration / RUNS, seed) for seed in range(RUNS)])
        # coarse/limit - 1 = (1 + share) (coarse/fine - 1), limit = fine + share (fine - coarse)
        deviation = 100 * (1 + 1 / (FINER**0.75 - 1)) * (found[:, 0] / found[:, 1] - 1)
        mean, error = deviation.mean(axis=0), deviation.std(axis=0, ddof=1) / math.sqrt(RUNS)
        shown = [f"{d:+.1f} ± {s:.1f}" for d, s in zip(mean, error, strict=True)]
        print(f"| {restitution} | {size} | {step:.1e} | {' | '.join(shown)} |", flush=True)


if __name__ == "__main__":
    main()
