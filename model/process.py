"""The running process: its cores, its signals, and a message while kernels are compiled."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
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
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread receives signals
        return
    # Blocking the signals in this thread is not enough: another thread would receive them.
    came: list[int] = []
    before = {
        number: handler
        for number in (signal.SIGINT, signal.SIGTERM)
        if callable(handler := signal.getsignal(number))  # one set in C cannot be restored
    }
    try:
        for number in before:
            signal.signal(number, lambda number, _: came.append(number))
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            signal.raise_signal(came[0])


@contextmanager
def terminated_like_interrupted() -> Iterator[None]:
    """Make SIGTERM, which batch systems send before they kill, act like Ctrl-C in this block."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may change handlers, and only it receives signals
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
