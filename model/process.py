"""The running process: its cores, its signals, and a message while kernels are compiled."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def announced(progress: bool) -> Iterator[None]:
    """Say that kernels are being compiled, if it takes long enough to wonder."""
    message = "crazybilliards: compiling the kernels, once (they are cached) ..."
    timer = Timer(0.7, lambda: print(message, file=sys.stderr, flush=True))
    if progress:
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


@contextmanager
def interrupts_held_back() -> Iterator[None]:
    """Let a Ctrl-C that comes meanwhile act afterwards; also a decorator."""
    in_main = threading.current_thread() is threading.main_thread()
    if not in_main or signal.getsignal(signal.SIGINT) is None:
        yield  # only the main thread receives signals; a handler of C cannot be put back
        return
    # Blocking the signal in this thread would not do: another thread would take it and pass it on.
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def terminated_like_interrupted() -> Iterator[None]:
    """Let SIGTERM, which batch systems send before they kill, act like Ctrl-C meanwhile."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread may change handlers, and only it receives signals
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
