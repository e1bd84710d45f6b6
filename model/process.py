"""The running process: its cores, its signals, and a message while kernels are compiled."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar

_to_announce: ContextVar[bool] = ContextVar("to_announce", default=False)


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


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


@contextmanager
def interrupts_held_back() -> Iterator[None]:
    """Delay Ctrl-C, and a SIGTERM that acts like it, to the end of the block or function."""
    # Blocking the signals in this thread is not enough: another thread would receive them.
    came: list[int] = []
    held = [
        number for number in (signal.SIGINT, signal.SIGTERM) if callable(signal.getsignal(number))
    ]
    try:
        with _handled(dict.fromkeys(held, lambda number, _: came.append(number))):
            yield
    finally:
        if came:
            signal.raise_signal(came[0])


@contextmanager
def interrupts_noted() -> Iterator[list[int]]:
    """Add Ctrl-C, and the SIGTERM that batch systems send before they kill, to the list it yields.

    Neither raises an error in this block. An error that comes in the middle of the code of a lock
    leaves the lock held, and then a pool of threads waits for it without end. However often they
    come, the block goes on to its end. A handler for Ctrl-C that a program has set itself stays.
    """
    came: list[int] = []
    handlers: dict[int, Callable[..., object]] = {}
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        handlers[signal.SIGINT] = lambda number, _: came.append(number)
    handlers[signal.SIGTERM] = lambda number, _: came.append(number)
    with _handled(handlers):
        yield came


@contextmanager
def terminated_like_interrupted() -> Iterator[None]:
    """Make SIGTERM, which batch systems send before they kill, act like Ctrl-C in this block."""
    with _handled({signal.SIGTERM: signal.default_int_handler}):
        yield


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
