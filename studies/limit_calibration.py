"""Do the error bars of a limit dt -> 0 mean what they say? A table for the documentation.

    python -m studies.limit_calibration [--seeds 40]

Limits of W_v in the centre of ten chains, which differ in their seeds only. The table gives the
root mean square of their deviations from the truth in their stated errors, which should be 1; the
mean deviation with its standard error, and the mean bias that they state, over the accuracy; and
the seconds of one limit. The truth is exact at e = 1. Elsewhere it was computed once with version
0.4, as a limit of coupled runs at several steps, or here at a sixteenth of the step.
"""

import time
from typing import Any

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles import simulate_limit
from studies.common import options, print_heads, print_row

# Chain, accuracy, and, except at e = 1, W_v in the centre with its standard error.
CHAINS = [
    (Chain(size=300, restitution=0), 0.015, 0.048813, 0.000108),
    (Chain(size=3, restitution=0, damping=0.1), 0.01, 0.66172, 0.00108),
    (Chain(size=30, restitution=0.1), 0.015, 0.118008, 0.000288),
    (Chain(size=100, restitution=0.3), 0.025, 0.075533, 0.000315),
    (Chain(size=10, restitution=0.5, gap=1), 0.01, 0.31295, 0.00033),
    (Chain(size=30, restitution=0.5, spring="quadratic"), 0.02, 0.13672, 0.00021),
    (Chain(size=30, restitution=0.9), 0.01, 0.192517, 0.000249),
    (Chain(size=100, restitution=0.95, damping=0.2), 0.01, 0.176892, 0.000235),
    (Chain(size=10, gap=1, amplitude=3), 0.007, 0.0, 0.0),
    (Chain(size=30, spring="quadratic"), 0.007, 0.0, 0.0),
]


def main() -> None:
    seeds = range(options(__doc__, seeds=40).seeds)
    print_heads("chain", "accuracy", "seeds", "rms", "bias", "stated bias", "s")
    for chain, accuracy, width, uncertain in CHAINS:
        truth = width or chain.free_velocity_width
        how: dict[str, Any] = {"accuracy": accuracy, "observe": "widths", "threads": 1}
        begin = time.process_time()
        limits = [simulate_limit(chain, seed=seed, progress=False, **how) for seed in seeds]
        seconds = (time.process_time() - begin) / len(seeds)
        off = np.array([float(each.central_velocity_width) for each in limits]) - truth
        stated = np.array([float(each.central_velocity_width_error) for each in limits])
        biases = [each.attrs["time_step_error"] for each in limits]
        error = np.hypot(off.std(ddof=1) / len(seeds) ** 0.5, uncertain)
        print_row(
            f"{chain.size} rods, e = {chain.restitution:g}, g = {chain.gap:g}, "
            f"gamma = {chain.damping:g}, A = {chain.amplitude:g}, {chain.spring}",
            f"{accuracy:g}",
            f"{len(seeds)}",
            f"{np.sqrt(np.mean((off / stated) ** 2)):.2f}",
            f"{off.mean() / truth / accuracy:+.2f} ± {error / truth / accuracy:.2f}",
            f"{np.mean(biases) / accuracy:.2f}",
            f"{seconds:.2f}",
        )


if __name__ == "__main__":
    main()
