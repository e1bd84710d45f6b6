"""Shared by the tests of the commands: most run in this process, and some in a fork of it."""

import itertools
import os
import signal

import pytest
from forked import command, forked

from crazybilliards.particles.observers.widths import Widths
from crazybilliards.particles.simulation import compile_kernels


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


@pytest.fixture
def interrupted(monkeypatch):
    """Run a command in a fork, and let Ctrl-C, or another signal, come while it measures."""

    def interrupted(*arguments, number=signal.SIGINT):
        observe, calls = Widths.observe, itertools.count(1)  # which no two threads advance to 20

        def and_interrupt(self, *snapshots):
            observe(self, *snapshots)
            if next(calls) == 20:
                os.kill(os.getpid(), number)

        def job():
            if number != signal.SIGINT:
                signal.signal(number, signal.SIG_DFL)  # for example nohup ignores SIGHUP
            command(*arguments)()

        compile_kernels()  # or each fork would load them
        monkeypatch.setattr(Widths, "observe", and_interrupt)
        done = forked(job)
        # That kernels are being compiled is said if it takes long, on a busy machine say.
        said = done.stderr.splitlines(keepends=True)
        kept = "".join(line for line in said if "compiling the kernels" not in line)
        return done._replace(stderr=kept)

    return interrupted
