"""What a figure of the paper is here: its cases, its picture, its claims."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.verdicts import Claim
from crazybilliards.comparison.sweeps import Case

Quality = Literal["quick", "full"]
Cases = dict[str, Case]
Results = Mapping[str, xr.Dataset]


def no_cases(quality: Quality) -> Cases:
    """Nothing to compute."""
    return {}


def no_claims(results: Results) -> list[Claim]:
    """Nothing claimed."""
    return []


@dataclass(frozen=True, kw_only=True)
class PaperFigure:
    """A figure of arXiv:1404.7460, computed anew.

    Attributes
    ----------
    number, name
        Its number in the paper, and a short name for the command line and for files.
    title, caption
        What it shows: one line, and what a reader needs to understand the picture.
    cases
        ``cases(quality)`` gives the simulations and theories it needs, by names of its own.
    draw
        ``draw(results)`` gives the picture, results being those of the cases by the same names.
    claims
        ``claims(results)`` sets what the paper says beside what was found.
    """

    number: int
    name: str
    title: str
    caption: str
    draw: Callable[[Results], Figure]
    cases: Callable[[Quality], Cases] = no_cases
    claims: Callable[[Results], list[Claim]] = no_claims
