"""Programs as forks of this process, because imports would take most of their time."""

import faulthandler
import multiprocessing
import os
import signal
import sys
import time
import warnings
from contextlib import suppress
from tempfile import TemporaryFile
from typing import NamedTuple

import psutil

from crazybilliards.apps.commands.line import main

PATIENCE = 200  # seconds until a program that hangs is ended, with the stacks of its threads
GONE = (psutil.STATUS_ZOMBIE, psutil.STATUS_DEAD)


class Ended(NamedTuple):
    """How a program ended."""

    returncode: int
    stdout: str
    stderr: str


def forked(job, *, closed=()):
    """Do a job in a fork, which ends as a program does; ``closed``: numbers of its streams."""
    with TemporaryFile("w+") as output, TemporaryFile("w+") as errors:
        status = end(begin(job, output, errors, closed))
        for stream in (output, errors):
            stream.seek(0)
        return Ended(status, output.read(), errors.read())


def begin(job, output, errors, closed=()):
    """Fork a process that does a job, in a process group of its own; return its number.

    The job may become another program by ``os.execv``.
    """
    # Ctrl-C may come at once, and waits for what catches it.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads: those of linear algebra
        child = os.fork()
    if child == 0:
        _end_as_a_program(job, output.fileno(), errors.fileno(), closed)
    with suppress(OSError):  # the child has done that, and gone on
        os.setpgid(child, child)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    return child


def end(child, number=None, group=False):
    """Send it a signal; wait until it and all its workers are gone; return its exit status."""
    if number is not None:
        (os.killpg if group else os.kill)(child, number)
    _, status = os.waitpid(child, 0)
    try:
        until(lambda: not members(child))
    finally:
        for left in members(child):
            left.kill()
    return os.waitstatus_to_exitcode(status)


def members(group):
    """Return the living processes of a process group."""
    found = []
    for process in psutil.process_iter():
        with suppress(ProcessLookupError, psutil.NoSuchProcess):  # it has just ended
            if os.getpgid(process.pid) == group and process.status() not in GONE:
                found.append(process)
    return found


def until(condition):
    """Wait for a condition to be true, for as long as a busy machine may take."""
    deadline = time.monotonic() + PATIENCE
    while not (found := condition()):
        assert time.monotonic() < deadline, "waited for too long"
        time.sleep(0.02)
    return found


def _become_a_program(output, errors, closed):
    # The semaphores of other start methods are removed by a clean-up that a fork does not reach.
    multiprocessing.set_start_method("fork", force=True)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(PATIENCE)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for number, descriptor in ((1, output), (2, errors)):
        os.dup2(descriptor, number)
    faulthandler.register(signal.SIGALRM, file=2, chain=True)
    for number in closed:
        os.close(number)
    sys.stdin, sys.stdout, sys.stderr = (
        None if number in closed else os.fdopen(number, mode, buffering=1)
        for number, mode in enumerate("rww")
    )


def _end_as_a_program(job, *streams):
    status = 1
    try:
        os.setpgid(0, 0)
        _become_a_program(*streams)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
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
