"""The command ``crazybilliards reproduce``.

Only the standard library and typer are imported up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crazybilliards.comparison.commands.output import check_folder
from crazybilliards.comparison.commands.sweep import (
    Dask,
    Processes,
    Scheduler,
    compute_missing,
    engine,
)

if TYPE_CHECKING:
    from crazybilliards.comparison.claims.report import Reproduced
    from crazybilliards.comparison.claims.study import PaperFigure


class Quality(StrEnum):
    """How much to compute."""

    QUICK = "quick"
    FULL = "full"


def command(
    which: Annotated[
        str, typer.Argument(help="Number or name of a figure of the paper, or all.")
    ] = "all",
    show_list: Annotated[bool, typer.Option("--list", help="List the figures and stop.")] = False,
    quality: Annotated[
        Quality,
        typer.Option(help="All figures take 4 minutes (quick) or an hour (full) on two cores."),
    ] = Quality.QUICK,
    output: Annotated[
        Path, typer.Option(help="Folder for pictures, report and results; made if missing.")
    ] = Path("reproduced"),
    processes: Processes = None,
    dask: Dask = False,
    scheduler: Scheduler = None,
) -> None:
    """Reproduce the figures of arXiv:1404.7460, and check what the paper claims.

    Writes a picture for each figure and prints what became of the paper's claims; for all figures
    also report.html, one page with everything in it, and claims.md, the table. Results are kept in
    the folder: drawing again is a matter of seconds, and after Ctrl-C or a crash the same command
    goes on.

    Example: crazybilliards reproduce 17 --output results/paper

    Example: crazybilliards reproduce all --quality full
    """
    from crazybilliards.comparison.paper.figures import FIGURES, find_figures

    if show_list:
        for figure in FIGURES:
            print(f"{figure.number:3d}  {figure.name:28s} {figure.title}")
        return
    wanted = find_figures(which)
    check_folder(output)
    from crazybilliards.comparison.claims.report import all_cases
    from crazybilliards.comparison.sweeps.running import missing_cases
    from crazybilliards.model.locks import locked
    from crazybilliards.model.storage import make_folder

    computing = engine(processes, dask, scheduler)
    make_folder(output)
    with locked(output):
        kept = output / "cases"
        cases = all_cases(wanted, quality.value)
        missing = missing_cases(cases, kept)
        print(f"{len(cases)} cases, {len(cases) - len(missing)} of them in {kept} already")
        compute_missing(missing, kept, computing)
        _write(wanted, quality, output)


def _write(figures: list[PaperFigure], quality: Quality, output: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from crazybilliards.comparison.claims.report import html, markdown
    from crazybilliards.comparison.claims.report import reproduce as draw
    from crazybilliards.model.storage import write_atomically

    reproduced = []
    for each in draw(figures, quality.value, output / "cases"):
        write_atomically(output / each.file_name, each.picture)
        print(f"wrote {output / each.file_name}")
        reproduced.append(each)
    _print_claims(reproduced)
    if len(figures) > 1:
        for name, text in (
            ("claims.md", markdown(reproduced, quality.value)),
            ("report.html", html(reproduced, quality.value)),
        ):
            write_atomically(output / name, text.encode())
            print(f"wrote {output / name}")


def _print_claims(reproduced: list[Reproduced]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Claims of the paper")
    for name in ("figure", "claim", "found here", "theory", "verdict"):
        table.add_column(name)
    for each in reproduced:
        for claim in each.claims:
            table.add_row(
                str(each.figure.number),
                claim.statement,
                claim.measured,
                claim.theory,
                claim.verdict,
            )
    Console().print(table)
