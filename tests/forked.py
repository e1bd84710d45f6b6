"""Programs as forks of this process, because imports would take most of their time."""

import multiprocessing
import os
import signal
import sys
import warnings
from contextlib import nullcontext
from tempfile import TemporaryFile
from typing import NamedTuple

from crazybilliards.apps.commands.line import main

PATIENCE = 200  # seconds until a program that hangs is ended


class Ended(NamedTuple):
    """How a program ended."""

    returncode: int
    stdout: str
    stderr: str


def forked(job, *, closed=(), stdout=None):
    """Do a job in a fork, which ends as a program does; ``closed``: numbers of its streams."""
    with (
        TemporaryFile("w+") if stdout is None else nullcontext(stdout) as output,
        TemporaryFile("w+") as errors,
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore", DeprecationWarning)  # threads: those of linear algebra
        child = os.fork()
        if child == 0:
            _become_a_program(output.fileno(), errors.fileno(), closed)
            _end_as_a_program(job)
        _, status = os.waitpid(child, 0)
        said = []
        for stream in (output, errors):
            readable = stream.seekable() and stream is not stdout
            said.append(stream.read() if readable and stream.seek(0) == 0 else "")
    return Ended(os.waitstatus_to_exitcode(status), *said)


def _become_a_program(output, errors, closed):
    # The semaphores of other start methods are removed by a clean-up that a fork does not reach.
    multiprocessing.set_start_method("fork", force=True)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(PATIENCE)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for number, descriptor in ((1, output), (2, errors)):
        os.dup2(descriptor, number)
    for number in closed:
        os.close(number)
    sys.stdin, sys.stdout, sys.stderr = (
        None if number in closed else os.fdopen(number, mode, buffering=1)
        for number, mode in enumerate("rww")
    )


def _end_as_a_program(job):
    status = 1
    try:
        job()
        status = 0
    except SystemExit as error:
        status = error.code or 0
    except BaseException as error:
        sys.excepthook(type(error), error, error.__traceback__)
        if isinstance(error, KeyboardInterrupt):
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            signal.raise_signal(signal.SIGINT)
    finally:
        os._exit(status)


def command(*arguments):
    """Return a job that is a command."""

    def job():
        sys.argv = ["crazybilliards", *map(str, arguments)]
        main()

    return job
