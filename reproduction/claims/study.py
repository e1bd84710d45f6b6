"""What a study is, a figure of the paper computed anew: its cases, its picture, its claims."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from crazybilliards.comparison.sweeps import Case
from crazybilliards.reproduction.claims.repetition import Quality, Results, Runs, Solution
from crazybilliards.reproduction.claims.verdicts import Claim


@dataclass(frozen=True, kw_only=True, eq=False)
class Study:
    """A question put to simulations and theories, answered by a picture and by checked claims."""

    number: int  #: of the figure in the paper, arXiv:1404.7460, that it computes anew
    name: str  #: short, for the command line and for files
    title: str  #: one line
    caption: str  #: what a reader needs to understand the picture
    needs: Sequence[Runs | Solution] = ()  #: the simulations and theories
    draw: Callable[[Results], Figure]  #: the picture, from the results of all cases by their names
    claims: Callable[[Results], list[Claim]] | None = None  #: beside what was found

    def cases(self, quality: Quality) -> dict[str, Case]:
        """Return the cases of all that it needs, by their names."""
        return {name: case for need in self.needs for name, case in need.cases(quality).items()}

    @property
    def heading(self) -> str:
        """The heading of its part of the page."""
        return f"{self.number}. {self.title}"

    @property
    def stem(self) -> str:
        """The name of its picture without the ending."""
        return f"fig{self.number:02d}_{self.name}"
