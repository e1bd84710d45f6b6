"""What can be reproduced, by number or name: the figures of the paper, then a check at e = 1."""

from __future__ import annotations

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
    """Return what a number, a name, ``all`` or ``analytics`` stands for, or raise a ValueError."""
    if which in groups():
        return list(groups()[which])
    for study in EVERYTHING:
        if which in (study.name, str(study.number or study.name)):
            return [study]
    names = ", ".join([*groups(), *(study.label for study in EVERYTHING)])
    raise ValueError(f"no figure or study {which!r}; there are: {names}")
