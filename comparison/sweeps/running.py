"""Carrying out cases: on this machine's processes or on a dask cluster, a file for each at once.

Workers send their results back as NetCDF bytes and the caller writes them, atomically, when they
arrive: a kill at any moment loses the cases in flight and nothing else, and the workers of a
cluster need no common file system.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path

from tqdm import tqdm

from crazybilliards.comparison.sweeps.case import Case, OutdatedError, compute
from crazybilliards.model.locks import locked
from crazybilliards.model.process import cores
from crazybilliards.model.storage import make_folder, write_sealed

_PATIENCE = "20s"  # for a scheduler to answer


def missing_cases(cases: Iterable[Case], folder: Path, *, keep_old: bool = False) -> list[Case]:
    """Return the cases, each once, that ``folder`` has no valid file of, the longest first.

    A file is valid if it is sound, holds the case, and was computed by the source code of today;
    with ``keep_old`` other source code may have computed it.
    """
    return _longest_first(_problems(cases, folder, keep_old))


def run_cases(
    cases: Iterable[Case],
    folder: Path,
    executor: Executor,
    *,
    keep_old: bool = False,
    progress: bool = True,
) -> dict[Case, str]:
    """Compute the cases that ``folder`` has no file of; return the reasons of those that failed.

    A file that is damaged, or that other source code of the package computed, is replaced when the
    new result is there. A line on standard error says so.

    Parameters
    ----------
    cases
        Cases; equal ones are computed once.
    folder
        Where the files lie, one a case, named by its key; made if missing.
    executor
        What runs them: :func:`process_pool` or :func:`dask_cluster`, or any other.
    keep_old
        Take results that other source code of the package computed as they are. Say so only if no
        number depends on what was edited since.
    progress
        Show a progress bar with the time left, if standard error is a terminal.

    Raises
    ------
    RuntimeError
        If workers die under their cases; what was finished is kept.
    OSError
        If the folder cannot be written to, or another process is filling it.
    """
    make_folder(folder)
    with locked(folder):
        problems = _problems(cases, folder, keep_old)
        _report(problems, folder)
        return _run_missing(_longest_first(problems), folder, executor, progress)


def _problems(cases: Iterable[Case], folder: Path, keep_old: bool) -> dict[Case, Exception]:
    """Return why the file of a case is not valid, for each case whose file is not."""
    problems: dict[Case, Exception] = {}
    for case in dict.fromkeys(cases):
        try:
            case.check_file(folder, keep_old=keep_old)
        except (FileNotFoundError, ValueError) as error:
            problems[case] = error
    return problems


def _longest_first(cases: Iterable[Case]) -> list[Case]:
    return sorted(cases, key=lambda case: -case.work)


def _report(problems: dict[Case, Exception], folder: Path) -> None:
    """Say on standard error which files are there but are replaced, and why."""
    outdated = 0
    for error in problems.values():
        if isinstance(error, OutdatedError):
            outdated += 1
        elif isinstance(error, ValueError):
            print(f"crazybilliards: {error}; computing it anew", file=sys.stderr)
    if outdated:
        print(
            f"crazybilliards: other source code of crazybilliards computed {outdated} cases in "
            f"{folder}; computing them anew (keep_old=True or --keep-old: take them as they are)",
            file=sys.stderr,
        )


def _run_missing(
    missing: list[Case], folder: Path, executor: Executor, progress: bool
) -> dict[Case, str]:
    """Compute cases and write each when it arrives; return the reasons of those that failed."""
    work = {case: case.work for case in missing}
    failed: dict[Case, str] = {}
    broken: BrokenProcessPool | None = None
    futures = {}
    for case in missing:
        with _ctrl_c_held_back():
            futures[executor.submit(compute, case, case.source)] = case
    with tqdm(
        total=sum(work.values()),
        desc=f"{len(missing)} cases",
        unit=" steps",
        unit_scale=True,
        disable=None if progress else True,
    ) as bar:
        for future in as_completed(futures):
            case = futures.pop(future)
            try:
                content = future.result()
            except BrokenProcessPool as error:
                broken = error  # others may have been finished before
            except Exception as error:  # whatever is wrong with one must not cost the others
                failed[case] = f"{type(error).__name__}: {error}"
            else:
                _write(case.file(folder), content)
            bar.update(work[case])
    if broken is not None:
        raise RuntimeError(
            "a worker process died (out of memory?); what was finished is kept, the same call "
            "computes the rest"
        ) from broken
    return failed


def _write(path: Path, content: bytes) -> None:
    try:
        write_sealed(path, content)
    except OSError as error:
        what = f"{error.strerror}; what was finished is kept, the same call computes the rest"
        raise OSError(error.errno, what, str(path)) from error


@contextmanager
def process_pool(processes: int | None = None) -> Iterator[Executor]:
    """Run cases in processes of this machine, one for each core unless told otherwise.

    Leaving by an exception, Ctrl-C say, kills them.
    """
    before = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        processes or cores(),
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_prepare_worker,
    )
    try:
        yield pool
    except BaseException:
        for process in set(multiprocessing.active_children()) - before:
            process.kill()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()


@contextmanager
def _ctrl_c_held_back() -> Iterator[None]:
    """Start workers that Ctrl-C does not reach, from their first moment on; here it comes later."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare_worker() -> None:
    """Leave Ctrl-C to the parent, and do not outlive it however it dies."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Its own lock is one for processes, of which a worker that is killed leaves something behind.
    tqdm.set_lock(threading.RLock())
    threading.Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def dask_cluster(address: str | None = None) -> Iterator[Executor]:
    """Run cases on the dask cluster whose scheduler is at ``address``; None: one of this machine.

    A case whose worker dies is given to another one.

    Raises
    ------
    ValueError
        If dask is not installed, or no scheduler answers there.
    """
    try:
        from distributed import Client, LocalCluster
        from distributed.comm import get_address_host_port
    except ImportError as error:
        raise ValueError(
            "dask is not installed: python -m pip install 'crazybilliards[sweep]'"
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
    with client:
        yield client.get_executor(pure=False)
