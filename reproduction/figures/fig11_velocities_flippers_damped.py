"""Figure 11: velocity distributions of strongly damped flippers: the centre is the widest."""

from __future__ import annotations

from matplotlib.figure import Figure

from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model import chain_of
from crazybilliards.reproduction.chains import flippers, flippers_name
from crazybilliards.reproduction.claims.repetition import estimate, members
from crazybilliards.reproduction.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Claim, positive_claim
from crazybilliards.reproduction.distributions import draw_distributions
from crazybilliards.reproduction.figures.fig10_velocities_flippers import PARTICLES, SIZE

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
    runs = members(results, flippers_name(SIZE, _DAMPING))
    figure, [ax] = panels(1, 1, height=2.9, wanted=1)
    draw_distributions(ax, runs, PARTICLES, chain_of(runs[0]).free_velocity_width)
    legend_above(figure, ax)
    return figure


FIGURE = PaperFigure(
    number=11,
    name="velocities-flippers-damped",
    title="Velocity distributions at e = 1.05, gamma = 10",
    caption="L = 100, e = 1.05, gamma = 10. Symbols: simulation. Lines: Gaussians of the same "
    "width. Dotted: a free rod. Error bars: standard errors from independent runs.",
    cases=cases,
    draw=draw,
    claims=claims,
)
