"""Studies carried out: pictures drawn from stored cases, claims checked, a page about all of it."""

from __future__ import annotations

import io
import platform
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.metadata import version
from pathlib import Path
from typing import get_args

import xarray as xr

from crazybilliards.comparison.layout import house_style
from crazybilliards.comparison.sweeps import Case
from crazybilliards.reproduction.claims.study import Quality, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Verdict

_NO_DATE = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
_VERSIONS = ("crazybilliards", "numpy", "numba", "scipy", "scikit-fem", "py-pde", "xarray")
_INTRODUCTION = (
    "Figures of R. Mani, L. Böttcher, H. J. Herrmann and D. Helbing, "
    "[arXiv:1404.7460](https://arxiv.org/abs/1404.7460), computed anew. A claim holds if its "
    "number lies inside its limits with three standard errors to spare. It fails if the number "
    "lies outside with three to spare. Otherwise it is undecided. A number at another choice has "
    "no verdict beside it if it decides nothing."
)


@dataclass(frozen=True)
class Reproduction:
    """A study, drawn from its results, and what became of its claims."""

    study: Study
    pictures: dict[str, bytes]  # the picture as a file, by format: PNG always, others as asked for
    claims: list[Claim]  # checked
    parameters: list[str]  # what was computed, a line for each kind of case


def all_cases(studies: Iterable[Study], quality: Quality) -> list[Case]:
    """Return the cases that the studies need, each once."""
    return list(dict.fromkeys(case for study in studies for case in study.cases(quality).values()))


def reproduce(
    studies: Iterable[Study], quality: Quality, folder: Path, *, formats: Collection[str] = ()
) -> Iterator[Reproduction]:
    """Draw studies and check their claims, in their order, from the cases in ``folder``.

    ``formats``: file formats of matplotlib, besides PNG.
    """

    @cache  # many studies share cases
    def result(case: Case) -> xr.Dataset:
        return case.load(folder)

    for study in studies:
        cases = study.cases(quality)
        results = {name: result(case) for name, case in cases.items()}
        with house_style():
            pictures = _pictures(study, results, ("png", *formats))
        claims = study.claims(results) if study.claims else []
        yield Reproduction(study, pictures, claims, describe(cases.values()))


def _pictures(
    study: Study, results: dict[str, xr.Dataset], formats: Iterable[str]
) -> dict[str, bytes]:
    figure = study.draw(results)
    pictures = {}
    for kind in formats:
        picture = io.BytesIO()
        # The same picture is to give the same file, whenever it is drawn.
        figure.savefig(picture, format=kind, metadata=_NO_DATE.get(kind))
        pictures[kind] = picture.getvalue()
    return pictures


def describe(cases: Iterable[Case]) -> list[str]:
    """Say in a line for each kind of case what is not the default, and how many runs there are.

    Runs that differ in their random numbers or in what is observed only are of one kind.
    """
    return [
        f"{line} ({number} runs)" if number > 1 else line
        for line, number in Counter(case.title for case in cases).items()
    ]


def markdown(reproductions: Sequence[Reproduction], quality: Quality) -> str:
    """Return a page of Markdown, to lie beside the pictures: a part for each study.

    It begins with a table that counts the verdicts of each study and leads to its part. The parts
    are in lists and not in tables, so that a narrow screen shows all of a claim.
    """
    versions = {"python": platform.python_version()} | {name: version(name) for name in _VERSIONS}
    rows = [
        "# What is claimed, and what was found",
        "",
        f"Quality: {quality}. Written by `crazybilliards reproduce`; "
        f"{', '.join(f'{name} {number}' for name, number in versions.items())}.",
        "",
        _INTRODUCTION,
        "",
        *(f"* {line}" for line in summary(reproductions)),
        "",
        "| figure | verdicts |",
        "|---|---|",
    ]
    for reproduction in reproductions:
        heading = reproduction.study.heading
        rows.append(f"| [{heading}](#{_anchor(heading)}) | {_counts(reproduction.claims)} |")
    for reproduction in reproductions:
        study = reproduction.study
        rows += ["", f"## {study.heading}", ""]
        rows += [f"![{study.title}]({study.stem}.png)", "", study.caption]
        if reproduction.parameters:
            rows += ["", f"Computed: {_plain('; '.join(reproduction.parameters))}."]
        for claim in reproduction.claims:
            rows += ["", f"**{_plain(claim.statement)}**", ""]
            rows += [f"* {name}: {_plain(text)}" for name, text in claim.details.items()]
    return "\n".join(rows) + "\n"


def _anchor(heading: str) -> str:
    """Return the name that Markdown gives to a heading, for links to it."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def _counts(claims: Iterable[Claim]) -> str:
    counts = Counter(claim.verdict for claim in claims)
    return ", ".join(
        f"{counts[verdict]} {verdict}" for verdict in get_args(Verdict) if counts[verdict]
    )


def _plain(text: str) -> str:
    """Return text that Markdown leaves as it is: <dx> is no tag, and N_c or * no emphasis."""
    return re.sub(r"([*_|\[\]])", r"\\\1", escape(text, quote=False))


def summary(reproductions: Iterable[Reproduction]) -> list[str]:
    """Count the verdicts in a line, if there are any."""
    claims = [claim for reproduction in reproductions for claim in reproduction.claims]
    return [f"Statements of the paper: {_counts(claims)}"] if claims else []
