"""Figure 2: velocity distributions of the perfectly inelastic chain, from border to centre."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction.chains import LARGE, STEPS, at_step
from crazybilliards.reproduction.claims.repetition import Runs
from crazybilliards.reproduction.claims.study import Results, all_of
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

_RUNS = at_step(LARGE, None)  # at the default step
_AT_STEPS = {f"dt = {step:g}": at_step(LARGE, step) for step in STEPS}
_PARTICLES = (1, 10, 100, 500)
_BULK = range(1, LARGE + 1)[middle_tenth(LARGE)]
_SHOWN = 5.0  # widths of the rod to either side in the plot of its distribution
_SOURCE = "section seq:e_0, fig.1"
cases = partial(all_of, [_RUNS, *_AT_STEPS.values()])


def claims(results: Results) -> list[Claim]:
    """Check: gaussian in the bulk, skewed at the border, narrower inside."""

    def at_steps(measure: Callable[[Results, Runs], Estimate]) -> dict[str, Estimate]:
        return {step: measure(results, runs) for step, runs in _AT_STEPS.items()}

    peaks = [f"{step}: {_peak(results, runs)}" for step, runs in _AT_STEPS.items()]
    skewness = _RUNS.estimate(results, _outward_skewness)
    return [
        Claim(
            "in the bulk the distributions can be fitted by Gaussians",
            **in_plot(
                "p(v) of the middle hundred rods and the Gaussian of best height, centre and "
                f"width, both axes linear, v to {_SHOWN:g} widths",
                _off(results, _RUNS),
            ),
            source=_SOURCE,
            ours="the time step, and whether the axes are linear",
            elsewhere=at_steps(_off),
            reason="the shorter the step, the more peaked is the distribution and the longer are "
            "its tails, while the kicks of a long step, which are Gaussian, hide this; excess "
            f"kurtosis {_peak(results, _RUNS)} at the default step, {', '.join(peaks)}",
        ),
        Claim(
            "close to the border the distributions are slightly skewed",
            f"skewness of the outer three rods {skewness}, outward positive; its magnitude",
            found=_skewness(results, _RUNS),
            source=_SOURCE,
            elsewhere=at_steps(_skewness),
        ),
        Claim(
            "narrower inside than at the border",
            "W_v(border) - W_v(centre) =",
            found=_narrowing(results, _RUNS),
            source=_SOURCE,
            elsewhere=at_steps(_narrowing),
        ),
    ]


def _off(results: Results, runs: Runs) -> Estimate:
    """Return how far p(v) in the bulk is off its best Gaussian, as a share of the plot."""

    def off(run: xr.Dataset) -> float:
        width = central_width(run)
        v, p = histogram(run, _BULK, _SHOWN * width)
        return off_in_plot(v, p, fit_gaussian(v, p, width), _SHOWN * width)

    return Estimate(off(runs.pooled(results)), runs.estimate(results, off).error)


def _peak(results: Results, runs: Runs) -> Estimate:
    return runs.estimate(results, lambda run: mean_shape(run, _BULK, "velocity_kurtosis"))


def _outward_skewness(run: xr.Dataset) -> float:
    """Return that of the outer three rods; the mirror image of the left end is the right end."""
    left, right = range(1, 4), range(LARGE - 2, LARGE + 1)
    at_right, at_left = (mean_shape(run, end, "velocity_skewness") for end in (right, left))
    return (at_right - at_left) / 2


def _skewness(results: Results, runs: Runs) -> Estimate:
    found = runs.estimate(results, _outward_skewness)
    return Estimate(abs(found.value), found.error)


def _narrowing(results: Results, runs: Runs) -> Estimate:
    border, centre = (runs.estimate(results, width) for width in (border_width, central_width))
    return border.minus(centre)


def draw(results: Results) -> Figure:
    """Draw p(v) of four rods beside Gaussians of the same width."""
    return figure_of_distributions(_RUNS.members(results), _PARTICLES)
