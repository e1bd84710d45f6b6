"""How far the default time step is from the limit dt -> 0: a table for the documentation.

    python benchmarks/time_step.py

For restitutions and sizes: W_v in the centre (the middle tenth of the chain) and at the border at
the default step and at a quarter of it, from eight independent runs each, and the limit that the
two extrapolate to with an error ~ dt^(3/4). Takes about 40 minutes on one core.
"""

from typing import NamedTuple

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.schedule import default_time_step

RUNS = 8
CASES = [  # restitution, damping, size, time units in all
    (0.0, 1.0, 10, 400_000),
    (0.5, 1.0, 10, 200_000),
    (0.95, 1.0, 10, 200_000),
    (1.0, 1.0, 10, 400_000),
    (1.05, 4.0, 10, 200_000),
    (0.0, 1.0, 100, 40_000),
    (0.5, 1.0, 100, 20_000),
    (0.95, 1.0, 100, 30_000),
    (1.0, 1.0, 100, 200_000),
    (1.05, 4.0, 100, 30_000),
    (0.0, 1.0, 1000, 3000),
    (0.95, 1.0, 1000, 2000),
    (0.5, 1.0, 1000, 1200),
    (1.0, 1.0, 1000, 10_000),
]


class Widths(NamedTuple):
    """W_v in the centre and at the border, shape (2,), and their standard errors."""

    value: np.ndarray
    error: np.ndarray


def widths(chain: Chain, time_step: float, duration: float) -> Widths:
    middle = slice(*np.round(chain.size * np.array([0.45, 0.55])).astype(int))
    seen = []
    for seed in range(RUNS):
        run = simulate(
            chain,
            duration=duration / RUNS,
            warmup=60,
            time_step=time_step,
            seed=seed,
            observe="widths",
            threads=1,
            progress=False,
        )
        square = run.velocity_width.values**2
        seen.append(np.sqrt([square[middle].mean(), (square[0] + square[-1]) / 2]))
    return Widths(np.mean(seen, axis=0), np.std(seen, axis=0, ddof=1) / np.sqrt(RUNS))


def main() -> None:
    print("| e | L | time step | centre, % | border, % |")
    print("|---|---|---|---|---|")
    for restitution, damping, size, duration in CASES:
        chain = Chain(size=size, restitution=restitution, damping=damping)
        step = default_time_step(chain)
        coarse, fine = (widths(chain, dt, duration) for dt in (step, step / 4))
        share = 1 / (4**0.75 - 1)
        limit = fine.value + share * (fine.value - coarse.value)
        deviation = 100 * (coarse.value / limit - 1)
        error = 100 * (1 + share) * np.hypot(coarse.error, fine.error) / limit
        shown = [f"{d:+.1f} ± {s:.1f}" for d, s in zip(deviation, error, strict=True)]
        print(f"| {restitution} | {size} | {step:.1e} | {' | '.join(shown)} |", flush=True)


if __name__ == "__main__":
    main()
