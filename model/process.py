"""The running process: its signals, and the announcement that it compiles."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar

# The signals that ask a program to end. Windows has no SIGHUP.
_ENDING = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]
_BETWEEN_LOOKS = 0.5  # at the parent of a process [s]
_to_announce: ContextVar[bool] = ContextVar("to_announce", default=False)


def end_with_parent() -> None:
    """End this process when the one that started it ends, even if that one was killed."""
    import psutil  # here, because most commands start no process

    parent = multiprocessing.parent_process()
    assert parent is not None

    def follow() -> None:
        # A dead parent that nobody has waited for still counts as a process, but not as the parent.
        while os.getppid() == parent.pid and psutil.pid_exists(os.getppid()):
            time.sleep(_BETWEEN_LOOKS)
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


@contextmanager
def announced(progress: bool) -> Iterator[None]:
    """Print that kernels are being compiled, if a kernel is not in numba's cache."""
    before = _to_announce.set(progress)
    try:
        yield
    finally:
        _to_announce.reset(before)


def announce_compilation() -> None:
    """Print once that kernels are being compiled, inside ``announced``."""
    if _to_announce.get():
        _to_announce.set(False)
        message = "crazybilliards: compiling the kernels, once (they are cached) ..."
        print(message, file=sys.stderr, flush=True)


class _Note:
    """A handler that adds its signals to a list."""

    def __init__(self, came: list[int]) -> None:
        self.came = came

    def __call__(self, number: int, _: object) -> None:
        self.came.append(number)


class _Interrupt(_Note):
    """A handler that acts like Ctrl-C the first time, and then lets the results be written."""

    def __call__(self, number: int, _: object) -> None:
        self.came.append(number)
        if len(self.came) == 1:  # timeout and batch systems send their signals twice
            raise KeyboardInterrupt


@contextmanager
def interrupts_held_back() -> Iterator[None]:
    """Delay Ctrl-C, and signals that act like it, to the end of the block or function."""
    # Blocking the signals in this thread is not enough: another thread would receive them.
    came: list[int] = []
    held = [number for number in _ENDING if callable(signal.getsignal(number))]
    try:
        with _handled(dict.fromkeys(held, _Note(came))):
            yield
    finally:
        if came:
            signal.raise_signal(came[0])


@contextmanager
def interrupts_noted() -> Iterator[list[int]]:
    """Add Ctrl-C, SIGTERM and SIGHUP to the list that it yields; the block goes on to its end.

    Neither raises an error in this block. An error that comes in the middle of the code of a lock
    leaves the lock held, and then a pool of threads waits for it without end.

    At the end of the block a signal whose action was the default takes its usual effect: SIGTERM,
    which batch systems send before they kill, and SIGHUP, of a lost connection, end the program.
    One that acts like Ctrl-C has no further effect: the caller looks at the list. A signal that the
    program ignores or handles itself stays as it is.

    Raises
    ------
    KeyboardInterrupt
        If a signal came and the block then raises an error, which would hide the signal.
    """
    came: list[int] = []
    usual = (signal.SIG_DFL, signal.default_int_handler)
    before = {number: signal.getsignal(number) for number in _ENDING}
    noted = [n for n, each in before.items() if each in usual or isinstance(each, _Note)]
    try:
        with _handled(dict.fromkeys(noted, _Note(came))):
            yield came
    except Exception as error:
        if came:
            raise KeyboardInterrupt from error
        raise
    finally:
        for number in dict.fromkeys(came):
            outer = before[number]
            if isinstance(outer, _Note):
                outer.came.append(number)
            elif outer is signal.SIG_DFL:
                signal.raise_signal(number)


@contextmanager
def terminated_like_interrupted() -> Iterator[list[int]]:
    """Make SIGTERM and SIGHUP act like Ctrl-C in this block; yield a list of those that came.

    They do so only where their action is the default: nohup, for example, ignores SIGHUP.
    """
    came: list[int] = []
    default = [
        number
        for number in _ENDING
        if number != signal.SIGINT and signal.getsignal(number) is signal.SIG_DFL
    ]
    with _handled(dict.fromkeys(default, _Interrupt(came))):
        yield came


@contextmanager
def _handled(handlers: Mapping[int, Callable[..., object]]) -> Iterator[None]:
    """Set handlers of signals in this block, in the order given."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may change handlers, and only it receives signals
        return
    with ExitStack() as restoring:
        for number, handler in handlers.items():
            before = signal.getsignal(number)
            if before is not None:  # one set in C cannot be restored
                restoring.callback(signal.signal, number, before)
                signal.signal(number, handler)
        yield
