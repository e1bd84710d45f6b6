"""Figure 2: velocity distributions of the perfectly inelastic chain, from border to centre."""

from __future__ import annotations

import matplotlib.pyplot as plt
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.repetition import (
    border_width,
    central_width,
    estimate,
    pooled,
)
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, Estimate, positive_claim, small_claim
from crazybilliards.comparison.paper.chains import LARGE, dissipative, dissipative_name
from crazybilliards.comparison.paper.distributions import draw_distributions, moment
from crazybilliards.model import chain_of

_NAME = dissipative_name(LARGE, 0.0)
_PARTICLES = (1, 10, 100, 500)
_BULK = range(451, 551)
_GAUSSIAN = 0.1  # excess kurtosis that nobody would see in the picture


def cases(quality: Quality) -> Cases:
    """L = 1000, e = 0."""
    return dissipative(LARGE, 0.0, quality)


def claims(results: Results) -> list[Claim]:
    """Check: gaussian in the bulk, skewed at the border, narrower inside."""

    def both_ends(run: xr.Dataset) -> float:
        # Outward is positive: the mirror image of the left end is the right end.
        left, right = range(1, 4), range(LARGE - 2, LARGE + 1)
        return (moment(run, right, 3) - moment(run, left, 3)) / 2

    skewness = estimate(results, _NAME, both_ends)
    kurtosis = estimate(results, _NAME, lambda run: moment(run, _BULK, 4) - 3)
    border = estimate(results, _NAME, border_width)
    return [
        small_claim(
            "Gaussian in the bulk",
            "excess kurtosis of the middle hundred rods",
            kurtosis,
            _GAUSSIAN,
            reason="a mixture of Gaussians: a rod that has room is up to twice as fast as one in a "
            "crowd; among rods with equal room the excess is about a third of that",
        ),
        positive_claim(
            "skewed near the border",
            f"skewness of the outer three rods {skewness}, outward positive; its magnitude",
            Estimate(abs(skewness.value), skewness.error),
        ),
        positive_claim(
            "narrower inside than at the border",
            "W_v(border) - W_v(centre) =",
            border.minus(estimate(results, _NAME, central_width)),
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw p(v) of four rods beside Gaussians of the same width."""
    run = pooled(results, _NAME)
    figure, ax = plt.subplots(figsize=(5.2, 3.8), layout="constrained")
    draw_distributions(ax, run, _PARTICLES, chain_of(run).free_velocity_width)
    return figure


FIGURE = PaperFigure(
    number=2,
    name="velocities-inelastic",
    title="Velocity distributions at e = 0",
    caption="L = 1000, e = 0. Symbols: simulation, rods i from the border to the centre. Lines: "
    "Gaussians of the same width. Dotted: a free rod. Velocities in units of the free width W.",
    cases=cases,
    draw=draw,
    claims=claims,
)
