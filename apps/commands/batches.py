"""The commands that compute many cases: sweep and reproduce."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from typer import Argument, Exit, Option

from crazybilliards.apps.commands.options import Json, Processes, at_home
from crazybilliards.apps.commands.output import answer, complain, writing_to

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from crazybilliards.comparison.sweeps import Case
    from crazybilliards.reproduction.claims.report import Reproduction

_PRINTED = ("its number", "found here", "at other choices", "why")  # of what there is to say
_PAGES = {"all": "claims.md", "analytics": "analytics.md"}


def sweep(
    file: Path = Argument(..., help="TOML file: [grid], [chain] and [simulate], or another job."),
    output: Path = Option(..., "--output", "-o", callback=at_home, help="Folder of all cases."),
    processes: Processes = None,
    scheduler: str | None = Option(None, help="dask cluster to compute on, tcp://HOST:PORT say."),
    keep_old: bool = Option(False, "--keep-old", help="Take results of other source code, too."),
    as_json: Json = False,
) -> None:
    """Compute every case of a grid of parameters, each into a file of its own.

    The table [grid] of the file holds lists of values of parameters of the chain or settings of
    the job. Every combination of them is a case. The tables [chain] and [simulate] (or the name of
    a theory, see crazybilliards theory --help) hold what is the same for all cases.

    What the folder holds already is not computed again: after Ctrl-C, a crash, or with a larger
    grid, the same command computes what is missing. In Python, crazybilliards.load_sweep(FOLDER)
    reads all of them as one Dataset.

    Example: crazybilliards sweep grid.toml --output results/grid
    """
    from crazybilliards.comparison.sweeps import read_sweep, run_cases

    cases = read_sweep(file)
    with _workers(processes, scheduler) as executor:
        failed = run_cases(cases, output, executor, keep_old=keep_old)
    reasons = [case.arguments | {"reason": reason} for case, reason in failed.items()]
    answer(
        as_json,
        {"cases": len(cases), "folder": str(output), "failed": reasons},
        f"{len(cases)} cases in {output}, {len(failed)} of them failed",
    )
    _end_if(failed)


@contextmanager
def _workers(processes: int | None, scheduler: str | None) -> Iterator[Executor]:
    """Give what computes cases: processes of this machine, or the cluster of a scheduler."""
    if scheduler is None:
        from crazybilliards.comparison.sweeps import process_pool

        with process_pool(processes) as pool:
            yield pool
        return
    if processes is not None:
        raise ValueError("processes: a dask cluster decides that itself")
    try:
        from distributed import Client
    except ImportError as error:
        raise ValueError("no dask here: pip install 'crazybilliards[sweep]'") from error
    with Client(scheduler, set_as_default=False) as client:
        yield client.get_executor(pure=False)


def _end_if(failed: dict[Case, str]) -> None:
    """End the command with status 1 if cases failed, and tell the first reason."""
    for case, reason in failed.items():
        complain(f"{len(failed)} cases failed, the first, {case.canonical}, with {reason}")
        raise Exit(1)


def reproduce(
    which: str = Argument(
        "all",
        help="Numbers or names of figures, separated by commas; all figures of the paper; or "
        "analytics: those of the section of that name and of the velocities at restitution 1.",
    ),
    show_list: bool = Option(False, "--list", help="List the figures, and stop."),
    quality: Literal["quick", "full"] = Option("quick", help="For all figures 2 minutes, or 15."),
    output: Path = Option(Path("reproduced"), "--output", "-o", callback=at_home, help="Folder."),
    vector: Literal["pdf", "svg"] | None = Option(None, help="Another format for every picture."),
    processes: Processes = None,
    as_json: Json = False,
) -> None:
    """Reproduce the figures of arXiv:1404.7460, and check what the paper claims.

    Writes a picture for each figure and prints what became of the paper's claims. For all figures
    it also writes claims.md, one page about all of it that shows the pictures; for analytics it is
    analytics.md. Results are kept in the folder: drawing again is a matter of seconds, and
    after Ctrl-C or a crash the same command goes on.

    Example: crazybilliards reproduce 16,17 --output results/paper
    """
    from crazybilliards.comparison.sweeps import run_cases
    from crazybilliards.model.storage import write_atomically
    from crazybilliards.reproduction.claims import report
    from crazybilliards.reproduction.figures import FIGURES, find_figures

    if show_list:
        studies = [{"number": study.number, "title": study.title} for study in FIGURES]
        lines = (f"{study.number:3}  {study.name:28s} {study.title}" for study in FIGURES)
        answer(as_json, {"studies": studies}, *lines)
        return
    wanted = find_figures(which)
    drawn, files = [], []
    with writing_to(output), _workers(processes, None) as executor:
        if cases := report.all_cases(wanted, quality):
            _end_if(run_cases(cases, output / "cases", executor))
        for figure in report.reproduce(
            wanted, quality, output / "cases", formats=[vector] if vector else []
        ):
            drawn.append(figure)
            for kind, content in figure.pictures.items():
                files.append(output / f"{figure.study.stem}.{kind}")
                write_atomically(files[-1], content)
        if which in _PAGES:
            files.append(output / _PAGES[which])
            write_atomically(files[-1], report.markdown(drawn, quality).encode())
    _answer_claims(drawn, list(map(str, files)), as_json)


def _answer_claims(drawn: list[Reproduction], written: list[str], as_json: bool) -> None:
    """Print the claims of the figures, and how many came out how."""
    from crazybilliards.reproduction.claims.report import summary

    facts, lines = [], [f"wrote {name}" for name in written]
    for figure in drawn:
        for claim in figure.claims:
            details = claim.details
            facts.append(
                {
                    "figure": figure.study.name,
                    "claim": claim.statement,
                    **details,
                    "number": claim.number._asdict(),
                    "within": claim.within,
                    "elsewhere": {name: at._asdict() for name, at in claim.elsewhere.items()},
                }
            )
            lines.append(f"{figure.study.number}. {claim.statement}: {claim.verdict}")
            lines += [f"    {name}: {details[name]}" for name in _PRINTED if name in details]
    counted = summary(drawn)
    answer(as_json, {"written": written, "summary": counted, "claims": facts}, *lines, *counted)
