"""Figure 2: velocity distributions of the perfectly inelastic chain, from border to centre."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model import chain_of
from crazybilliards.model.chain import middle_tenth
from crazybilliards.reproduction.chains import LARGE, dissipative, dissipative_name
from crazybilliards.reproduction.claims.repetition import estimate, members, pooled
from crazybilliards.reproduction.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, eye_claim, positive_claim
from crazybilliards.reproduction.distributions import (
    draw_distributions,
    fit_gaussian,
    histogram,
    mean_shape,
    off_in_plot,
)

_NAME = dissipative_name(LARGE, 0.0)
_PARTICLES = (1, 10, 100, 500)
_BULK = range(1, LARGE + 1)[middle_tenth(LARGE)]
_SHOWN = 5.0  # widths of the rod to either side in the plot of its distribution
_SOURCE = "section seq:e_0, fig.1"


def cases(quality: Quality) -> Cases:
    """L = 1000, e = 0."""
    return dissipative(LARGE, 0.0, quality)


def claims(results: Results) -> list[Claim]:
    """Check: gaussian in the bulk, skewed at the border, narrower inside."""

    def both_ends(run: xr.Dataset) -> float:
        # Outward is positive: the mirror image of the left end is the right end.
        left, right = range(1, 4), range(LARGE - 2, LARGE + 1)
        right_skewness, left_skewness = (
            mean_shape(run, end, "velocity_skewness") for end in (right, left)
        )
        return (right_skewness - left_skewness) / 2

    skewness = estimate(results, _NAME, both_ends)
    kurtosis = estimate(results, _NAME, lambda run: mean_shape(run, _BULK, "velocity_kurtosis"))
    border = estimate(results, _NAME, border_width)
    return [
        eye_claim(
            "in the bulk the distributions can be fitted by Gaussians",
            "p(v) of the middle hundred rods and the Gaussian of best height, centre and width, "
            f"both axes linear, v to {_SHOWN:g} widths",
            Estimate(_off(pooled(results, _NAME)), estimate(results, _NAME, _off).error),
            abs(kurtosis.value) / kurtosis.error,
            source=_SOURCE,
            ours="the time step, and whether the axes are linear",
            reason="the distribution is more peaked than a Gaussian, with longer tails",
            exactly=f"no Gaussian: the excess kurtosis is {kurtosis}. It is a mixture: a rod that "
            "has room is up to twice as fast as one in a crowd, and among rods with equal room the "
            "excess is about a third of that",
        ),
        positive_claim(
            "close to the border the distributions are slightly skewed",
            f"skewness of the outer three rods {skewness}, outward positive; its magnitude",
            Estimate(abs(skewness.value), skewness.error),
            source=_SOURCE,
        ),
        positive_claim(
            "narrower inside than at the border",
            "W_v(border) - W_v(centre) =",
            border.minus(estimate(results, _NAME, central_width)),
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
    runs = members(results, _NAME)
    figure, [ax] = panels(1, 1, height=2.9, wanted=1)
    draw_distributions(ax, runs, _PARTICLES, chain_of(runs[0]).free_velocity_width)
    legend_above(figure, ax)
    return figure


FIGURE = PaperFigure(
    number=2,
    name="velocities-inelastic",
    title="Velocity distributions at e = 0",
    caption="L = 1000, e = 0. Symbols: simulation, rods i from the border to the centre. Lines: "
    "Gaussians of the same width. Dotted: a free rod. Error bars: standard errors from independent "
    "runs. Velocities in units of the free width W.",
    cases=cases,
    draw=draw,
    claims=claims,
)
