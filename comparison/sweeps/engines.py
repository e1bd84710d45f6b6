"""Executors of cases: this process, processes of this machine, or a dask cluster."""

from __future__ import annotations

import logging
import multiprocessing
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from multiprocessing.synchronize import Event
from typing import Any

from tqdm import tqdm

from crazybilliards.model.calls import public
from crazybilliards.model.checks import check_integer
from crazybilliards.model.process import cores, end_with_parent

_UNGUARDED = (
    "no worker process could start: each of them imports the script, which must therefore start "
    "them under if __name__ == '__main__': only"
)
_PATIENCE = "20s"  # to wait for the answer of a scheduler


class ThisProcess(Executor):
    """Computes a case here when its result is asked for, a simulation in several threads."""

    def __init__(self, threads: int) -> None:
        self.threads = threads

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **how: Any) -> Future[Any]:
        """Return what calls the function."""
        return _Later(partial(function, *arguments, threads=self.threads, **how))


class _Later(Future[Any]):
    """Done from the start, so that it can be asked: Ctrl-C then stops the computation itself."""

    def __init__(self, call: Callable[[], Any]) -> None:
        super().__init__()
        self.call = call
        self.set_result(None)

    def result(self, timeout: float | None = None) -> Any:
        return self.call()


@public
def process_pool(processes: int | None = None) -> AbstractContextManager[Executor]:
    """Run cases in processes of this machine, one for each core unless told otherwise.

    An exception in the block, such as Ctrl-C, kills them.

    Examples
    --------
    A script that starts processes must do so under ``if __name__ == "__main__":``.

    >>> with process_pool(2) as pool:  # doctest: +SKIP
    ...     failed = run_cases(Sweep({"restitution": [0.5, 1]}), "results", pool)
    """
    return _pool(cores() if processes is None else check_integer("processes", processes, least=1))


@contextmanager
def _pool(processes: int) -> Iterator[Executor]:
    before = set(multiprocessing.active_children())
    context = multiprocessing.get_context("spawn")
    started = context.Event()  # whether a worker did
    pool = ProcessPoolExecutor(processes, context, initializer=_prepare_worker, initargs=(started,))
    try:
        yield pool
    except BaseException as error:
        for process in set(multiprocessing.active_children()) - before:
            process.kill()
        pool.shutdown(wait=False, cancel_futures=True)
        if isinstance(error.__cause__, BrokenProcessPool) and not started.is_set():
            raise RuntimeError(_UNGUARDED) from error.__cause__
        raise
    pool.shutdown()


def _prepare_worker(started: Event) -> None:
    """Ignore Ctrl-C, which the parent handles, and end when the parent ends."""
    started.set()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The default lock of tqdm works across processes, and a killed worker would leave it behind.
    tqdm.set_lock(threading.RLock())
    end_with_parent()


@contextmanager
def dask_cluster(address: str | None = None) -> Iterator[Executor]:
    """Run cases on the dask cluster whose scheduler is at ``address``; None: one of this machine.

    If a worker dies, another one gets its case. A ValueError says that dask is not installed, or
    that no scheduler answers there.
    """
    try:
        from distributed import Client, LocalCluster
        from distributed.comm import get_address_host_port
    except ImportError as error:
        raise ValueError(
            f"dask is not installed: {sys.executable} -m pip install 'crazybilliards[sweep]'"
        ) from error
    if address is None:
        with (
            LocalCluster(threads_per_worker=1, dashboard_address=None) as cluster,
            Client(cluster, set_as_default=False) as client,
        ):
            yield client.get_executor(pure=False)
        return
    try:
        get_address_host_port(address, strict=True)
        client = Client(address, set_as_default=False, timeout=_PATIENCE)
    except (OSError, ValueError) as error:
        raise ValueError(f"no dask scheduler answers at {address}: {error}") from error
    log = logging.getLogger("distributed.client")
    before = log.level
    # Every case reports the loss of the scheduler. The log would only add two tracebacks.
    log.setLevel(logging.CRITICAL)
    try:
        with client:
            yield client.get_executor(pure=False)
    finally:
        log.setLevel(before)
