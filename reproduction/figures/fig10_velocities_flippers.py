"""Figure 10: velocity distributions of weakly damped flippers: the border is the widest."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypedDict

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.reproduction.chains import OTHER_STEP, at_other_step, flippers
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate
from crazybilliards.reproduction.distributions import draw_distributions, mean_shape
from crazybilliards.reproduction.fits import tail_length

TITLE = "Velocity distributions at e = 1.05, gamma = 4"
CAPTION = (
    "L = 100, e = 1.05, gamma = 4. Symbols: simulation. Lines: Gaussians of the same width. "
    "Dashed: an exponential of the border's mean excess over three widths. Dotted: a free rod. "
    "Error bars: standard errors from independent runs."
)

SIZE = 100
PARTICLES = (1, 10, 50)
_RUNS = flippers(SIZE, 4.0)
_AGAIN = at_other_step(_RUNS)
_THERE = f"dt = {OTHER_STEP:g}"
_UNIT = _RUNS.chain.free_velocity_width
_SOURCE = "section Anti-Dissipation, fig:mom_hist_antidiss_gamma4"
_TAIL = 3.0  # widths of the rod, where the tail begins
cases = partial(all_of, [_RUNS, _AGAIN])


class _Both(TypedDict):
    """A number at the default time step and at another one."""

    found: Estimate
    elsewhere: dict[str, Estimate]


def claims(results: Results) -> list[Claim]:
    """Check: the border is the widest and has an exponential tail."""

    def less(number: float, quantity: Callable[[xr.Dataset], float]) -> _Both:
        one, other = (each.estimate(results, quantity) for each in (_RUNS, _AGAIN))
        least = Estimate(number, 0.0)
        return {"found": one.minus(least), "elsewhere": {_THERE: other.minus(least)}}

    kurtosis = _RUNS.estimate(results, lambda run: mean_shape(run, (1, SIZE), "velocity_kurtosis"))
    ratio = _RUNS.estimate(results, _tail_ratio)
    return [
        Claim(
            "every rod is faster than a free one",
            "W_v/W of the slowest rod less 1:",
            **less(1.0, lambda run: float(run.velocity_width.min()) / _UNIT),
            source=_SOURCE,
        ),
        Claim(
            "large velocities are likelier at the border than in the centre",
            "W_v(border) - W_v(centre) =",
            **less(0.0, lambda run: border_width(run) - central_width(run)),
            source=_SOURCE,
        ),
        Claim(
            "the tail at the border falls off exponentially",
            f"excess kurtosis {kurtosis}; length of the tail beyond 5 W_v over that beyond 3 W_v "
            f"{ratio} (exponential: 1, Gaussian: 0.65), less half-way between the two",
            **less(0.825, _tail_ratio),
            source=f"{_SOURCE}, inset",
            reason="the tail falls off faster than an exponential",
        ),
    ]


def _density(run: xr.Dataset) -> xr.DataArray:
    """Return p(v) of the leftmost rod, averaged with the mirror image of the rightmost."""
    p = run.velocity_density
    return (p.sel(particle=1) + p.sel(particle=SIZE).values[::-1]) / 2


def _tail_ratio(run: xr.Dataset) -> float:
    """Length of the border's outward tail far out over that nearer by: 1 if exponential."""
    outward = run.velocity_bin.values < 0
    v, p = run.velocity_bin.values[outward], _density(run).values[outward]
    width = border_width(run)
    return tail_length(v, p, 5 * width) / tail_length(v, p, _TAIL * width)


def draw(results: Results) -> Figure:
    """Draw p(v) of three rods, with an exponential tail at the border."""
    run = _RUNS.pooled(results)
    figure, [ax] = panels(1, 1, height=2.9)
    draw_distributions(ax, _RUNS.members(results), PARTICLES)
    # The leftmost rod is thrown to the left.
    v, p = (each.values[run.velocity_bin.values < 0] for each in (run.velocity_bin, _density(run)))
    begin = _TAIL * border_width(run)
    length = tail_length(v, p, begin)
    share = float((p * np.gradient(v))[v < -begin].sum())
    out = np.linspace(begin, begin + 7 * length, 50)
    tail = share / length * np.exp(-(out - begin) / length)
    ax.plot(-out / _UNIT, tail * _UNIT, "--", color="0.3", label="exponential tail")
    legend_above(figure, ax)
    return figure
