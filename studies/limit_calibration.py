"""Do the error bars of a limit dt -> 0 mean what they say? A table for the documentation.

    python -m studies.limit_calibration [--seeds 40] [--finer 8] [--only 0 1 2]

Limits of W_v in the centre of ten chains, which differ in their seeds only. The table gives the
root mean square of their deviations from the truth in their stated errors, which should be 1 or,
with the expected bias in them, a little less; the deviation of their mean from the truth, over the
accuracy, and its standard error; and the seconds of one limit. The truth is exact at e = 1.
Elsewhere it is a limit of ``--finer`` times the accuracy, with a far shorter step.
"""

import time

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles import simulate_limit
from studies.common import options, print_heads, print_row

CHAINS = [
    (Chain(size=300, restitution=0), 0.015),
    (Chain(size=3, restitution=0, damping=0.1), 0.01),
    (Chain(size=30, restitution=0.1), 0.015),
    (Chain(size=100, restitution=0.3), 0.025),
    (Chain(size=10, restitution=0.5, gap=1), 0.01),
    (Chain(size=30, restitution=0.5, spring="quadratic"), 0.02),
    (Chain(size=30, restitution=0.9), 0.01),
    (Chain(size=100, restitution=0.95, damping=0.2), 0.01),
    (Chain(size=10, gap=1, amplitude=3), 0.007),
    (Chain(size=30, spring="quadratic"), 0.007),
]


def centres(chain: Chain, accuracy: float, seeds: range) -> np.ndarray:
    """Return W_v in the centre and its error for every seed, (seeds, 2)."""
    how = {"accuracy": accuracy, "observe": "widths", "threads": 1, "progress": False}
    limits = [simulate_limit(chain, seed=seed, **how) for seed in seeds]
    return np.array(
        [(each.central_velocity_width, each.central_velocity_width_error) for each in limits]
    )


def main() -> None:
    asked = options(__doc__, seeds=40, finer=8.0, only=list(range(len(CHAINS))))
    print_heads("chain", "accuracy", "rms / stated", "bias / accuracy", "s")
    for chain, accuracy in (CHAINS[number] for number in asked.only):
        begin = time.process_time()
        widths, stated = centres(chain, accuracy, range(asked.seeds)).T
        seconds = (time.process_time() - begin) / asked.seeds
        truth, uncertain = chain.free_velocity_width, 0.0
        if chain.restitution != 1:
            [(truth, uncertain)] = centres(chain, accuracy / asked.finer, range(1000, 1001))
        off = widths - truth
        error = np.hypot(off.std(ddof=1) / asked.seeds**0.5, uncertain)
        print_row(
            f"L = {chain.size}, e = {chain.restitution:g}, g = {chain.gap:g}, "
            f"gamma = {chain.damping:g}, {chain.spring}",
            f"{accuracy:g}",
            f"{np.sqrt(np.mean((off / stated) ** 2)):.2f}",
            f"{off.mean() / truth / accuracy:+.2f} ± {error / truth / accuracy:.2f}",
            f"{seconds:.2f}",
        )


if __name__ == "__main__":
    main()
