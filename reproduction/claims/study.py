"""What a study is, a figure of the paper computed anew: its cases, its picture, its claims."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.sweeps import Case
from crazybilliards.reproduction.claims.verdicts import Claim

Quality = Literal["quick", "full"]
Cases = dict[str, Case]
Results = Mapping[str, xr.Dataset]


class Needed(Protocol):
    """A part of a study that names its cases: runs of a chain, or a theory."""

    def cases(self, quality: Quality) -> Cases:
        """Return its cases by their names."""


def all_of(needed: Iterable[Needed], quality: Quality) -> Cases:
    """Return the cases of several things that a study needs."""
    return {name: case for each in needed for name, case in each.cases(quality).items()}


# They have names, so that a study can be sent to another process.
def _no_cases(quality: Quality) -> Cases:
    return {}


def _no_claims(results: Results) -> list[Claim]:
    return []


@dataclass(frozen=True, kw_only=True)
class Study:
    """A question put to simulations and theories, answered by a picture and by checked claims."""

    number: int  #: of the figure in the paper, arXiv:1404.7460, that it computes anew
    name: str  #: short, for the command line and for files
    title: str  #: one line
    caption: str  #: what a reader needs to understand the picture
    draw: Callable[[Results], Figure]  #: of the results of the cases, by the same names
    #: The simulations and theories that it needs, by names of its own.
    cases: Callable[[Quality], Cases] = _no_cases
    #: What is claimed beside what was found.
    claims: Callable[[Results], list[Claim]] = _no_claims

    @property
    def label(self) -> str:
        """What it is called in lists and tables."""
        return f"{self.number} {self.name}"

    @property
    def heading(self) -> str:
        """The heading of its part of a report."""
        return f"{self.number}. {self.title}"

    @property
    def stem(self) -> str:
        """The name of its picture without the ending."""
        return f"fig{self.number:02d}_{self.name}"

    @property
    def file_name(self) -> str:
        """The name of its picture."""
        return f"{self.stem}.png"
