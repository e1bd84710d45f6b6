"""Computation of cases: each is sent to an executor, and its file is written when it returns.

Workers send their results back as NetCDF bytes. The caller writes each result atomically when it
arrives. A kill at any moment therefore loses only the cases that are being computed, and the
workers of a cluster need no common file system.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import textwrap
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from tqdm import tqdm

from crazybilliards.comparison.sweeps.case import Case, compute
from crazybilliards.comparison.sweeps.index import write_index
from crazybilliards.comparison.sweeps.missing import Cases, check_cases, find_missing
from crazybilliards.model.calls import public
from crazybilliards.model.checks import check_path, shown
from crazybilliards.model.locks import locked
from crazybilliards.model.process import interrupts_held_back
from crazybilliards.model.progress import progress_bar
from crazybilliards.model.storage import make_folder, write_sealed

# Cases that are submitted and have not returned: enough for a cluster, few in memory.
_MOST_UNDER_WAY = 1000
_BESIDE = len("100%|          | 1:00:00<1:00:00, last ")  # what stands beside a case's title
_LEAST_WAIT, _SHARE = 5.0, 50  # seconds between two writings of the index, and times their length
_WITH = "with process_pool() as executor: run_cases(cases, folder, executor)"
_LEAST_ROOM = 10  # letters for the name of a case; a narrower terminal does not show it


@dataclass
class Outcome:
    """The outcome of the cases so far."""

    written: int = 0  # cases that were computed and written
    failed: dict[Case, str] = field(default_factory=dict)  # and the reasons


@public
def run_cases(
    cases: Iterable[Case],
    folder: str | os.PathLike[str],
    executor: Executor,
    *,
    keep_old: bool = False,
    progress: bool = True,
) -> dict[Case, str]:
    """Compute the cases that have no file in ``folder``; return the reasons of failures.

    A file that is damaged, or that other source code of the package computed, is replaced when the
    new result is there. A line on standard error says so.

    Parameters
    ----------
    cases
        Cases; equal ones are computed once. Few cases of a :class:`Sweep` are in memory at a time.
    folder
        Folder of the files, one per case and named by its key; made if missing. Its ``index.csv``
        says which file holds which case.
    executor
        Executor of the cases: :func:`process_pool`, :func:`dask_cluster`, or any other.
    keep_old
        Accept results that other source code of the package computed. Use it only if no number
        depends on the edits since.
    progress
        Show progress bars, the last one with the time left, on a terminal or in a notebook.

    Raises
    ------
    ValueError
        For the first case of a :class:`Sweep` that is wrong, before any work.
    RuntimeError
        If a worker of ``process_pool`` or the scheduler of a dask cluster dies. Finished cases
        are kept.
    OSError
        If the folder cannot be written to, or another process is filling it.
    """
    place = check_path("folder", folder)
    if not isinstance(executor, Executor):
        raise ValueError(f"executor must be one, as in {_WITH}; got {shown(executor)}")
    checked = check_cases(cases, progress=progress)
    make_folder(place)
    with locked(place):
        missing = find_missing(checked, place, keep_old=keep_old, progress=progress)
        outcome = Outcome()
        compute_missing(missing, place, executor, outcome, progress=progress)
    return outcome.failed


def compute_missing(
    missing: Cases, folder: Path, executor: Executor, outcome: Outcome, *, progress: bool = True
) -> None:
    """Compute cases and write each when it arrives; errors are those of :func:`run_cases`.

    ``outcome`` records what happened to each case, also if this raises.
    """
    for what in missing.replaced:
        print(f"crazybilliards: {what}", file=sys.stderr)
    with (
        _index_at_end(folder),
        progress_bar(
            progress,
            total=float(missing.work.sum()),
            desc=f"0 of {len(missing)} cases",
            bar_format="{l_bar}{bar:10}| {elapsed}<{remaining}{postfix}",
        ) as bar,
    ):
        under_way = _UnderWay(executor, folder, len(missing), outcome, bar)
        for case in missing:
            try:
                under_way.submit(case)
            except BrokenProcessPool as error:
                under_way.lost = error
                break
            while under_way.arrived or len(under_way) >= _MOST_UNDER_WAY:
                under_way.take_one()
            if under_way.lost is not None:
                break
        while len(under_way):
            under_way.take_one()
    if under_way.lost is not None:
        what = (
            "the dask scheduler is gone"
            if isinstance(under_way.lost, CancelledError)
            else "a worker process died (out of memory?)"
        )
        raise RuntimeError(
            f"{what}; finished cases are kept, and the same call computes the rest"
        ) from under_way.lost


@contextmanager
def _index_at_end(folder: Path) -> Iterator[None]:
    """Write the index of the cases also if the computation is interrupted."""
    try:
        yield
    finally:
        with suppress(OSError):  # a full disk is told of by what came before
            write_index(folder)


class _UnderWay:
    """Submitted cases that have not returned; each is written when it is taken back."""

    def __init__(
        self, executor: Executor, folder: Path, number: int, outcome: Outcome, bar: tqdm[Any]
    ) -> None:
        self.executor, self.outcome, self.bar = executor, outcome, bar
        self.folder, self.number = folder, number
        self.cases: dict[Future[bytes], Case] = {}
        self.back: SimpleQueue[Future[bytes]] = SimpleQueue()
        self.next_index = 0.0  # when the index is written again
        self.lost: Exception | None = None  # why the executor cannot be used any more

    def __len__(self) -> int:
        return len(self.cases)

    @property
    def arrived(self) -> bool:
        """Return whether a case can be taken back without waiting."""
        return not self.back.empty()

    def submit(self, case: Case) -> None:
        with interrupts_held_back(), _ctrl_c_blocked():
            future = self.executor.submit(compute, case, case.source)
            self.cases[future] = case
            future.add_done_callback(self.back.put)

    def take_one(self) -> None:
        """Wait for the next case and write it, or record why it has no result."""
        future = self.back.get()
        case = self.cases.pop(future)
        try:
            content = future.result()
        except (BrokenProcessPool, CancelledError) as error:
            self.lost = error  # other cases may have finished before
        except Exception as error:  # an error in one case must not stop the others
            self.outcome.failed[case] = f"{type(error).__name__}: {error}"
        else:
            _write(case.file(self.folder), content)
            self.outcome.written += 1
            self._keep_index()
        done = self.outcome.written + len(self.outcome.failed)
        self.bar.set_description(f"{done} of {self.number} cases", refresh=False)
        room = shutil.get_terminal_size().columns - len(self.bar.desc) - _BESIDE
        if room >= _LEAST_ROOM:
            last = textwrap.shorten(case.title, room, placeholder=" ...")
            self.bar.set_postfix_str(f"last {last}", refresh=False)
        self.bar.update(case.work)

    def _keep_index(self) -> None:
        """Write the index now and then: it reads all files, which may be many."""
        begin = time.monotonic()
        if begin >= self.next_index:
            with suppress(OSError):
                write_index(self.folder)
            end = time.monotonic()
            self.next_index = end + _LEAST_WAIT + _SHARE * (end - begin)


def _write(path: Path, content: bytes) -> None:
    try:
        write_sealed(path, content)
    except OSError as error:
        what = f"{error.strerror}; finished cases are kept, and the same call computes the rest"
        raise OSError(error.errno, what, str(path)) from error


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
