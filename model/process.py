"""The running process: signals that ask it to end, and the end of the process that started it."""

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

# The signals that ask a program to end. Windows has no SIGHUP.
_ENDING: list[int] = [s for s in signal.Signals if s.name in ("SIGINT", "SIGTERM", "SIGHUP")]
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


class _Interrupt(list[int]):
    """Acts like Ctrl-C at the first signal, and then lets the results be written."""

    def __call__(self, number: int, _: object) -> None:
        self.append(number)
        if len(self) == 1:  # timeout and batch systems send their signals twice
            raise KeyboardInterrupt


@contextmanager
def _handled(numbers: list[int], handler: Callable[[int, Any], None]) -> Iterator[None]:
    """Handle some signals in this block."""
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, former in before.items():
            signal.signal(number, former)


@contextmanager
def terminated_like_interrupted() -> Iterator[list[int]]:
    """Make SIGTERM and SIGHUP act like Ctrl-C in this block; yield a list of those that came.

    They do so only where their action is the default: nohup, for example, ignores SIGHUP.
    """
    signals = _Interrupt()
    with _handled([n for n in _ENDING if signal.getsignal(n) is signal.SIG_DFL], signals):
        yield signals


@contextmanager
def interrupts_deferred() -> Iterator[None]:
    """Let Ctrl-C, SIGTERM and SIGHUP take effect after this block.

    A KeyboardInterrupt in a library in C can become another error, or leave a lock held.
    """
    came: list[int] = []
    main = threading.current_thread() is threading.main_thread()  # only it may change handlers
    numbers = [n for n in _ENDING if main and signal.getsignal(n) not in (signal.SIG_IGN, None)]
    try:
        with _handled(numbers, lambda number, _: came.append(number)):
            yield
    finally:
        for number in dict.fromkeys(came):
            signal.raise_signal(number)


@contextmanager
def interrupts_noted() -> Iterator[list[int]]:
    """Add Ctrl-C, SIGTERM and SIGHUP to the list that it yields; the block goes on to its end.

    None raises an error in this block. An error in the middle of the code of a lock leaves the lock
    held, and then a pool of threads waits for it without end.

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
    noted = [n for n, own in before.items() if own in usual or isinstance(own, _Interrupt)]
    try:
        with _handled(noted, lambda number, _: signals.append(number)):
            yield signals
    finally:
        for number in dict.fromkeys(signals):
            outer = before.get(number)
            if isinstance(outer, _Interrupt):
                outer.append(number)
            elif outer is signal.SIG_DFL:
                signal.raise_signal(number)
