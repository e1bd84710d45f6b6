"""What a run costs in one version of the package, against another one.

    python benchmarks/versions.py OLD_PYTHON NEW_PYTHON [--time-step 1e-3] [--rounds 5]

OLD_PYTHON and NEW_PYTHON are interpreters of environments in which the two versions are installed.
Both measure the widths of the same chains, in turns, for the same time, each with its own default
time step unless ``--time-step`` is given. Printed is a table of the computing time of one unit of
time [T] (median) in each version, the error of the smallest W_v that it expects of its time step,
and how many times faster the new version is. Only arguments of ``simulate`` that all versions have
are used.
"""

import argparse
import json
import subprocess
import sys
from statistics import median

CHAINS = [  # restitution, size, gap, time units of a round
    *((1.0, 10**n, 0.0, time) for n, time in enumerate([1e6, 1e6, 1e5, 1e4, 200.0])),
    *((e, 10**n, 0.0, time) for e in (0.95, 0.5) for n, time in enumerate([1e5, 5e4, 3e3, 20.0])),
    *((0.0, 10**n, 0.0, time) for n, time in enumerate([1e5, 5e4, 3e3, 20.0, 0.5])),
    *((e, 100, gap, 3e3) for e in (1.0, 0.95, 0.5) for gap in (0.3, 1.0)),
]

# Reads a line with a chain, a duration and a time step; answers with seconds a time unit and the
# error of the time step. The first round takes the chain to its steady state; the later ones go on.
SERVER = """
import json, sys, time
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
states = {}
for line in sys.stdin:
    restitution, size, gap, duration, step = json.loads(line)
    chain = Chain(size=size, restitution=restitution, gap=gap)
    key = (restitution, size, gap)
    common = {"time_step": step, "progress": False, "threads": 1, "warmup": 0.0}
    if key not in states:
        state = {"observe": ["snapshots"], "duration": 7.0, "every": 0.1}
        states[key] = simulate(chain, **state, **common).isel(time=-1)
    often = {"every": duration / 70} if duration < 70 else {}
    common |= {"start": states[key], "observe": ["widths"], **often}
    used = time.process_time()
    run = simulate(chain, duration=duration, **common)
    used = time.process_time() - used
    print(json.dumps([used / duration, run.attrs.get("time_step_error", 0.0)]), flush=True)
"""


class Version:
    """A process of one version that measures what it is asked."""

    def __init__(self, python: str) -> None:
        self.process = subprocess.Popen(
            [python, "-W", "ignore", "-c", SERVER],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
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
    print("e,L,g,old: ms a time unit,error of its step,new,error of its step,old/new")
    for restitution, size, gap, duration in CHAINS:
        case = (restitution, size, gap, duration, asked.time_step)
        rounds = [[version.measure(*case) for version in versions] for _ in range(asked.rounds)]
        (old, old_error), (new, new_error) = (
            (median(time for time, _ in each), each[0][1]) for each in zip(*rounds[1:], strict=True)
        )
        print(
            f"{restitution:g},{size},{gap:g},{old:.3g},{old_error:.2f} %,{new:.3g},"
            f"{new_error:.2f} %,{old / new:.3g}",
            flush=True,
        )


if __name__ == "__main__":
    main()
