"""The command ``crazybilliards reproduce``.

Only the standard library and typer are imported up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crazybilliards.comparison.commands.output import place, print_table, writing_to
from crazybilliards.comparison.commands.sweep import (
    Dask,
    KeepOld,
    Processes,
    Scheduler,
    compute_cases,
    engine,
)

if TYPE_CHECKING:
    from crazybilliards.comparison.claims.report import Reproduced
    from crazybilliards.comparison.claims.study import Study


# By what is asked for: names of the page with everything and of the table of claims.
_REPORTS = {"all": ("report.html", "claims.md"), "studies": ("studies.html", "studies.md")}


class Quality(StrEnum):
    """How much to compute."""

    QUICK = "quick"
    FULL = "full"


def command(
    which: Annotated[
        str,
        typer.Argument(
            help="Number or name of a figure of the paper, name of a study beyond the paper, "
            "all (figures of the paper), or studies (all beyond the paper)."
        ),
    ] = "all",
    show_list: Annotated[
        bool, typer.Option("--list", help="List the figures and the studies, and stop.")
    ] = False,
    quality: Annotated[
        Quality,
        typer.Option(help="All figures take 4 minutes (quick) or an hour (full) on two cores."),
    ] = Quality.QUICK,
    output: Annotated[
        Path,
        typer.Option(
            help="Folder for pictures, report and results; made if missing.",
            parser=place,
            metavar="FOLDER",
        ),
    ] = Path("reproduced"),
    processes: Processes = None,
    dask: Dask = False,
    scheduler: Scheduler = None,
    keep_old: KeepOld = False,
) -> None:
    """Reproduce the figures of arXiv:1404.7460, and check what the paper claims.

    Writes a picture for each figure and prints what became of the paper's claims. For all figures
    it also writes report.html, one page with everything in it, and claims.md, the table; for all
    studies beyond the paper these are studies.html and studies.md. Results are kept in the folder:
    drawing again is a matter of seconds, and after Ctrl-C or a crash the same command goes on.

    Example: crazybilliards reproduce 17 --output results/paper

    Example: crazybilliards reproduce all --quality full

    Example: crazybilliards reproduce elastic-gaps
    """
    from crazybilliards.comparison.paper.reproducible import find_studies

    if show_list:
        _print_list()
        return
    wanted = find_studies(which)
    from crazybilliards.comparison.claims.report import all_cases

    computing = engine(processes, dask, scheduler)
    with writing_to(output):
        compute_cases(all_cases(wanted, quality.value), output / "cases", computing, keep_old)
        reproduced = _draw(wanted, quality, output, keep_old)
        _print_claims(reproduced)
        if which in _REPORTS:
            _write_report(reproduced, quality, output, *_REPORTS[which])


def _print_list() -> None:
    from crazybilliards.comparison.claims.study import PaperFigure
    from crazybilliards.comparison.paper.reproducible import groups

    for group in groups().values():
        for study in group:
            number = study.number if isinstance(study, PaperFigure) else ""
            print(f"{number:3}  {study.name:28s} {study.title}")


def _draw(studies: list[Study], quality: Quality, output: Path, keep_old: bool) -> list[Reproduced]:
    import matplotlib

    matplotlib.use("Agg")
    from crazybilliards.comparison.claims.report import reproduce as draw
    from crazybilliards.model.storage import write_atomically

    reproduced = []
    for each in draw(studies, quality.value, output / "cases", keep_old=keep_old):
        path = output / each.study.file_name
        write_atomically(path, each.picture)
        print(f"wrote {path}")
        reproduced.append(each)
    return reproduced


def _write_report(
    reproduced: list[Reproduced], quality: Quality, output: Path, page: str, table: str
) -> None:
    from crazybilliards.comparison.claims.report import html, markdown
    from crazybilliards.model.storage import write_atomically

    for name, text in (
        (table, markdown(reproduced, quality.value)),
        (page, html(reproduced, quality.value)),
    ):
        write_atomically(output / name, text.encode())
        print(f"wrote {output / name}")


def _print_claims(reproduced: list[Reproduced]) -> None:
    """Print the claims of the figures, if there are any, and how many came out how."""
    from rich.table import Table

    from crazybilliards.comparison.claims.report import summary

    if not any(each.claims for each in reproduced):
        return
    table = Table(title="Claims")
    for name in ("figure", "claim", "found here", "theory", "verdict"):
        table.add_column(name)
    for each in reproduced:
        for claim in each.claims:
            table.add_row(
                each.study.label,
                claim.statement,
                claim.measured,
                claim.theory,
                claim.verdict,
            )
    print_table(table)
    for line in summary(reproduced):
        print(line)
