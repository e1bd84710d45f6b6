"""The running process: signals that ask it to end, and the end of the process that started it."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

# The signals that ask a program to end. Windows has no SIGHUP.
_ENDING = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]
_BETWEEN_LOOKS = 0.5  # at the parent of a process [s]


def end_with_parent() -> None:
    """End this process when the one that started it ends, even if that one was killed."""
    import psutil  # here, because most commands start no process

    starter = multiprocessing.parent_process()
    parent = starter.pid if starter else os.getppid()  # of a process that subprocess started

    def follow() -> None:
        # A dead parent that nobody has waited for still counts as a process, but not as the parent.
        while os.getppid() == parent and psutil.pid_exists(os.getppid()):
            time.sleep(_BETWEEN_LOOKS)
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


class _Interrupt:
    """A handler that acts like Ctrl-C the first time, and then lets the results be written."""

    def __init__(self) -> None:
        self.signals: list[int] = []

    def __call__(self, number: int, _: object) -> None:
        self.signals.append(number)
        if len(self.signals) == 1:  # timeout and batch systems send their signals twice
            raise KeyboardInterrupt


@contextmanager
def terminated_like_interrupted() -> Iterator[list[int]]:
    """Make SIGTERM and SIGHUP act like Ctrl-C in this block; yield a list of those that came.

    They do so only where their action is the default: nohup, for example, ignores SIGHUP.
    """
    handler = _Interrupt()
    default = [n for n in _ENDING if signal.getsignal(n) is signal.SIG_DFL]
    for number in default:
        signal.signal(number, handler)
    try:
        yield handler.signals
    finally:
        for number in default:
            signal.signal(number, signal.SIG_DFL)


@contextmanager
def interrupts_noted() -> Iterator[list[int]]:
    """Add Ctrl-C, SIGTERM and SIGHUP to the list that it yields; the block goes on to its end.

    Neither raises an error in this block. An error that comes in the middle of the code of a lock
    leaves the lock held, and then a pool of threads waits for it without end.

    At the end of the block a signal whose action was the default takes its usual effect: SIGTERM,
    which batch systems send before they kill, and SIGHUP, of a lost connection, end the program.
    One that acts like Ctrl-C has no further effect: the caller looks at the list. A signal that the
    program ignores or handles itself stays as it is.
    """
    signals: list[int] = []
    before = {}
    if threading.current_thread() is threading.main_thread():  # only it may change handlers
        before = {number: signal.getsignal(number) for number in _ENDING}
    usual = (signal.SIG_DFL, signal.default_int_handler)
    noted = [
        n for n, handler in before.items() if handler in usual or isinstance(handler, _Interrupt)
    ]
    for number in noted:
        signal.signal(number, lambda number, _: signals.append(number))
    try:
        yield signals
    finally:
        for number in noted:
            signal.signal(number, before[number])
        for number in dict.fromkeys(signals):
            outer = before.get(number)
            if isinstance(outer, _Interrupt):
                outer.signals.append(number)
            elif outer is signal.SIG_DFL:
                signal.raise_signal(number)
