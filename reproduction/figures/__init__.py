"""The figures of arXiv:1404.7460, one module for each kind of figure."""

from crazybilliards.reproduction.claims.study import Study
from crazybilliards.reproduction.figures import (
    amplitude_and_gap,
    avalanches,
    displacements,
    elastic,
    energy,
    model,
    velocities,
    widths_flippers,
    widths_inelastic,
    widths_restitution,
)

FIGURES: tuple[Study, ...] = (
    model.MODEL,
    velocities.INELASTIC,
    widths_inelastic.ALONG,
    widths_inelastic.BY_LENGTH,
    displacements.BY_LENGTH,
    avalanches.INELASTIC,
    widths_restitution.RESTITUTION,
    elastic.VELOCITIES,
    displacements.BY_RESTITUTION,
    velocities.WEAKLY_DAMPED,
    velocities.STRONGLY_DAMPED,
    widths_flippers.BY_DAMPING,
    avalanches.FLIPPERS,
    widths_flippers.BY_LENGTH,
    energy.ENERGY,
    elastic.ARCTANH,
    elastic.DENSITY,
    amplitude_and_gap.AMPLITUDE,
    amplitude_and_gap.GAP,
)
# The paper's section "Analytics" and what can be checked at restitution 1, where the chain is
# exactly solvable: velocities, arctanh fit, elastic.
ANALYTICS = tuple(FIGURES[number - 1] for number in (8, 16, 17))


def find_figures(which: str) -> list[Study]:
    """Return, each once, what numbers, names, ``all`` or ``analytics``, with commas, stand for."""
    known = {"all": FIGURES, "analytics": ANALYTICS}
    known |= {key: (figure,) for figure in FIGURES for key in (str(figure.number), figure.name)}
    figures: dict[Study, None] = {}
    for name in map(str.strip, which.split(",")):
        if name not in known:
            listed = ", ".join(f"{figure.number} {figure.name}" for figure in FIGURES)
            raise ValueError(f"no figure {name!r}; there are: all, analytics, {listed}")
        figures |= dict.fromkeys(known[name])
    return list(figures)
