"""Figure 2: velocity distributions of the perfectly inelastic chain, from border to centre."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction.chains import LARGE, dissipative
from crazybilliards.reproduction.claims.study import Results
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, in_plot
from crazybilliards.reproduction.distributions import (
    figure_of_distributions,
    fit_gaussian,
    histogram,
    mean_shape,
    off_in_plot,
)

TITLE = "Velocity distributions at e = 0"
CAPTION = (
    "L = 1000, e = 0. Symbols: simulation, rods i from the border to the centre. Lines: Gaussians "
    "of the same width. Dotted: a free rod. Error bars: standard errors from independent runs. "
    "Velocities in units of the free width W."
)

_RUNS = dissipative(LARGE, 0.0)
_PARTICLES = (1, 10, 100, 500)
_BULK = range(1, LARGE + 1)[middle_tenth(LARGE)]
_SHOWN = 5.0  # widths of the rod to either side in the plot of its distribution
_SOURCE = "section seq:e_0, fig.1"
cases = _RUNS.cases


def claims(results: Results) -> list[Claim]:
    """Check: gaussian in the bulk, skewed at the border, narrower inside."""

    def both_ends(run: xr.Dataset) -> float:
        # Outward is positive: the mirror image of the left end is the right end.
        left, right = range(1, 4), range(LARGE - 2, LARGE + 1)
        right_skewness, left_skewness = (
            mean_shape(run, end, "velocity_skewness") for end in (right, left)
        )
        return (right_skewness - left_skewness) / 2

    skewness = _RUNS.estimate(results, both_ends)
    border = _RUNS.estimate(results, border_width)
    return [
        Claim(
            "in the bulk the distributions can be fitted by Gaussians",
            **in_plot(
                "p(v) of the middle hundred rods and the Gaussian of best height, centre and "
                f"width, both axes linear, v to {_SHOWN:g} widths",
                Estimate(_off(_RUNS.pooled(results)), _RUNS.estimate(results, _off).error),
            ),
            source=_SOURCE,
            ours="the time step, and whether the axes are linear",
            reason="the distribution is more peaked than a Gaussian, with longer tails",
        ),
        Claim(
            "close to the border the distributions are slightly skewed",
            f"skewness of the outer three rods {skewness}, outward positive; its magnitude",
            found=Estimate(abs(skewness.value), skewness.error),
            source=_SOURCE,
        ),
        Claim(
            "narrower inside than at the border",
            "W_v(border) - W_v(centre) =",
            found=border.minus(_RUNS.estimate(results, central_width)),
            source=_SOURCE,
        ),
    ]


def _off(run: xr.Dataset) -> float:
    """Return how far p(v) in the bulk is off its best Gaussian, as a share of the plot."""
    width = central_width(run)
    v, p = histogram(run, _BULK, _SHOWN * width)
    return off_in_plot(v, p, fit_gaussian(v, p, width), _SHOWN * width)


def draw(results: Results) -> Figure:
    """Draw p(v) of four rods beside Gaussians of the same width."""
    return figure_of_distributions(_RUNS.members(results), _PARTICLES)
