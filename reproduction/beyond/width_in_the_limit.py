"""Is W_v in the centre a power of L as dt -> 0? Chains at e = 0, in the limit of a vanishing step.

One limit for every length. Those of up to 1000 rods are the first of the five of figure 4.
"""

from __future__ import annotations

import json
import math

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import draw_points
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.layout import panels
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.tables import Tables
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim

_LEAST_RODS, _MOST_RODS = 30, 3000  # of the fits along the chain
_ACCURACY = {
    "quick": dict.fromkeys((10, 30, 100, 300), 0.02),
    "full": dict.fromkeys((10, 30, 100, 300, 1000, 3000), 0.005) | {10_000: 0.01},
}
_APART = 2  # places in the list of lengths between the ends of a slope


def cases(quality: Quality) -> Cases:
    """E = 0, L = 10 to 10 000: the limits."""
    return {
        f"L={size}": Case(
            "simulate_limit",
            Chain(size=size, restitution=0.0),
            {"accuracy": accuracy, "observe": ["widths"], "seed": 0},
        )
        for size, accuracy in _ACCURACY[quality].items()
    }


def _sizes(results: Results) -> dict[int, Estimate]:
    """Return W_v in the centre by length."""
    return {
        chain_of(limit).size: Estimate(
            limit.central_velocity_width.item(), limit.central_velocity_width_error.item()
        )
        for limit in results.values()
    }


def _slopes(widths: dict[int, Estimate]) -> dict[tuple[int, int], Estimate]:
    """Return the slope of ln W_v over ln L from each length to the next but one."""
    lengths = list(widths)
    found = {}
    for ends in zip(lengths, lengths[_APART:], strict=False):
        one, other = (widths[size] for size in ends)
        span = math.log(ends[1] / ends[0])
        error = math.hypot(one.error / one.value, other.error / other.value)
        found[ends] = Estimate(math.log(other.value / one.value) / span, error / span)
    return found


def _row(limit: xr.Dataset) -> list[str]:
    levels = json.loads(limit.attrs["provenance"])["levels"]
    width, error = limit.central_velocity_width.item(), limit.central_velocity_width_error.item()
    return [
        f"{chain_of(limit).size}",
        f"{width:.6f} ± {error:.6f}",
        f"{error / width:.2%}",
        f"{limit.attrs['time_step_error']:.2%}",
        ", ".join(f"{level['time_step']:.2g}" for level in levels),
        f"{sum(level['rod_steps'] for level in levels):.1e}",
    ]


def tables(results: Results) -> Tables:
    """Give W_v in the centre with the cost of its limit, slopes, and fits along the chain."""
    slopes = [
        [f"{one} → {other}", f"{slope.value:.4f} ± {slope.error:.4f}"]
        for (one, other), slope in _slopes(_sizes(results)).items()
    ]
    fits = [
        (chain_of(limit).size, fit_border_power_law(limit))
        for limit in results.values()
        if _LEAST_RODS <= chain_of(limit).size <= _MOST_RODS
    ]
    exponents = [
        [f"{size}", f"{fit.exponent:.4f} ± {fit.exponent_error:.4f}", f"{fit.origin:.2f}"]
        for size, fit in fits
    ]
    heads = ["L", "$W_v$, centre", "error", "bias", "steps", "rod-steps"]
    return {
        "central_width": [heads, *map(_row, results.values())],
        "central_slopes_of_limits": [["L", "slope"], *slopes],
        "profile_exponent_of_limits": [["L", r"$\nu$", "$c$"], *exponents],
    }


def claims(results: Results) -> list[Claim]:
    """Check: the slope steepens with L, so W_v is no power."""
    slopes = list(_slopes(_sizes(results)).values())
    return [
        positive_claim(
            "W_v in the centre is no power of L: it falls more steeply in long chains",
            "slope of short chains less that of long ones",
            slopes[0].minus(slopes[-1]),
            in_limit=True,
        )
    ]


def draw(results: Results) -> Figure:
    """Draw W_v in the centre against L, and its slopes."""
    widths = _sizes(results)
    slopes = _slopes(widths)
    figure, axes = panels(1, 2, height=2.4)
    draw_points(axes[0], list(widths), *np.transpose(list(widths.values())), number=0)
    axes[0].set(yscale="log", ylabel="$W_v$, centre [$R$ per unit of time]")
    middles = [math.sqrt(one * other) for one, other in slopes]
    values, errors = np.transpose(list(slopes.values()))
    ends = np.abs(np.transpose(list(slopes)) - np.array(middles))
    draw_points(axes[1], middles, values, errors, number=0, xerr=ends)
    axes[1].axhline(-0.38, color="0.6", linewidth=0.8, zorder=0)
    axes[1].set(ylabel=r"slope of $\ln W_v$ over $\ln L$")
    for ax in axes:
        ax.set(xscale="log", xlabel="rods $L$")
    return figure


STUDY = Study(
    name="width-in-the-limit",
    title="The width in the centre against the length, e = 0, dt -> 0",
    caption="(a) W_v in the centre of perfectly inelastic chains (e = 0, A = gamma = k = 1), in "
    "the limit of a vanishing time step. (b) Slope of its logarithm between the ends of the "
    "horizontal bars; the line is the paper's exponent. Bars: standard errors, which contain the "
    "remaining error of the time step.",
    cases=cases,
    draw=draw,
    claims=claims,
    tables=tables,
)
