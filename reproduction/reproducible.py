"""What can be reproduced, by number or name: the figures of the paper, then studies beyond it."""

from __future__ import annotations

from crazybilliards.reproduction import figures
from crazybilliards.reproduction.beyond import STUDIES
from crazybilliards.reproduction.claims.study import PaperFigure, Study

# The paper's section "Analytics" and what can be checked at restitution 1, where the chain is
# exactly solvable: velocities, arctanh fit, density, displacements of chains with gaps.
_ANALYTICS = ("velocities-elastic", "arctanh", "density", "elastic-gaps")


def groups() -> dict[str, tuple[Study, ...]]:
    """Return ``all`` figures of the paper, the ``studies`` beyond it, and the ``analytics``."""
    everything = (*figures.FIGURES, *STUDIES)
    analytics = tuple(study for study in everything if study.name in _ANALYTICS)
    return {"all": figures.FIGURES, "studies": STUDIES, "analytics": analytics}


def find_studies(which: str) -> list[Study]:
    """Return what a number, a name, ``all``, ``studies`` or ``analytics`` stands for.

    Raises
    ------
    ValueError
        If there is nothing of that number or name.
    """
    if which in groups():
        return list(groups()[which])
    everything = [*groups()["all"], *groups()["studies"]]
    for study in everything:
        number = str(study.number) if isinstance(study, PaperFigure) else None
        if which in (study.name, number):
            return [study]
    names = ", ".join([*groups(), *(study.label for study in everything)])
    raise ValueError(f"no figure or study {which!r}; there are: {names}")
