"""Figure 11: velocity distributions of strongly damped flippers: the centre is the widest."""

from __future__ import annotations

from functools import partial

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.reproduction.chains import OTHER_STEP, at_other_step, flippers
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim
from crazybilliards.reproduction.distributions import figure_of_distributions
from crazybilliards.reproduction.figures.fig10_velocities_flippers import PARTICLES, SIZE

TITLE = "Velocity distributions at e = 1.05, gamma = 10"
CAPTION = (
    "L = 100, e = 1.05, gamma = 10. Symbols: simulation. Lines: Gaussians of the same width. "
    "Dotted: a free rod. Error bars: standard errors from independent runs."
)

_RUNS = flippers(SIZE, 10.0)
_AGAIN = at_other_step(_RUNS)
cases = partial(all_of, [_RUNS, _AGAIN])


def claims(results: Results) -> list[Claim]:
    """Check: the centre is the widest."""

    def widening(run: xr.Dataset) -> float:
        return central_width(run) - border_width(run)

    return [
        Claim(
            "large velocities are likelier in the centre than at the border",
            "W_v(centre) - W_v(border) =",
            found=_RUNS.estimate(results, widening),
            source="section Anti-Dissipation, fig:mom_hist_antidiss_gamma10",
            elsewhere={f"dt = {OTHER_STEP:g}": _AGAIN.estimate(results, widening)},
        )
    ]


def draw(results: Results) -> Figure:
    """Draw p(v) of three rods."""
    return figure_of_distributions(_RUNS.members(results), PARTICLES)
