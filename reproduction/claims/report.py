"""Studies carried out: pictures drawn from stored cases, claims checked, a page about all of it."""

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

from crazybilliards.comparison.drawing import as_file, house_style
from crazybilliards.comparison.sweeps import Case
from crazybilliards.reproduction.claims.study import Quality, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Verdict

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
    pictures: dict[str, bytes]  # files by their formats: PNG always, others as asked for
    claims: list[Claim]
    parameters: list[str]  # what was computed, a line for each kind of case


def all_cases(studies: Iterable[Study], quality: Quality) -> list[Case]:
    """Return the cases that the studies need, each once."""
    return list(dict.fromkeys(case for study in studies for case in study.cases(quality).values()))


def reproduce(
    studies: Iterable[Study], quality: Quality, folder: Path, *, formats: Collection[str] = ()
) -> Iterator[Reproduction]:
    """Draw studies, as PNG and ``formats``, check their claims, from the cases in ``folder``."""

    @cache  # many studies share cases
    def result(case: Case) -> xr.Dataset:
        return case.load(folder)

    for study in studies:
        cases = study.cases(quality)
        results = {name: result(case) for name, case in cases.items()}
        with house_style():
            figure = study.draw(results)
            pictures = {kind: as_file(figure, kind) for kind in ("png", *formats)}
        claims = study.claims(results) if study.claims else []
        yield Reproduction(study, pictures, claims, describe(cases.values()))


def describe(cases: Iterable[Case]) -> list[str]:
    """Say in a line for each kind of case what is not the default, and how many runs there are."""
    return [
        f"{line} ({number} runs)" if number > 1 else line
        for line, number in Counter(case.title for case in cases).items()
    ]


def markdown(reproductions: Sequence[Reproduction], quality: Quality) -> str:
    """Return a page of Markdown, to lie beside the pictures: verdicts, then a part for each study.

    The parts are in lists and not in tables, so that a narrow screen shows all of a claim.
    """
    versions = ", ".join(f"{name} {version(name)}" for name in _VERSIONS)
    rows = [
        "# What is claimed, and what was found",
        "",
        f"Quality: {quality}. Written by `crazybilliards reproduce`; "
        f"python {platform.python_version()}, {versions}.",
        "",
        _INTRODUCTION,
        "",
        *(f"* {line}" for line in summary(reproductions)),
        "",
        "| figure | verdicts |",
        "|---|---|",
    ]
    parts: list[str] = []
    for reproduction in reproductions:
        study = reproduction.study
        anchor = re.sub(r"[^\w -]", "", study.heading.lower()).replace(" ", "-")  # of Markdown
        rows.append(f"| [{study.heading}](#{anchor}) | {_counts(reproduction.claims)} |")
        parts += ["", f"## {study.heading}", ""]
        parts += [f"![{study.title}]({study.stem}.png)", "", study.caption]
        if reproduction.parameters:
            parts += ["", f"Computed: {_plain('; '.join(reproduction.parameters))}."]
        for claim in reproduction.claims:
            parts += ["", f"**{_plain(claim.statement)}**", ""]
            parts += [f"* {name}: {_plain(text)}" for name, text in claim.details.items()]
    return "\n".join([*rows, *parts, ""])


def _counts(claims: Iterable[Claim]) -> str:
    counts = Counter(claim.verdict for claim in claims)
    return ", ".join(f"{counts[name]} {name}" for name in get_args(Verdict) if counts[name])


def _plain(text: str) -> str:
    """Return text that Markdown leaves as it is: <dx> is no tag, and N_c or * no emphasis."""
    return re.sub(r"([*_|\[\]])", r"\\\1", escape(text, quote=False))


def summary(reproductions: Iterable[Reproduction]) -> list[str]:
    """Count the verdicts in a line, if there are any."""
    claims = [claim for reproduction in reproductions for claim in reproduction.claims]
    return [f"Statements of the paper: {_counts(claims)}"] if claims else []
