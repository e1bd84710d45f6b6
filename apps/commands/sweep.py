"""The command ``crazybilliards sweep``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crazybilliards.apps.commands.answers import note, say
from crazybilliards.apps.commands.options import KeepOld, Processes, Scheduler, path_option
from crazybilliards.apps.commands.output import INTERRUPTED, check_folder

if TYPE_CHECKING:
    from concurrent.futures import Executor
    from contextlib import AbstractContextManager

    from crazybilliards.comparison.sweeps import Case, Sweep
    from crazybilliards.comparison.sweeps.running import Outcome


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

    compute_cases(read_sweep(file), output, engine(processes, scheduler), keep_old)
    say(f"All of them as one Dataset: crazybilliards.load_sweep({str(output)!r})")


def engine(processes: int | None, scheduler: str | None) -> AbstractContextManager[Executor]:
    """Return what computes cases, as the options say."""
    from crazybilliards.comparison.sweeps import dask_cluster, process_pool

    if scheduler is None:
        return process_pool(processes)
    if processes is not None:
        raise ValueError("processes: a dask cluster decides that itself")
    return dask_cluster(None if scheduler == "local" else scheduler)


def compute_cases(
    cases: Sweep | list[Case],
    folder: Path,
    workers: AbstractContextManager[Executor],
    keep_old: bool,
) -> None:
    """Compute what is missing; end the command, and say why, unless all succeed."""
    from crazybilliards.comparison.sweeps.running import compute_missing

    if not len(cases):
        return

    def tell(outcome: Outcome) -> None:
        say(f"{outcome.number} cases, {outcome.found} of them in {folder} already")
        note(cases=outcome.number, folder=str(folder), computed=0, failed=[])

    outcome = compute_missing(cases, folder, workers, keep_old=keep_old, tell=tell)
    if outcome.found == outcome.number:
        return
    reason, status = "", 0
    if outcome.failed:
        case, first = next(iter(outcome.failed.items()))
        reason = f"{len(outcome.failed)} cases failed, the first, {case.canonical}, with {first}"
        status = 1
    if isinstance(outcome.stopped, RuntimeError):
        reason, status = str(outcome.stopped), 1
    elif outcome.stopped is not None:
        status = INTERRUPTED  # which says so itself
    say(f"computed {outcome.written} cases into {folder}")
    failed = [{**case.arguments, "reason": why} for case, why in outcome.failed.items()]
    note(computed=outcome.written, failed=failed)
    if reason:
        print(f"crazybilliards: {reason}", file=sys.stderr)
    if status:
        if outcome.found + outcome.written < outcome.number:
            print("The same command computes what is missing.", file=sys.stderr)
        raise typer.Exit(status)
