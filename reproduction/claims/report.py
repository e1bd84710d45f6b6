"""Studies carried out: pictures drawn from stored cases, claims checked, a report of all of it."""

from __future__ import annotations

import base64
import io
import platform
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any, get_args

import jinja2
import matplotlib.pyplot as plt

from crazybilliards.comparison.layout import Columns, house_style
from crazybilliards.comparison.sweeps import Case
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Verdict

_NO_DATE = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
_VERSIONS = ("crazybilliards", "numpy", "numba", "scipy", "scikit-fem", "py-pde", "xarray")
OF_PAPER = "Statements of the paper"
OWN = "Our own findings"
_LIMIT = "the limit dt -> 0; the error includes the remaining error of the step"


@dataclass(frozen=True)
class Reproduced:
    """A study, drawn from its results, and what became of its claims.

    Attributes
    ----------
    study
        The study, which may be a figure of the paper.
    pictures
        The picture as a file, by format: PNG always, others as asked for.
    claims
        The checked claims.
    parameters
        What was computed, a line for each kind of case.
    seconds
        Computing time of its cases; those that studies share count for each.
    """

    study: Study
    pictures: dict[str, bytes]
    claims: list[Claim]
    parameters: list[str]
    seconds: float

    @property
    def picture(self) -> bytes:
        """The picture as PNG."""
        return self.pictures["png"]

    @property
    def embedded(self) -> str:
        """The picture as text, for one self-contained page."""
        return base64.b64encode(self.picture).decode()

    @property
    def parts(self) -> dict[str, list[Claim]]:
        """The claims: those of the paper and our own, each under its title."""
        both = {
            OF_PAPER: [claim for claim in self.claims if claim.of_paper],
            OWN: [claim for claim in self.claims if not claim.of_paper],
        }
        return {title: claims for title, claims in both.items() if claims}


def all_cases(studies: Iterable[Study], quality: Quality) -> list[Case]:
    """Return the cases that the studies need, each once."""
    return list(dict.fromkeys(case for study in studies for case in study.cases(quality).values()))


def reproduce(
    studies: Iterable[Study],
    quality: Quality,
    folder: Path,
    *,
    keep_old: bool = False,
    columns: Columns | None = None,
    formats: Collection[str] = (),
) -> Iterator[Reproduced]:
    """Draw studies and check their claims, one after another, from the cases in ``folder``.

    ``keep_old`` as in :func:`crazybilliards.comparison.sweeps.run_cases`. ``columns``: the width
    of the pictures, as :func:`crazybilliards.comparison.layout.house_style` takes it. ``formats``:
    file formats of matplotlib, besides PNG.
    """
    load = cache(lambda case: case.load(folder, keep_old=keep_old))  # many studies share cases
    for study in studies:
        cases = study.cases(quality)
        results = {name: load(case) for name, case in cases.items()}
        with house_style(columns):
            pictures = _drawn(study, results, ("png", *formats))
        yield _reproduced(study, cases, results, pictures)


def _drawn(study: Study, results: Results, formats: Iterable[str]) -> dict[str, bytes]:
    drawn = study.draw(results)
    pictures = {}
    for kind in formats:
        picture = io.BytesIO()
        # The same picture is to give the same file, whenever it is drawn.
        drawn.savefig(picture, format=kind, metadata=_NO_DATE.get(kind))
        pictures[kind] = picture.getvalue()
    plt.close(drawn)
    return pictures


def _reproduced(
    study: Study, cases: Cases, results: Results, pictures: dict[str, bytes]
) -> Reproduced:
    return Reproduced(
        study=study,
        pictures=pictures,
        claims=study.claims(results),
        parameters=describe(cases.values()),
        seconds=sum(run.attrs["seconds"] for run in results.values()),
    )


def describe(cases: Iterable[Case]) -> list[str]:
    """Say in a line for each kind of case what is not the default, and how many runs there are.

    Runs that differ in their random numbers or in what is observed only are of one kind.
    """
    return [
        f"{line} ({number} runs)" if number > 1 else line
        for line, number in Counter(case.title for case in cases).items()
    ]


def markdown(reproduced: list[Reproduced], quality: Quality) -> str:
    """Return a page of Markdown, to lie beside the pictures: a part for each study.

    It begins with a table that counts the verdicts of each study and leads to its part. The parts
    are in lists and not in tables, so that a narrow screen shows all of a claim.
    """
    numbers = _versions()
    rows = [
        "# What is claimed, and what was found",
        "",
        f"Quality: {quality}. Written by `crazybilliards reproduce`; "
        f"{', '.join(f'{name} {number}' for name, number in numbers.items())}.",
        "",
        *(f"* {line}" for line in summary(reproduced)),
        "",
        *_verdicts_by_study(reproduced),
    ]
    for each in reproduced:
        study = each.study
        rows += ["", f"## {study.heading}", ""]
        rows += [f"![{study.title}]({study.file_name})", "", study.caption]
        for title, claims in each.parts.items():
            rows += ["", f"### {title}"]
            for claim in claims:
                rows += ["", f"**{_plain(claim.statement)}**", ""]
                rows += [f"* {name}: {_plain(text)}" for name, text in details(claim).items()]
    return "\n".join(rows) + "\n"


def _verdicts_by_study(reproduced: list[Reproduced]) -> list[str]:
    """Return a table of Markdown: how many claims of each study have which verdict."""
    rows = [f"| figure or study | {OF_PAPER.lower()} | {OWN.lower()} |", "|---|---|---|"]
    for each in reproduced:
        heading = each.study.heading
        verdicts = (_counted(each.parts.get(title, [])) for title in (OF_PAPER, OWN))
        rows.append(f"| [{heading}](#{_anchor(heading)}) | {' | '.join(verdicts)} |")
    return rows


def _anchor(heading: str) -> str:
    """Return the name that Markdown gives to a heading, for links to it."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def _counted(claims: Iterable[Claim]) -> str:
    counts = Counter(claim.verdict for claim in claims)
    return ", ".join(
        f"{counts[verdict]} {verdict}" for verdict in get_args(Verdict) if counts[verdict]
    )


def _plain(text: str) -> str:
    """Return text that Markdown leaves as it is: <dx> is no tag, and N_c or * no emphasis."""
    return re.sub(r"([*_|\[\]])", r"\\\1", escape(text, quote=False))


def details(claim: Claim) -> dict[str, str]:
    """Return what there is to say about a claim, by what it is."""
    said = {
        "verdict": claim.verdict,
        "in the paper": claim.source,
        "its number": claim.paper,
        "found here": claim.measured,
        "time step": _LIMIT if claim.in_limit else "",
        "theory": claim.theory,
        "our choice, not given in the paper": claim.ours,
        "at other choices": "; ".join(
            f"{other.choice}: {other.measured}, {other.verdict}" for other in claim.variations
        ),
        "why": claim.reason,
        "and yet, exactly": claim.exactly,
    }
    return {name: text for name, text in said.items() if text}


def html(reproduced: list[Reproduced], quality: Quality) -> str:
    """Return the report: one page with everything in it."""
    template = (
        files("crazybilliards.reproduction.claims").joinpath("report.html.jinja").read_text("utf-8")
    )
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    page: dict[str, Any] = {
        "reproduced": reproduced,
        "quality": quality,
        "summary": summary(reproduced),
        "details": details,
        "versions": _versions(),
    }
    return environment.from_string(template).render(page)


def summary(reproduced: list[Reproduced]) -> list[str]:
    """Count the verdicts, of statements of the paper and of our own findings, and the limits."""
    lines = []
    for title in (OF_PAPER, OWN):
        claims = [claim for each in reproduced for claim in each.parts.get(title, ())]
        if claims:
            lines.append(f"{title}: {_counted(claims)}")
    limits = sum(claim.in_limit for each in reproduced for claim in each.claims)
    if limits:
        lines.append(
            f"Limits of a vanishing time step: the numbers of {limits} claims, marked so; every "
            "other number of a simulation is that at the time step of its runs"
        )
    return lines


def _versions() -> dict[str, str]:
    return {"python": platform.python_version()} | {name: version(name) for name in _VERSIONS}
