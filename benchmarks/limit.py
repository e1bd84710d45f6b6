"""What a limit dt -> 0 costs, against one run at one step: a table for the documentation.

    python benchmarks/limit.py [--accuracy 0.003] [--case 0 1 2]

W_v in the centre of the chain, to ``--accuracy`` in all. The limit is computed, and its rod-steps
and seconds of one core are counted, warm-up and pilot rounds included. The other one is worked out
for the scheme of version 0.1, once with the error b that this version stated, 0.24 r^(3/2) for a
velocity kick r W_v of one step, r = (A/m) sqrt(dt)/W_v, and once with the error that its scheme has
at 100 rods (``time_step.py`` with ``--strength 1`` at e = 0, ``time_step_law.py`` at e = 0.5). With
the standard error s the accuracy is sqrt(b^2 + s^2). The work ~ 1/(dt s^2) is least where b^2 is
1/(1 + 2 p) of it, if b ~ dt^p.
This gives dt, and the duration follows from the variance of W_v that the limit's longest step has
shown. The seconds are those of today's kernels at that step.
"""

import argparse
import json
import math
import time

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from crazybilliards.model import Chain
from crazybilliards.particles import simulate_limit
from crazybilliards.particles.dynamics import make_dynamics
from crazybilliards.particles.laws.avalanche import make_tally
from crazybilliards.particles.laws.law import make_scratch
from crazybilliards.particles.noise import make_noise
from crazybilliards.particles.scales import relaxation_time
from crazybilliards.particles.stepping import advance

CASES = [(0.0, 100), (0.0, 1000), (0.5, 100)]  # restitution, size

# By how much W_v is too small for a kick of r: terms a r^power, the first of which dominates.
STATED = ((0.24, 1.5),)  # by version 0.1
MEASURED = {0.0: ((0.21, 1.5), (-0.25, 2)), 0.5: ((0.103, 2.3), (-0.251, 4))}  # by restitution
WARM_UP = 12  # relaxation times
TIMED = 2_000_000  # rod-steps


def seconds_per_rod_step(chain: Chain, time_step: float) -> float:
    """Time the kernels in a state that the chain has come to in some thousand steps."""
    dynamics = make_dynamics(chain, time_step, speed=chain.free_velocity_width)
    y, v = chain.reduced_anchors.copy(), np.zeros(chain.size)
    noise, scratch = make_noise(np.random.SeedSequence(0)), make_scratch(chain.size)
    state = y, v, noise, dynamics, scratch, make_tally(chain.size, contacts=False)
    steps = TIMED // chain.size
    advance(*state, steps)
    begin = time.process_time()
    advance(*state, steps)
    return (time.process_time() - begin) / (steps * chain.size)


def old_work(
    chain: Chain, accuracy: float, limit: xr.Dataset, error: tuple[tuple[float, float], ...]
) -> tuple[float, float]:
    """Return the time step that version 0.1 would need with this error, and its rod-steps."""
    bias = accuracy / math.sqrt(1 + error[0][1])  # p is half the power of r
    kick = brentq(lambda r: sum(a * r**power for a, power in error) - bias, 0, 0.3)
    time_step = (kick * limit.central_velocity_width.item() * chain.mass / chain.amplitude) ** 2
    base = json.loads(limit.attrs["provenance"])["levels"][0]
    variance = (base["error"] / base["value"]) ** 2 * base["duration"]
    duration = variance / (accuracy**2 - bias**2) + WARM_UP * relaxation_time(chain)
    return time_step, duration / time_step * chain.size


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--accuracy", type=float, default=0.003)
    parser.add_argument("--case", type=int, nargs="*", default=range(len(CASES)))
    asked = parser.parse_args()
    simulate_limit(Chain(size=2, restitution=0), accuracy=0.1, progress=False)  # compiles
    beside = " | ".join(
        f"0.1, {error} error: dt | rod-steps | s | ratio of both"
        for error in ("stated", "measured")
    )
    print(f"| e | L | W_v | levels | rod-steps | s | {beside} |")
    print("|---" * 14 + "|")
    for case in asked.case:
        restitution, size = CASES[case]
        chain = Chain(size=size, restitution=restitution)
        begin = time.process_time()
        limit = simulate_limit(
            chain, accuracy=asked.accuracy, observe="widths", threads=1, progress=False
        )
        seconds = time.process_time() - begin
        levels = json.loads(limit.attrs["provenance"])["levels"]
        work = sum(level["rod_steps"] for level in levels)
        width, error = limit.central_velocity_width.item(), limit.central_velocity_width_error
        steps = ", ".join(f"{level['time_step']:.2g}" for level in levels)
        olds = []
        for of_its_scheme in (STATED, MEASURED[restitution]):
            step, old = old_work(chain, asked.accuracy, limit, of_its_scheme)
            old_seconds = old * seconds_per_rod_step(chain, step)
            ratios = f"{old / work:.2g}, {old_seconds / seconds:.2g}"
            olds.append(f"{step:.1e} | {old:.2g} | {old_seconds:.0f} | {ratios}")
        print(
            f"| {restitution} | {size} | {width:.5f} ± {error.item() / width:.2%} | {steps} | "
            f"{work:.2g} | {seconds:.0f} | {' | '.join(olds)} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
