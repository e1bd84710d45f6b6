"""What computes cases: this process, processes of this machine, or a dask cluster."""

from __future__ import annotations

import logging
import multiprocessing
import signal
import sys
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager
from multiprocessing.synchronize import Event
from queue import SimpleQueue

from tqdm import tqdm

from crazybilliards.comparison.sweeps.case import Case, compute
from crazybilliards.model.calls import public
from crazybilliards.model.checks import check_integer
from crazybilliards.model.process import cores, end_with_parent, interrupts_held_back

_UNGUARDED = (
    "no worker process could start: each of them imports the script, which must therefore start "
    "them under if __name__ == '__main__': only"
)
_PATIENCE = "20s"  # to wait for the answer of a scheduler
_BETWEEN_LOOKS = 1.0  # at the workers [s]
# Cases that are submitted and have not returned: enough for a cluster, few in memory.
_MOST_UNDER_WAY = 1000


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
    context = multiprocessing.get_context("spawn")
    started = context.Event()  # whether a worker did
    pool = ProcessPoolExecutor(processes, context, initializer=_prepare_worker, initargs=(started,))
    over = threading.Event()
    watch = threading.Thread(target=_watch, args=(pool, over), daemon=True)
    watch.start()
    try:
        yield pool
    except BaseException as error:
        over.set()
        watch.join()  # two threads must not close the same pipe
        _kill_workers(pool)
        pool.shutdown(wait=False, cancel_futures=True)
        if isinstance(error.__cause__, BrokenProcessPool) and not started.is_set():
            raise RuntimeError(_UNGUARDED) from error.__cause__
        raise
    finally:
        over.set()
    pool.shutdown()


def _watch(pool: ProcessPoolExecutor, over: threading.Event) -> None:
    """Kill the workers when one of them has died, until ``over`` is set.

    The pool does that, too, unless it waits for a result that the dead one has half sent.
    """
    while not over.wait(_BETWEEN_LOOKS):
        if any(process.exitcode for process in [*(pool._processes or {}).values()]):
            _kill_workers(pool)
            return


def _kill_workers(pool: ProcessPoolExecutor) -> None:
    """Kill all workers, such that the pool takes notice whatever they were doing.

    A worker may die while it sends a result. A thread of the pool then waits for the rest, and
    Python waits for that thread when it ends. The thread meets the end of the pipe only when
    nobody can write any more, neither a worker nor this process, which never does. The standard
    library has no public way to say so.
    """
    for process in [*(pool._processes or {}).values()]:
        process.kill()
    if pool._result_queue is not None:
        pool._result_queue._writer.close()  # type: ignore[attr-defined]


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


def computed_here(cases: Iterable[Case], threads: int) -> Iterator[tuple[Case, bytes | Exception]]:
    """Compute cases in this process; yield each with its file, or with the error instead."""
    for case in cases:
        result: bytes | Exception
        try:
            result = compute(case, case.source, threads)
        except Exception as error:
            result = error
        yield case, result


def computed_by(
    executor: Executor, cases: Iterator[Case]
) -> Iterator[tuple[Case, bytes | Exception]]:
    """Submit cases; yield each, as it comes back, with its file, or with the error instead."""
    under_way: dict[Future[bytes], Case] = {}
    back: SimpleQueue[Future[bytes]] = SimpleQueue()
    lost: Exception | None = None  # why the executor cannot be used any more
    case = next(cases, None)
    while case or under_way:
        if case and len(under_way) < _MOST_UNDER_WAY and back.empty():
            try:
                with interrupts_held_back(), _ctrl_c_blocked():
                    future = executor.submit(compute, case, case.source)
                    under_way[future] = case
                    future.add_done_callback(back.put)
                case = next(cases, None)
            except BrokenProcessPool as error:
                lost, case = error, None
            continue
        future = back.get()
        returned, result = under_way.pop(future), _result(future)
        if isinstance(result, BrokenProcessPool | CancelledError):
            lost, case = result, None  # other cases may have finished before
        else:
            yield returned, result
    if lost is not None:
        cancelled = isinstance(lost, CancelledError)
        gone = "the dask scheduler is gone" if cancelled else "a worker process died"
        hint = "" if cancelled else " (out of memory?)"
        raise RuntimeError(
            f"{gone}{hint}; finished cases are kept, and the same call computes the rest"
        ) from lost


def _result(future: Future[bytes]) -> bytes | Exception:
    try:
        return future.result()
    except Exception as error:
        return error


@contextmanager
def _ctrl_c_blocked() -> Iterator[None]:
    """Start workers that never receive Ctrl-C: they inherit what this thread blocks."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
