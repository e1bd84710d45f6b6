"""Processes of this machine that compute cases, each started and replaced by itself (loky)."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

from loky import ProcessPoolExecutor, cpu_count
from tqdm import tqdm

from crazybilliards.model.checks import check_integer
from crazybilliards.model.process import end_with_parent


@contextmanager
def process_pool(processes: int | None = None) -> Iterator[Executor]:
    """Run cases in processes of this machine, one for each core unless told otherwise.

    A process that dies is replaced, and what it computed is computed once more. It has failed if
    the next process dies of it, too. The end of the block kills the processes, whatever they do.

    Examples
    --------
    >>> with process_pool(2) as pool:  # doctest: +SKIP
    ...     failed = run_cases(Sweep({"restitution": [0.5, 1]}), "results", pool)
    """
    number = cpu_count() if processes is None else check_integer("processes", processes, least=1)
    pool = _Processes(number)
    try:
        yield pool
    finally:
        pool.kill()


class _Processes(ThreadPoolExecutor):
    """Threads with a process each, a pool of its own.

    A pool of several gives up the work of all of them when one dies, and does not tell which.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number, initializer=self._prepare_thread)
        self._own = threading.local()
        self._pools: list[ProcessPoolExecutor] = []
        self._killed = False

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Let one of the processes call the function."""
        return super().submit(self._call, function, args, kwargs)

    def _prepare_thread(self) -> None:
        self._own.pool = None
        # Processes that this thread starts never receive Ctrl-C, which the parent handles.
        if hasattr(signal, "pthread_sigmask"):
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})

    def _call(self, function: Callable[..., Any], args: Any, kwargs: Any) -> Any:
        for _ in range(2):
            if self._own.pool is None:
                self._own.pool = ProcessPoolExecutor(1, initializer=_prepare_process)
                self._pools.append(self._own.pool)
            if self._killed:
                raise RuntimeError("the processes were killed")
            try:
                return self._own.pool.submit(function, *args, **kwargs).result()
            except BrokenProcessPool:
                self._own.pool = None
        raise RuntimeError("its process died, and so did the next one (out of memory?)")

    def kill(self) -> None:
        """Kill the processes and give up what is submitted."""
        self._killed = True
        for pool in self._pools:
            pool.shutdown(wait=False, kill_workers=True)
        self.shutdown(cancel_futures=True)


def _prepare_process() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Windows blocks no signals
    # The default lock of tqdm works across processes, and a killed process would leave it behind.
    tqdm.set_lock(threading.RLock())
    end_with_parent()
