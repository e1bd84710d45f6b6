"""Studies carried out: pictures drawn from stored cases, claims checked, a report of all of it."""

from __future__ import annotations

import base64
import io
import platform
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
import matplotlib.pyplot as plt

from crazybilliards.comparison.claims.study import Cases, Quality, Results, Study
from crazybilliards.comparison.claims.verdicts import Claim
from crazybilliards.comparison.sweeps import Case

_VERSIONS = ("crazybilliards", "numpy", "numba", "scipy", "scikit-fem", "py-pde", "xarray")


@dataclass(frozen=True)
class Reproduced:
    """A study, drawn from its results, and what became of its claims.

    Attributes
    ----------
    study
        The study, which may be a figure of the paper.
    picture
        PNG bytes.
    claims
        The checked claims.
    parameters
        What was computed, a line for each kind of case.
    seconds
        Computing time of its cases; those that studies share count for each.
    """

    study: Study
    picture: bytes
    claims: list[Claim]
    parameters: list[str]
    seconds: float

    @property
    def embedded(self) -> str:
        """The picture as text, for one self-contained page."""
        return base64.b64encode(self.picture).decode()


def all_cases(studies: Iterable[Study], quality: Quality) -> list[Case]:
    """Return the cases that the studies need, each once."""
    return list(dict.fromkeys(case for study in studies for case in study.cases(quality).values()))


def reproduce(
    studies: Iterable[Study], quality: Quality, folder: Path, *, keep_old: bool = False
) -> Iterator[Reproduced]:
    """Draw studies and check their claims, one after another, from the cases in ``folder``.

    ``keep_old`` as in :func:`crazybilliards.comparison.sweeps.run_cases`.
    """
    load = cache(lambda case: case.load(folder, keep_old=keep_old))  # many studies share cases
    for study in studies:
        cases = study.cases(quality)
        yield _reproduce(study, cases, {name: load(case) for name, case in cases.items()})


def _reproduce(study: Study, cases: Cases, results: Results) -> Reproduced:
    claims = study.claims(results)
    drawn = study.draw(results)
    picture = io.BytesIO()
    drawn.savefig(picture, format="png", dpi=130)
    plt.close(drawn)
    return Reproduced(
        study=study,
        picture=picture.getvalue(),
        claims=claims,
        parameters=describe(cases.values()),
        seconds=sum(run.attrs["seconds"] for run in results.values()),
    )


def describe(cases: Iterable[Case]) -> list[str]:
    """Say in a line for each kind of case what is not the default, and how many runs there are.

    Runs that differ in their random numbers or in what is observed only are of one kind.
    """
    lines = []
    for case in cases:
        changed = [
            f"{name} {value}"
            for name, value in case.changed.items()
            if name not in ("seed", "observe")
        ]
        lines.append(f"{case.job}: {', '.join(changed) or 'defaults'}")
    return [
        f"{line} ({number} runs)" if number > 1 else line for line, number in Counter(lines).items()
    ]


def markdown(reproduced: list[Reproduced], quality: Quality) -> str:
    """Return the table of claims, and the pictures, as a page of Markdown beside the pictures."""
    numbers = _versions()
    rows = [
        "# What is claimed, and what was found",
        "",
        f"Quality: {quality}. {_summary(reproduced)}. Written by `crazybilliards reproduce`; "
        f"{', '.join(f'{name} {number}' for name, number in numbers.items())}.",
        "",
        "| figure | claim | its number | found here | theory | verdict |",
        "|---|---|---|---|---|---|",
    ]
    for each in reproduced:
        for claim in each.claims:
            verdict = f"**{claim.verdict}**" + (f": {claim.reason}" if claim.reason else "")
            cells = (
                each.study.label,
                claim.statement,
                claim.paper,
                claim.measured,
                claim.theory,
                verdict,
            )
            # <dx> must not be taken for a tag, nor |x| for a column.
            plain = (escape(cell, quote=False).replace("|", "\\|") for cell in cells)
            rows.append("| " + " | ".join(plain) + " |")
    for each in reproduced:
        study = each.study
        rows += ["", f"## {study.heading}", ""]
        rows += [f"![{study.title}]({study.file_name})", "", study.caption]
    return "\n".join(rows) + "\n"


def html(reproduced: list[Reproduced], quality: Quality) -> str:
    """Return the report: one page with everything in it."""
    template = (
        files("crazybilliards.comparison.claims").joinpath("report.html.jinja").read_text("utf-8")
    )
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    page: dict[str, Any] = {
        "reproduced": reproduced,
        "quality": quality,
        "summary": _summary(reproduced),
        "versions": _versions(),
    }
    return environment.from_string(template).render(page)


def _summary(reproduced: list[Reproduced]) -> str:
    verdicts = Counter(claim.verdict for each in reproduced for claim in each.claims)
    return ", ".join(f"{number} {verdict}" for verdict, number in sorted(verdicts.items()))


def _versions() -> dict[str, str]:
    return {"python": platform.python_version()} | {name: version(name) for name in _VERSIONS}
