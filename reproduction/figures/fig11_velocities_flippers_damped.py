"""Figure 11: velocity distributions of strongly damped flippers: the centre is the widest."""

from __future__ import annotations

from matplotlib.figure import Figure

from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.reproduction.chains import flippers
from crazybilliards.reproduction.claims.study import Results
from crazybilliards.reproduction.claims.verdicts import Claim
from crazybilliards.reproduction.distributions import figure_of_distributions
from crazybilliards.reproduction.figures.fig10_velocities_flippers import PARTICLES, SIZE

TITLE = "Velocity distributions at e = 1.05, gamma = 10"
CAPTION = (
    "L = 100, e = 1.05, gamma = 10. Symbols: simulation. Lines: Gaussians of the same width. "
    "Dotted: a free rod. Error bars: standard errors from independent runs."
)

_RUNS = flippers(SIZE, 10.0)
cases = _RUNS.cases


def claims(results: Results) -> list[Claim]:
    """Check: the centre is the widest."""
    centre = _RUNS.estimate(results, central_width)
    return [
        Claim(
            "large velocities are likelier in the centre than at the border",
            "W_v(centre) - W_v(border) =",
            found=centre.minus(_RUNS.estimate(results, border_width)),
            source="section Anti-Dissipation, fig:mom_hist_antidiss_gamma10",
        )
    ]


def draw(results: Results) -> Figure:
    """Draw p(v) of three rods."""
    return figure_of_distributions(_RUNS.members(results), PARTICLES)
