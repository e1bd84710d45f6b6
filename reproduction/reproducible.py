"""What can be reproduced, by number or name: the figures of the paper, then studies beyond it."""

from __future__ import annotations

from crazybilliards.reproduction import figures
from crazybilliards.reproduction.beyond import STUDIES
from crazybilliards.reproduction.claims.study import PaperFigure, Study


def groups() -> dict[str, tuple[Study, ...]]:
    """Return ``all`` figures of the paper, and the ``studies`` beyond it."""
    return {"all": figures.FIGURES, "studies": STUDIES}


def find_studies(which: str) -> list[Study]:
    """Return what a number, a name, ``all`` or ``studies`` stands for.

    Raises
    ------
    ValueError
        If there is nothing of that number or name.
    """
    if which in groups():
        return list(groups()[which])
    everything = [study for group in groups().values() for study in group]
    for study in everything:
        number = str(study.number) if isinstance(study, PaperFigure) else None
        if which in (study.name, number):
            return [study]
    names = ", ".join([*groups(), *(study.label for study in everything)])
    raise ValueError(f"no figure or study {which!r}; there are: {names}")
