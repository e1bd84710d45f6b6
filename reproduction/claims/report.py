"""Studies carried out: pictures drawn from stored cases, claims checked, a report of all of it."""

from __future__ import annotations

import base64
import io
import platform
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cache, partial
from html import escape, unescape
from importlib.metadata import version
from pathlib import Path
from typing import get_args

import xarray as xr
from markdown_it import MarkdownIt

from crazybilliards.comparison.layout import house_style
from crazybilliards.comparison.sweeps import Case
from crazybilliards.reproduction.claims.study import Quality, Results, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Verdict

_HEAD = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Crazy 1d billiards, reproduced</title>
<style>
  body { font: 16px/1.5 system-ui, sans-serif; color: #222; overflow-wrap: break-word; }
  body { max-width: 44rem; margin: 2rem auto; padding: 0 1rem; }
  img { max-width: 100%; height: auto; }
</style>
</head>
<body>
"""
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
class Reproduced:
    """A study, drawn from its results, and what became of its claims."""

    study: Study
    pictures: dict[str, bytes]  # the picture as a file, by format: PNG always, others as asked for
    claims: list[Claim]  # checked
    parameters: list[str]  # what was computed, a line for each kind of case


def all_cases(studies: Iterable[Study], quality: Quality) -> list[Case]:
    """Return the cases that the studies need, each once."""
    return list(dict.fromkeys(case for study in studies for case in study.cases(quality).values()))


def reproduce(
    studies: Iterable[Study],
    quality: Quality,
    folder: Path,
    *,
    formats: Collection[str] = (),
    executor: Executor | None = None,
) -> Iterator[Reproduced]:
    """Draw studies and check their claims, in their order, from the cases in ``folder``.

    ``formats``: file formats of matplotlib, besides PNG. ``executor``: in whose processes it is
    done; None: in this one.
    """
    draw = partial(_reproduced, quality=quality, folder=folder, formats=("png", *formats))
    try:
        yield from (map if executor is None else executor.map)(draw, studies)
    finally:
        _loaded.cache_clear()  # the folder may hold other results next time


def _reproduced(
    study: Study, quality: Quality, folder: Path, formats: Collection[str]
) -> Reproduced:
    cases = study.cases(quality)
    results = {name: _loaded(case, folder) for name, case in cases.items()}
    with house_style():
        pictures = _drawn(study, results, formats)
    return Reproduced(study, pictures, study.claims(results), describe(cases.values()))


@cache
def _loaded(case: Case, folder: Path) -> xr.Dataset:
    """Load a result once, because many studies share cases."""
    return case.load(folder)


def _drawn(study: Study, results: Results, formats: Iterable[str]) -> dict[str, bytes]:
    drawn = study.draw(results)
    pictures = {}
    for kind in formats:
        picture = io.BytesIO()
        # The same picture is to give the same file, whenever it is drawn.
        drawn.savefig(picture, format=kind, metadata=_NO_DATE.get(kind))
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


def markdown(reproduced: list[Reproduced], quality: Quality) -> str:
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
        *(f"* {line}" for line in summary(reproduced)),
        "",
        "| figure | verdicts |",
        "|---|---|",
    ]
    for each in reproduced:
        heading = each.study.heading
        rows.append(f"| [{heading}](#{_anchor(heading)}) | {_counted(each.claims)} |")
    for each in reproduced:
        study = each.study
        rows += ["", f"## {study.heading}", ""]
        rows += [f"![{study.title}]({study.file_name})", "", study.caption]
        if each.parameters:
            rows += ["", f"Computed: {_plain('; '.join(each.parameters))}."]
        for claim in each.claims:
            rows += ["", f"**{_plain(claim.statement)}**", ""]
            rows += [f"* {name}: {_plain(text)}" for name, text in claim.details.items()]
    return "\n".join(rows) + "\n"


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


def html(reproduced: list[Reproduced], quality: Quality) -> str:
    """Return :func:`markdown` as one page, with the pictures in it."""
    page = MarkdownIt("commonmark").enable("table").render(markdown(reproduced, quality))
    page = re.sub(
        "<h2>(.*?)</h2>",
        lambda found: f'<h2 id="{_anchor(unescape(found[1]))}">{found[1]}</h2>',
        page,
    )
    for each in reproduced:
        embedded = base64.b64encode(each.pictures["png"]).decode()
        named = f'src="{each.study.file_name}"'
        page = page.replace(named, f'src="data:image/png;base64,{embedded}"')
    return f"{_HEAD}{page}</body>\n</html>\n"


def summary(reproduced: list[Reproduced]) -> list[str]:
    """Count the verdicts in a line, if there are any."""
    claims = [claim for each in reproduced for claim in each.claims]
    return [f"Statements of the paper: {_counted(claims)}"] if claims else []
