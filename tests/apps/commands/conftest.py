"""Shared by the tests of the commands: most run in this process.

What only a process of its own can show (what it loads, how it takes a signal) is shown by a few
real ones.
"""

import signal
import subprocess
import sys

import pytest


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


# A command that gets a signal when its simulation has measured for a while.
MEASURING = """
import itertools, os, signal, sys
from crazybilliards.apps.commands.line import main
from crazybilliards.particles.observers.widths import Widths

observe, calls = Widths.observe, itertools.count(1)  # which two threads cannot both advance to 20

def and_interrupt(self, *arguments):
    observe(self, *arguments)
    if next(calls) == 20:
        os.kill(os.getpid(), number)

number = int(sys.argv.pop(1))
if number != signal.SIGINT:
    signal.signal(number, signal.SIG_DFL)  # for example nohup ignores SIGHUP
Widths.observe = and_interrupt
main()
"""


@pytest.fixture
def interrupted():
    """Run a real command and let Ctrl-C, or another signal, come while it measures."""

    def interrupted(*arguments, number=signal.SIGINT):
        done = subprocess.run(
            [sys.executable, "-c", MEASURING, str(int(number)), *map(str, arguments)],
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        # That kernels are being compiled is said if it takes long, on a busy machine say.
        said = done.stderr.splitlines(keepends=True)
        done.stderr = "".join(line for line in said if "compiling the kernels" not in line)
        return done

    return interrupted
