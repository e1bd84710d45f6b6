"""The command ``crazybilliards reproduce``."""

from __future__ import annotations

import os
import shutil
import textwrap
from contextlib import nullcontext
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.answers import note, say, wrote
from crazybilliards.apps.commands.options import Processes, Scheduler, path_option
from crazybilliards.apps.commands.output import writing_to
from crazybilliards.apps.commands.sweep import compute_cases, engine
from crazybilliards.model.checks import check_choice, check_integer

if TYPE_CHECKING:
    from crazybilliards.reproduction.claims.report import Reproduced
    from crazybilliards.reproduction.claims.study import Quality, Study


# Of what there is to say about a claim.
_PRINTED = ("its number", "found here", "at other choices", "why")
_MANY = 6  # figures: a process takes as long to get ready to draw as for two of them
# By what is asked for: names of the table of claims and of the page with everything.
_REPORTS = {"all": ("claims.md", "report.html"), "analytics": ("analytics.md", "analytics.html")}


def command(
    which: Annotated[
        str,
        typer.Argument(
            help="Numbers or names of figures of the paper, separated by commas, all (figures of "
            "the paper), or analytics (those of the paper's section of that name and of the "
            "velocities at restitution 1)."
        ),
    ] = "all",
    show_list: Annotated[bool, typer.Option("--list", help="List the figures, and stop.")] = False,
    quality: Annotated[
        str,
        typer.Option(
            help="All figures take 2 minutes (quick) or 15 (full) on two cores.",
            metavar="quick|full",
        ),
    ] = "quick",
    output: Annotated[
        Path, path_option("Folder for pictures, report and results; made if missing.")
    ] = Path("reproduced"),
    columns: Annotated[
        int | None,
        typer.Option(
            help="Width of the pictures in columns of a journal, 1 (3.4 inches) or 2 (7 inches); "
            "default: as their panels need."
        ),
    ] = None,
    vector: Annotated[
        str | None,
        typer.Option(help="Write every picture as a vector graphic, too.", metavar="pdf|svg"),
    ] = None,
    processes: Processes = None,
    scheduler: Scheduler = None,
) -> None:
    """Reproduce the figures of arXiv:1404.7460, and check what the paper claims.

    Writes a picture for each figure and prints what became of the paper's claims. For all figures
    it also writes report.html, one page with everything in it, and claims.md, the table of claims;
    for analytics these pages bear its name. Results are kept in the folder: drawing again is a
    matter of seconds, and after Ctrl-C or a crash the same command goes on.

    Example: crazybilliards reproduce analytics

    Example: crazybilliards reproduce 16,17 --output results/paper

    Example: crazybilliards reproduce all --quality full
    """
    from crazybilliards.reproduction.reproducible import find_studies

    if show_list:
        _print_list()
        return
    wanted = find_studies(which)
    chosen: Quality = check_choice("quality", quality, ("quick", "full"))  # type: ignore[assignment]
    if columns is not None:
        check_integer("columns", columns, least=1, most=2)
    if vector is not None:
        check_choice("vector", vector, ("pdf", "svg"))
    from crazybilliards.model.storage import write_atomically
    from crazybilliards.reproduction.claims.report import all_cases, html, markdown

    with writing_to(output), engine(processes, scheduler) as workers:
        cases = all_cases(wanted, chosen)
        compute_cases(cases, output / "cases", nullcontext(workers), keep_old=False)
        how = {"columns": columns, "formats": [] if vector is None else [vector]}
        # The workers of a cluster need not see the folder, and few figures are drawn sooner here.
        here = scheduler is not None or len(wanted) < _MANY
        reproduced = _draw(wanted, chosen, output, executor=None if here else workers, **how)
        if which in _REPORTS:
            for name, written in zip(_REPORTS[which], (markdown, html), strict=True):
                write_atomically(output / name, written(reproduced, chosen).encode())
                wrote(output / name)
        _print_claims(reproduced, chosen)


def _print_list() -> None:
    from crazybilliards.reproduction.figures import FIGURES

    listed = []
    for study in FIGURES:
        listed.append({"number": study.number, "name": study.name, "title": study.title})
        say(f"{study.number:3}  {study.name:28s} {study.title}")
    note(studies=listed)


def _draw(studies: list[Study], quality: Quality, output: Path, **how: Any) -> list[Reproduced]:
    import matplotlib

    matplotlib.use("Agg")
    os.environ["MPLBACKEND"] = "Agg"  # of processes that have not started yet
    from crazybilliards.model.progress import waiting_for
    from crazybilliards.model.storage import write_atomically
    from crazybilliards.reproduction.claims.report import reproduce as draw

    reproduced = []
    drawing = draw(studies, quality, output / "cases", **how)
    for number, study in enumerate(studies, start=1):
        with waiting_for(f"drawing {study.label}, {number} of {len(studies)}"):
            each = next(drawing)
        for kind, picture in each.pictures.items():
            path = output / f"{each.study.stem}.{kind}"
            write_atomically(path, picture)
            wrote(path)
        reproduced.append(each)
    return reproduced


def _print_claims(reproduced: list[Reproduced], quality: Quality) -> None:
    """Print the claims of the figures, if there are any, and how many came out how."""
    from crazybilliards.reproduction.claims.report import summary

    noted = []
    for each in reproduced:
        if each.claims:
            say(f"\n{each.study.heading}")
        for claim in each.claims:
            said = claim.details
            which = {"figure": each.study.name, "claim": claim.statement}
            numbers = {
                "number": claim.found._asdict(),
                "within": [bound if isfinite(bound) else None for bound in claim.within],
                "elsewhere": {name: at._asdict() for name, at in claim.elsewhere.items()},
            }
            noted.append(which | said | numbers)
            more = " from so few runs (--quality full has more)" if quality == "quick" else ""
            undecided = more if claim.verdict == "undecided" else ""
            say(_indented(1, f"{claim.statement}: {claim.verdict}{undecided}"))
            for name in (name for name in said if name in _PRINTED):
                say(_indented(2, f"{name}: {said[name]}"))
    note(claims=noted, summary=summary(reproduced))
    if noted:
        say("")
    for line in summary(reproduced):
        say(line)


def _indented(levels: int, text: str) -> str:
    """Wrap a text to the terminal."""
    width = max(shutil.get_terminal_size().columns, 40)
    indent = "  " * levels
    return textwrap.fill(text, width, initial_indent=indent, subsequent_indent=indent + "  ")
