"""Shared by the tests of the commands: most run in this process.

What only a process of its own can show (what it loads, how it takes a signal) is shown by a few
real ones.
"""

import signal
import subprocess
import sys
from typing import NamedTuple

import matplotlib.pyplot as plt
import pytest

from crazybilliards.comparison.commands.line import main


class Ended(NamedTuple):
    """How a command ended."""

    returncode: int
    stdout: str
    stderr: str


@pytest.fixture
def run(monkeypatch, capsys):
    """Run a command in this process."""

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["crazybilliards", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            main()
        return Ended(caught.value.code or 0, *capsys.readouterr())

    yield run
    plt.close("all")


@pytest.fixture
def refused(run):
    """Check that a command ends with one line that says why."""

    def refused(message, *arguments):
        done = run(*arguments)
        assert done.returncode == 2
        assert message in done.stderr
        assert done.stderr.count("\n") == 1
        assert done.stdout == ""

    return refused


# A command that says on standard error when its simulation has measured for a while.
MEASURING = """
import sys
from crazybilliards.comparison.commands.line import main
from crazybilliards.particles.observers.widths import Widths

observe, calls = Widths.observe, []

def and_say(self, *arguments):
    observe(self, *arguments)
    calls.append(1)
    if len(calls) == 20:
        print("measuring", file=sys.stderr, flush=True)

Widths.observe = and_say
main()
"""


@pytest.fixture
def interrupted():
    """Send Ctrl-C while a real command measures."""

    def interrupted(*arguments):
        with subprocess.Popen(
            [sys.executable, "-c", MEASURING, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        ) as process:
            try:
                said = []
                while not said or said[-1] not in ("measuring\n", ""):
                    said.append(process.stderr.readline())
                assert said[-1] == "measuring\n", "".join(said)
                process.send_signal(signal.SIGINT)
                output, errors = process.communicate(timeout=100)
            finally:
                process.kill()
        return Ended(process.returncode, output, errors)

    return interrupted
