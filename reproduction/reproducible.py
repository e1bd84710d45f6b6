"""What can be reproduced, by number or name: the figures of the paper, then a check at e = 1."""

from __future__ import annotations

import re

from crazybilliards.model.checks import meant, shown
from crazybilliards.reproduction import elastic_gaps, figures
from crazybilliards.reproduction.claims.study import Study

# The paper's section "Analytics" and what can be checked at restitution 1, where the chain is
# exactly solvable: velocities, arctanh fit, density, displacements of chains with gaps.
_ANALYTICS = ("velocities-elastic", "arctanh", "density", "elastic-gaps")


EVERYTHING: tuple[Study, ...] = (*figures.FIGURES, elastic_gaps.STUDY)


def groups() -> dict[str, tuple[Study, ...]]:
    """Return ``all`` figures of the paper, and its ``analytics``."""
    analytics = tuple(study for study in EVERYTHING if study.name in _ANALYTICS)
    return {"all": figures.FIGURES, "analytics": analytics}


def find_studies(which: str) -> list[Study]:
    """Return what numbers, names, ``all`` or ``analytics`` stand for, or raise a ValueError.

    Several are separated by commas; each study is returned once.
    """
    found = [study for name in which.split(",") for study in _find(name.strip())]
    return list(dict.fromkeys(found))


def _find(name: str) -> tuple[Study, ...]:
    if name in groups():
        return groups()[name]
    for study in EVERYTHING:
        if name in (study.name, str(study.number or study.name)):
            return (study,)
    names = [*groups(), *(study.name for study in EVERYTHING)]
    numbers = [str(study.number) for study in EVERYTHING if study.number]
    # The pictures are called fig17_density.png, say.
    figure = re.fullmatch(r"fig(?:ure|\.)?[ _-]*0*(\d+)(?:[_.].*)?", name, re.IGNORECASE)
    if figure and figure[1] in numbers:
        hint = f"; did you mean {figure[1]}?"
    else:
        labels = ", ".join([*groups(), *(study.label for study in EVERYTHING)])
        hint = meant(name, names) or f"; there are: {labels}"
    raise ValueError(f"no figure or study {shown(name)}{hint}")
