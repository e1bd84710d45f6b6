"""What a run costs in one version of the package, against another one.

    python benchmarks/versions.py OLD_PYTHON NEW_PYTHON [--time-step 1e-3] [--rounds 5]

OLD_PYTHON and NEW_PYTHON are interpreters of environments in which the two versions are installed.
Both simulate the same chains, in turns, for the same time, each with its own default time step
unless ``--time-step`` is given. Printed are, of each version, the computing time of one unit of
time [T] (median) and the error of the smallest W_v that the version expects of its time step, and
the ratio new/old of the times. Only arguments of ``simulate`` that all versions have are used.
"""

import argparse
import json
import subprocess
import sys
from statistics import median

CHAINS = [  # restitution, size, time units of a round at the default step
    (0.0, 100, 200.0),
    (0.0, 1000, 20.0),
    (0.5, 100, 200.0),
    (0.5, 1000, 20.0),
    (0.95, 1000, 40.0),
    (1.0, 1000, 200.0),
]

# Reads a line with a chain, a duration and a time step; answers with seconds a time unit and the
# error of the time step. The first round takes the chain to its steady state; the later ones go on.
SERVER = """
import json, sys, time
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
states = {}
for line in sys.stdin:
    restitution, size, duration, step = json.loads(line)
    chain = Chain(size=size, restitution=restitution)
    key = (restitution, size)
    common = {"time_step": step, "progress": False, "threads": 1, "observe": ["snapshots"]}
    if key not in states:
        run = simulate(chain, duration=duration, warmup=40.0, every=duration / 70, **common)
        states[key] = run.isel(time=-1)
    used = time.process_time()
    run = simulate(
        chain, start=states[key], warmup=0.0, duration=duration, every=duration / 70, **common
    )
    used = time.process_time() - used
    states[key] = run.isel(time=-1)
    error = run.attrs.get("time_step_error", 0.0)
    print(json.dumps([used / duration, error]), flush=True)
"""


class Version:
    """A process of one version that measures what it is asked."""

    def __init__(self, python: str) -> None:
        self.process = subprocess.Popen(
            [python, "-c", SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def measure(self, *asked: float | None) -> tuple[float, float]:
        """Return milliseconds a time unit, and the error of the time step in %."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        print(json.dumps(asked), file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit("a version ended; see above")
        seconds, error = json.loads(answer)
        return 1000 * seconds, 100 * error


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--time-step", type=float)
    parser.add_argument("--rounds", type=int, default=5)
    asked = parser.parse_args()
    versions = [Version(asked.old), Version(asked.new)]
    print("| e | L | old: ms a time unit (error of the step) | new | new/old |")
    print("|---|---|---|---|---|")
    for restitution, size, duration in CHAINS:
        case = (restitution, size, duration, asked.time_step)
        rounds = [[version.measure(*case) for version in versions] for _ in range(asked.rounds)]
        (old, old_error), (new, new_error) = (
            (median(time for time, _ in each), each[0][1]) for each in zip(*rounds[1:], strict=True)
        )
        print(
            f"| {restitution} | {size} | {old:.3g} ({old_error:.2f} %) "
            f"| {new:.3g} ({new_error:.2f} %) | {new / old:.3f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
