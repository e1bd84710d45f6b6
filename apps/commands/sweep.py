"""The command ``crazybilliards sweep``."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crazybilliards.apps.commands.answers import note, say
from crazybilliards.apps.commands.options import Dask, KeepOld, Processes, Scheduler, path_option
from crazybilliards.apps.commands.output import INTERRUPTED, check_folder

if TYPE_CHECKING:
    from concurrent.futures import Executor
    from contextlib import AbstractContextManager

    from crazybilliards.comparison.sweeps import Case


def command(
    file: Annotated[
        Path,
        typer.Argument(
            help="TOML file with the tables [grid], [chain] and [simulate] (or another job).",
            show_default=False,
        ),
    ],
    output: Annotated[
        Path,
        path_option(
            "Folder for the results, one file a case, and index.csv, which says which file holds "
            "which case; made if missing."
        ),
    ],
    processes: Processes = None,
    dask: Dask = False,
    scheduler: Scheduler = None,
    keep_old: KeepOld = False,
) -> None:
    """Compute every case of a grid of parameters, each into a file of its own.

    The table [grid] of the file holds lists of values of parameters of the chain or settings of
    the job. Every combination of them is a case. The tables [chain] and [simulate] (or
    the name of a theory, see crazybilliards theory --help) hold what is the same for all cases.

    The shortest cases come first. What the folder holds already is not computed again: after
    Ctrl-C, a crash, or with a larger grid, the same command computes what is missing. Results are
    computed anew if the source code that they depend on was changed since (unless --keep-old is
    given). In Python, crazybilliards.load_sweep(FOLDER) reads all of them as one Dataset.

    Example: crazybilliards sweep grid.toml --output results/grid
    """
    check_folder(output)
    from crazybilliards.comparison.sweeps import read_sweep

    compute_cases(read_sweep(file), output, engine(processes, dask, scheduler), keep_old)
    say(f"All of them as one Dataset: crazybilliards.load_sweep({str(output)!r})")


def engine(
    processes: int | None, dask: bool, scheduler: str | None
) -> AbstractContextManager[Executor]:
    """Return what computes cases, as the options say."""
    from crazybilliards.comparison.sweeps import dask_cluster, process_pool

    if dask or scheduler is not None:
        if processes is not None:
            raise ValueError("processes: a dask cluster decides that itself")
        return dask_cluster(scheduler)
    return process_pool(processes)


def compute_cases(
    cases: Iterable[Case], folder: Path, executor: AbstractContextManager[Executor], keep_old: bool
) -> None:
    """Compute what is missing; end the command, and say why, unless all succeed."""
    from crazybilliards.comparison.sweeps.index import write_index
    from crazybilliards.comparison.sweeps.missing import check_cases, find_missing
    from crazybilliards.comparison.sweeps.running import Outcome, compute_missing
    from crazybilliards.model.locks import locked
    from crazybilliards.model.storage import make_folder

    checked = check_cases(cases)
    if not len(checked):
        return
    make_folder(folder)
    with locked(folder):
        missing = find_missing(checked, folder, keep_old=keep_old)
        say(f"{len(checked)} cases, {len(checked) - len(missing)} of them in {folder} already")
        note(cases=len(checked), folder=str(folder), computed=0, failed=[])
        if not len(missing):
            write_index(folder)
            return
        outcome, reason, status = Outcome(), "", 0
        try:
            with executor as workers:
                compute_missing(missing, folder, workers, outcome)
        except KeyboardInterrupt:
            status = INTERRUPTED  # which says so itself
        except RuntimeError as error:
            reason, status = str(error), 1
    if outcome.failed:
        case, first = next(iter(outcome.failed.items()))
        reason = reason or (
            f"{len(outcome.failed)} cases failed, the first, {case.canonical}, with {first}"
        )
        status = status or 1
    say(f"computed {outcome.written} cases into {folder}")
    failed = [{**case.parameters, "reason": why} for case, why in outcome.failed.items()]
    note(computed=outcome.written, failed=failed)
    if reason:
        print(f"crazybilliards: {reason}", file=sys.stderr)
    if status:
        if outcome.written < len(missing):
            print("The same command computes what is missing.", file=sys.stderr)
        raise typer.Exit(status)
