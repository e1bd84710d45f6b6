"""Figure 11: velocity distributions of strongly damped flippers: the centre is the widest."""

from __future__ import annotations

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.repetition import (
    border_width,
    central_width,
    estimate,
    pooled,
)
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, positive_claim
from crazybilliards.comparison.paper.chains import flippers, flippers_name
from crazybilliards.comparison.paper.distributions import draw_distributions
from crazybilliards.comparison.paper.figures.fig10_velocities_flippers import PARTICLES, SIZE
from crazybilliards.model import chain_of

_DAMPING = 10.0


def cases(quality: Quality) -> Cases:
    """L = 100, e = 1.05, gamma = 10."""
    return flippers(SIZE, _DAMPING, quality)


def claims(results: Results) -> list[Claim]:
    """Check: the centre is the widest."""
    name = flippers_name(SIZE, _DAMPING)
    centre = estimate(results, name, central_width)
    return [
        positive_claim(
            "large velocities are likelier in the centre than at the border",
            "W_v(centre) - W_v(border) =",
            centre.minus(estimate(results, name, border_width)),
            source="section Anti-Dissipation, fig:mom_hist_antidiss_gamma10",
        )
    ]


def draw(results: Results) -> Figure:
    """Draw p(v) of three rods."""
    run = pooled(results, flippers_name(SIZE, _DAMPING))
    figure, ax = plt.subplots(figsize=(5.2, 3.8), layout="constrained")
    draw_distributions(ax, run, PARTICLES, chain_of(run).free_velocity_width)
    return figure


FIGURE = PaperFigure(
    number=11,
    name="velocities-flippers-damped",
    title="Velocity distributions at e = 1.05, gamma = 10",
    caption="L = 100, e = 1.05, gamma = 10. Symbols: simulation. Lines: Gaussians of the same "
    "width. Dotted: a free rod.",
    cases=cases,
    draw=draw,
    claims=claims,
)
