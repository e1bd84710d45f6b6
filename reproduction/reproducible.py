"""What can be reproduced, by number, name or group: the figures of the paper."""

from __future__ import annotations

import re

from crazybilliards.model.checks import shown
from crazybilliards.model.words import meant
from crazybilliards.reproduction.claims.study import Study
from crazybilliards.reproduction.figures import FIGURES

# The paper's section "Analytics" and what can be checked at restitution 1, where the chain is
# exactly solvable: velocities, arctanh fit, density.
_ANALYTICS = ("velocities-elastic", "arctanh", "density")
GROUPS: dict[str, tuple[Study, ...]] = {
    "all": FIGURES,
    "analytics": tuple(figure for figure in FIGURES if figure.name in _ANALYTICS),
}


def find_studies(which: str) -> list[Study]:
    """Return what numbers, names, ``all`` or ``analytics`` stand for, or raise a ValueError.

    Several are separated by commas; each figure is returned once.
    """
    found = [figure for name in which.split(",") for figure in _find(name.strip())]
    return list(dict.fromkeys(found))


def _find(name: str) -> tuple[Study, ...]:
    if name in GROUPS:
        return GROUPS[name]
    by_name = {key: each for each in FIGURES for key in (str(each.number), each.name)}
    if name in by_name:
        return (by_name[name],)
    # The pictures are called fig17_density.png, say.
    figure = re.fullmatch(r"fig(?:ure|\.)?[ _-]*0*(\d+)(?:[_.].*)?", name, re.IGNORECASE)
    if figure and figure[1] in by_name:
        hint = f"; did you mean {figure[1]}?"
    else:
        labels = ", ".join([*GROUPS, *(each.label for each in FIGURES)])
        names = [*GROUPS, *(each.name for each in FIGURES)]
        hint = meant(name, names) or f"; there are: {labels}"
    raise ValueError(f"no figure {shown(name)}{hint}")
