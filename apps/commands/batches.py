"""The commands that compute many cases: sweep and reproduce."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.options import Json, Processes
from crazybilliards.apps.commands.output import end, writing_to, written_lines

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from crazybilliards.comparison.sweeps import Case, Sweep

_PRINTED = ("its number", "found here", "at other choices", "why")  # of what there is to say
_PAGES = {"all": "claims.md", "analytics": "analytics.md"}


def sweep(
    file: Annotated[
        Path,
        typer.Argument(
            help="TOML file with the tables [grid], [chain] and [simulate] (or another job).",
            show_default=False,
        ),
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the results, one file a case.")
    ],
    processes: Processes = None,
    keep_old: Annotated[
        bool,
        typer.Option("--keep-old", help="Take results of other source code of crazybilliards."),
    ] = False,
    as_json: Json = False,
) -> None:
    """Compute every case of a grid of parameters, each into a file of its own.

    The table [grid] holds lists of values of parameters of the chain or settings of the job. Every
    combination of them is a case. The tables [chain] and [simulate] (or the name of a theory) hold
    what is the same for all. What the folder holds already is not computed again: after Ctrl-C, a
    crash, or with a larger grid, the same command computes what is missing. In Python,
    crazybilliards.load_sweep(FOLDER) reads all of them as one Dataset.

    Example: crazybilliards sweep grid.toml --output results/grid
    """
    from crazybilliards.comparison.sweeps import process_pool, read_sweep

    cases = read_sweep(file)
    with process_pool(processes) as pool:
        facts, *how = _compute(cases, output, pool, keep_old)
    end(facts, as_json, f"{facts['cases']} cases, {facts['failed']} failed", status=how[0], why=how[1])


def _compute(
    cases: Sweep | list[Case], folder: Path, pool: Executor, keep_old: bool = False
) -> tuple[dict[str, Any], str, str]:
    """Compute what is missing; return facts, the status, and what went wrong."""
    from crazybilliards.comparison.sweeps import run_cases

    try:
        failed = run_cases(cases, folder, pool, keep_old=keep_old)
    except KeyboardInterrupt:
        return {"cases": len(cases), "failed": 0}, "interrupted", "the same command goes on"
    except RuntimeError as error:  # a worker died
        return {"cases": len(cases), "failed": 0}, "diverged", str(error)
    facts = {"cases": len(cases), "failed": len(failed), "folder": str(folder)}
    why = "; ".join(f"{case.canonical}: {reason}" for case, reason in failed.items())
    return facts, "diverged" if failed else "completed", why[:400]


def reproduce(
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
        Path, typer.Option("--output", "-o", help="Folder for pictures, report and results.")
    ] = Path("reproduced"),
    vector: Annotated[
        str | None, typer.Option(help="Another format for every picture.", metavar="pdf|svg")
    ] = None,
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
    from crazybilliards.comparison.sweeps import process_pool
    from crazybilliards.model.checks import check_choice
    from crazybilliards.model.storage import write_atomically
    from crazybilliards.reproduction.claims import report
    from crazybilliards.reproduction.figures import FIGURES, find_figures

    if show_list:
        studies = [{"number": each.number, "title": each.title} for each in FIGURES]
        lines = (f"{each.number:3}  {each.name:28s} {each.title}" for each in FIGURES)
        end({"studies": studies}, as_json, *lines)
        return
    wanted, written = find_figures(which), []
    chosen: Any = check_choice("quality", quality, ("quick", "full"))
    formats = [] if vector is None else [check_choice("vector", vector, ("pdf", "svg"))]
    with writing_to(output), process_pool(processes) as pool:
        if cases := report.all_cases(wanted, chosen):
            facts, status, why = _compute(cases, output / "cases", pool)
            if status != "completed":
                end(facts, as_json, status=status, why=why)
        done = list(report.reproduce(wanted, chosen, output / "cases", formats=formats))
        for each in done:
            for kind, picture in each.pictures.items():
                written.append(output / f"{each.study.stem}.{kind}")
                write_atomically(written[-1], picture)
        if which in _PAGES:
            written.append(output / _PAGES[which])
            write_atomically(written[-1], report.markdown(done, chosen).encode())
    claims = [(each.study, claim) for each in done for claim in each.claims]
    facts = {
        "written": [str(each) for each in written],
        "summary": report.summary(done),
        "claims": [
            {"figure": study.name, "claim": claim.statement, **claim.details}
            | {"number": claim.number._asdict(), "within": [*filter(isfinite, claim.within)]}
            for study, claim in claims
        ],
    }
    lines = [
        f"{study.number}. {claim.statement}: {claim.verdict}"
        + "".join(f"\n    {name}: {claim.details[name]}" for name in _PRINTED if name in claim.details)
        for study, claim in claims
    ]
    end(facts, as_json, written_lines(facts["written"]), *lines, *report.summary(done))
