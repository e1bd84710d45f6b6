"""Computation of the cases that a folder lacks; the file of each is written when it returns.

It is in this process, on a cluster, or in processes of this machine, each started and replaced by
itself (loky).

Workers send their results back as NetCDF bytes, and the caller writes each atomically. A kill
loses only the cases that are being computed, and a cluster needs no common file system.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from loky import ProcessPoolExecutor, cpu_count
from tqdm import tqdm

from crazybilliards.comparison.sweeps.case import Case, compute
from crazybilliards.comparison.sweeps.grid import Sweep
from crazybilliards.model.checks import check_integer, check_path, shown
from crazybilliards.model.process import end_with_parent
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import locked, make_folder, write_sealed
from crazybilliards.model.warn import warn_user
from crazybilliards.particles import ShortRunWarning

# Cases that are submitted and have not returned: enough for a cluster, few in memory.
_MOST_UNDER_WAY = 1000


def run_cases(
    cases: Iterable[Case],
    folder: str | os.PathLike[str],
    executor: Executor | None = None,
    *,
    threads: int = 1,
    keep_old: bool = False,
    progress: bool = True,
) -> dict[Case, str]:
    """Compute the cases that have no file in ``folder``; return the reasons of failures.

    A file that is damaged, or that other source code of the package computed, is replaced when the
    new result is there. An error in one case does not stop the others.

    Parameters
    ----------
    cases
        A :class:`Sweep`, of which few cases are in memory at a time, or a list of cases; equal
        ones are computed once.
    folder
        Folder of the files, one per case; made if missing.
    executor
        Executor of the cases: :func:`process_pool`, ``distributed.Client(...).get_executor()``
        of a dask cluster, or any other of ``concurrent.futures``. None: this process.
    threads
        Threads of each simulation in this process; no number depends on them.
    keep_old
        Accept results of other source code of the package: use it if no number depends on the
        edits since.
    progress
        Show a progress bar with the time left, on a terminal, elsewhere a line every half minute.

    Raises
    ------
    ValueError
        For the first case that is wrong, before any work.
    RuntimeError
        If a worker, other than of :func:`process_pool`, or the scheduler died. What was finished
        is kept.
    OSError
        If the folder cannot be written to, or another process is filling it.
    """
    place = check_path("folder", folder)
    if not isinstance(cases, Sweep):
        cases = list(dict.fromkeys(cases))
        if wrong := [case for case in cases if not isinstance(case, Case)]:
            raise TypeError(f"cases are a Sweep or a list of cases, and hold {shown(wrong[0])}")
    short = filter(None, (case.too_short for case in cases))
    if first := next(short, ""):
        number = 1 + sum(1 for _ in short)  # which checks the others
        warn_user(f"{number} of {len(cases)} cases; the first: {first}", ShortRunWarning)
    make_folder(place)
    failed: dict[Case, str] = {}
    with locked(place), progress_bar(progress, total=len(cases), unit="case") as bar:
        missing = _missing(cases, place, keep_old, bar)
        here = ((case, _result(compute, case, case.source, threads)) for case in missing)
        computed = _computed_by(executor, missing) if executor else here
        with closing(computed):
            for case, result in computed:
                if isinstance(result, bytes):
                    write_sealed(case.file(place), result)
                else:
                    failed[case] = f"{type(result).__name__}: {result}"
                    bar.set_postfix(failed=len(failed), refresh=False)
                bar.update()
    return failed


def _missing(cases: Iterable[Case], folder: Path, keep_old: bool, bar: tqdm[Any]) -> Iterator[Case]:
    """Yield the cases that have no valid file, and warn of the first one that is replaced."""
    warned = False
    for case in cases:
        if case.is_in(folder, keep_old=keep_old):
            bar.update()
            continue
        if not warned and case.file(folder).exists():
            warned = True
            warn_user(
                f"{case.file(folder)}: damaged or of other source code; computing it anew, and "
                "others like it (keep_old=True, --keep-old: keep those of other source code)"
            )
        yield case


def _computed_by(
    executor: Executor, cases: Iterator[Case]
) -> Generator[tuple[Case, bytes | Exception]]:
    """Submit cases; yield each, as it returns, with its file, or with the error instead."""
    under_way: dict[Future[bytes], Case] = {}
    returned: SimpleQueue[Future[bytes]] = SimpleQueue()
    lost: Exception | None = None  # why the executor cannot be used any more
    case = next(cases, None)
    try:
        while case or under_way:
            if case and len(under_way) < _MOST_UNDER_WAY and returned.empty():
                try:
                    future = executor.submit(compute, case, case.source)
                except BrokenExecutor as error:
                    case, lost = None, error
                    continue
                under_way[future] = case
                future.add_done_callback(returned.put)
                case = next(cases, None)
                continue
            future = returned.get()
            result = _result(future.result)
            if isinstance(result, BrokenExecutor | CancelledError):
                case, lost = None, result  # others may have returned before
            else:
                yield under_way[future], result
            del under_way[future]
    finally:
        for future in under_way:
            future.cancel()
    if lost:
        raise RuntimeError(
            "a worker or the scheduler died; finished cases are kept, and the same call computes "
            "the rest"
        ) from lost


def _result(function: Callable[..., bytes], *arguments: Any) -> bytes | Exception:
    try:
        return function(*arguments)
    except Exception as error:
        return error


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
