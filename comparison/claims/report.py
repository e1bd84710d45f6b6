"""The paper reproduced: figures drawn from stored cases, claims checked, a report of all of it."""

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

from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain

_VERSIONS = ("crazybilliards", "numpy", "numba", "scipy", "scikit-fem", "py-pde", "xarray")


@dataclass(frozen=True)
class Reproduced:
    """A figure of the paper, drawn from its results, and what became of its claims.

    Attributes
    ----------
    figure
        The figure.
    picture
        PNG bytes.
    claims
        The checked claims.
    parameters
        What was computed, a line for each kind of case.
    seconds
        Computing time of its cases; those that figures share count for each.
    """

    figure: PaperFigure
    picture: bytes
    claims: list[Claim]
    parameters: list[str]
    seconds: float

    @property
    def file_name(self) -> str:
        """Name of its picture: number and name."""
        return f"fig{self.figure.number:02d}_{self.figure.name}.png"

    @property
    def embedded(self) -> str:
        """The picture as text, for one self-contained page."""
        return base64.b64encode(self.picture).decode()


def all_cases(figures: Iterable[PaperFigure], quality: Quality) -> list[Case]:
    """Return the cases that the figures need, each once."""
    return list(
        dict.fromkeys(case for figure in figures for case in figure.cases(quality).values())
    )


def reproduce(
    figures: Iterable[PaperFigure], quality: Quality, folder: Path, *, keep_old: bool = False
) -> Iterator[Reproduced]:
    """Draw figures and check their claims, one after another, from the cases in ``folder``.

    ``keep_old`` as in :func:`crazybilliards.comparison.sweeps.run_cases`.
    """
    load = cache(lambda case: case.load(folder, keep_old=keep_old))  # many figures share cases
    for figure in figures:
        cases = figure.cases(quality)
        yield _reproduce(figure, cases, {name: load(case) for name, case in cases.items()})


def _reproduce(figure: PaperFigure, cases: Cases, results: Results) -> Reproduced:
    claims = figure.claims(results)
    drawn = figure.draw(results)
    picture = io.BytesIO()
    drawn.savefig(picture, format="png", dpi=130)
    plt.close(drawn)
    return Reproduced(
        figure=figure,
        picture=picture.getvalue(),
        claims=claims,
        parameters=describe(cases.values()),
        seconds=sum(run.attrs["seconds"] for run in results.values()),
    )


def describe(cases: Iterable[Case]) -> list[str]:
    """Say in a line for each kind of case what is not the default, and how many runs there are."""
    standard = Chain().parameters()
    lines = []
    for case in cases:
        own = case.chain.parameters().items()
        chain = [f"{name} {value}" for name, value in own if value != standard[name]]
        wanted = ("duration", "warmup", "time_step", "method", "cells")
        standard_job = Case(case.job, Chain(), {}).settings
        settings = [
            f"{name} {case.settings[name]}"
            for name in wanted
            if name in case.settings and case.settings[name] != standard_job[name]
        ]
        lines.append(f"{case.job}: {', '.join(chain + settings) or 'defaults'}")
    return [
        f"{line} ({number} runs)" if number > 1 else line for line, number in Counter(lines).items()
    ]


def markdown(reproduced: list[Reproduced], quality: Quality) -> str:
    """Return the table of claims, and the figures, as a page of Markdown beside the pictures."""
    numbers = _versions()
    rows = [
        "# What the paper claims, and what was found",
        "",
        f"Quality: {quality}. {_summary(reproduced)}. Written by `crazybilliards reproduce`; "
        f"{', '.join(f'{name} {number}' for name, number in numbers.items())}.",
        "",
        "| figure | the paper says | its number | found here | theory | verdict |",
        "|---|---|---|---|---|---|",
    ]
    for each in reproduced:
        for claim in each.claims:
            verdict = f"**{claim.verdict}**" + (f": {claim.reason}" if claim.reason else "")
            cells = (
                f"{each.figure.number} {each.figure.name}",
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
        figure = each.figure
        rows += ["", f"## {figure.number}. {figure.title}", ""]
        rows += [f"![{figure.title}]({each.file_name})", "", figure.caption]
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
