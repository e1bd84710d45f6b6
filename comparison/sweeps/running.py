"""Computation of the cases that a folder lacks; the file of each is written when it returns.

Workers send their results back as NetCDF bytes. The caller writes each result atomically when it
arrives. A kill at any moment therefore loses only the cases that are being computed, and the
workers of a cluster need no common file system.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from loky import ProcessPoolExecutor, cpu_count

from crazybilliards.comparison.sweeps.case import Case, compute, source_of
from crazybilliards.model.warn import warn_user
from crazybilliards.model.checks import check_integer, check_path
from crazybilliards.model.locks import locked
from crazybilliards.model.process import end_with_parent
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import make_folder, write_sealed
from crazybilliards.particles import ShortRunWarning


@contextmanager
def process_pool(processes: int | None = None) -> Iterator[Executor]:
    """Run cases in processes of this machine, one for each core unless told otherwise.

    An exception in the block, such as Ctrl-C, kills them.

    Examples
    --------
    >>> with process_pool(2) as pool:  # doctest: +SKIP
    ...     failed = run_cases(Sweep({"restitution": [0.5, 1]}), "results", pool)
    """
    number = cpu_count() if processes is None else check_integer("processes", processes, least=1)
    pool = ProcessPoolExecutor(number, initializer=_prepare_worker)
    try:
        yield pool
    except BaseException:
        pool.shutdown(kill_workers=True)
        raise
    pool.shutdown()


def _prepare_worker() -> None:
    """Ignore Ctrl-C, which the parent handles, and end when the parent ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_with_parent()


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
    new result is there.

    Parameters
    ----------
    cases
        A :class:`Sweep` or a list of cases; equal ones are computed once.
    folder
        Folder of the files, one per case; made if missing.
    executor
        Executor of the cases: :func:`process_pool`, ``dask.distributed.Client(...).get_executor()``
        or any other of ``concurrent.futures``. None: this process, in ``threads`` threads.
    keep_old
        Accept results that other source code of the package computed. Use it only if no number
        depends on the edits since.
    progress
        Show a progress bar with the time left, on a terminal or in a notebook.

    Raises
    ------
    ValueError
        For the first case that is wrong, before any work.
    RuntimeError
        If a worker dies. Finished cases are kept.
    OSError
        If the folder cannot be written to, or another process is filling it.
    """
    place, given = check_path("folder", folder), list(dict.fromkeys(cases))
    if short := [*filter(None, (case.too_short for case in given))]:
        warn_user(f"{len(short)} of {len(given)} cases; the first: {short[0]}", ShortRunWarning)
    make_folder(place)
    failed: dict[Case, str] = {}
    with locked(place):
        missing = [case for case in given if not case.is_in(place, keep_old=keep_old)]
        arriving = _computed(missing, executor, threads)
        for case, result in progress_bar(progress, arriving, total=len(missing), unit=" cases"):
            if isinstance(result, Exception):
                failed[case] = f"{type(result).__name__}: {result}"
            else:
                write_sealed(case.file(place), result)
    return failed


def _computed(
    cases: list[Case], executor: Executor | None, threads: int
) -> Iterator[tuple[Case, bytes | Exception]]:
    """Yield each case with its file as it is computed, or with the error instead."""
    if executor is None:
        for case in cases:
            try:
                yield case, compute(case, threads=threads)
            except ValueError as error:
                yield case, error
        return
    try:
        under_way = {executor.submit(compute, case, source_of(case)): case for case in cases}
        for future in as_completed(under_way):
            error = future.exception()
            if isinstance(error, BrokenProcessPool):
                raise error
            yield under_way[future], error if isinstance(error, Exception) else future.result()
    except BrokenProcessPool as error:
        raise RuntimeError(
            "a worker process died (out of memory?); finished cases are kept, and the same "
            "call computes the rest"
        ) from error
