"""Computation of the cases that a folder lacks; the file of each is written when it returns.

Workers send their results back as NetCDF bytes, and the caller writes each atomically. A kill
loses only the cases that are being computed, and a cluster needs no common file system.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import closing
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from tqdm import tqdm

from crazybilliards.comparison.sweeps.case import Case, compute
from crazybilliards.comparison.sweeps.grid import Sweep
from crazybilliards.model.checks import check_path
from crazybilliards.model.locks import locked
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import make_folder, write_sealed
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
