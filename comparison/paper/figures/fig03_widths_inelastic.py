"""Figure 3: velocity widths along the perfectly inelastic chain, power laws from both borders."""

from __future__ import annotations

import json
from collections.abc import Iterable

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.repetition import estimate, pooled
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import (
    Claim,
    Estimate,
    eye_claim,
    number_claim,
    positive_claim,
    same_claim,
)
from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import COLOURS, SYMBOLS, draw_rods
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.paper.chains import LARGE
from crazybilliards.comparison.paper.time_steps import STEPS, at_steps, step_name
from crazybilliards.model import chain_of

_SIZES = (30, 100, 300, LARGE)
_PAPER, _PRECISION = -0.46, 0.015
_ERROR = "velocity_width_error"
_SOURCE = "section seq:e_0, eq:power_law, fig.2"


def cases(quality: Quality) -> Cases:
    """E = 0, four sizes, four time steps."""
    return at_steps(quality, _SIZES)


def exponent(results: Results, size: int, step: float | None = None) -> Estimate:
    """Return nu, from the scatter between independent runs."""
    return estimate(results, step_name(size, step), _exponent)


def _exponent(run: xr.Dataset) -> float:
    return fit_border_power_law(run).exponent


def _origin(run: xr.Dataset) -> float:
    return fit_border_power_law(run).origin


def _gained_without_c(run: xr.Dataset) -> float:
    return fit_border_power_law(run, shifted=False).exponent - _exponent(run)


def _lost_with_weights(run: xr.Dataset) -> float:
    return _exponent(run) - fit_border_power_law(run, weighted=True).exponent


def claims(results: Results) -> list[Claim]:
    """Check: two power laws fit, nu is -0.46, the same for all L; and what changes nu."""
    runs = {size: pooled(results, step_name(size, None)) for size in _SIZES}
    found = {size: exponent(results, size) for size in _SIZES}
    weights = [1 / each.error**2 for each in found.values()]
    mean = float(np.average([each.value for each in found.values()], weights=weights))
    deviation = max(abs(each.value - mean) / each.error for each in found.values())
    free = chain_of(runs[_SIZES[0]]).free_velocity_width
    widest = max(runs.values(), key=lambda run: float(run.velocity_width.max()))
    at = int(widest.velocity_width.values.argmax())
    border = Estimate(*(float(widest[n][at]) / free for n in ("velocity_width", _ERROR)))
    return [
        positive_claim(
            "collisions make every velocity distribution narrower than a free rod's",
            "1 - W_v/W of the fastest rod of all four chains:",
            Estimate(1 - border.value, border.error),
            source="section seq:e_0, fig.2",
            ours="the sizes below 1000 and the time step",
        ),
        _fit_claim(runs),
        *(
            number_claim(
                f"nu = -0.46 at L = {size}",
                _PAPER,
                _PRECISION,
                each,
                source=_SOURCE,
                ours="the time step" + (" and the size" if size < LARGE else ""),
            )
            for size, each in found.items()
        ),
        same_claim(
            "the same exponent for all L",
            ", ".join(f"{size}: {each}" for size, each in found.items()),
            deviation,
            source=_SOURCE,
            ours="the sizes below 1000 and the time step",
        ),
        *_own_claims(results),
    ]


def _fit_claim(runs: dict[int, xr.Dataset]) -> Claim:
    worst, significance = fits_in_plot(runs.values())
    return eye_claim(
        "W_v(i) can be fitted by a sum of two power laws",
        "four chains and their fits, both axes logarithmic",
        worst,
        significance,
        source=_SOURCE,
        ours="the sizes below 1000 and the time step",
        exactly="the profile is no sum of two power laws: the residuals are systematic, so that nu "
        "depends on how the rods are weighed, and c on the size (see below)",
    )


def fits_in_plot(runs: Iterable[xr.Dataset]) -> tuple[Estimate, float]:
    """Compare the fits with the widths in a plot of all runs, both axes logarithmic.

    Returns the largest deviation as a share of the plotted range, which ends at the free rod's
    width, and the largest one in standard errors.
    """
    runs = list(runs)
    free = np.log(chain_of(runs[0]).free_velocity_width)
    lowest = np.log(min(float(run.velocity_width.min()) for run in runs))
    longest = np.log(max(run.sizes["particle"] for run in runs))
    worst, significance = Estimate(0.0, 0.0), 0.0
    for run in runs:
        fit = fit_border_power_law(run)
        i, width, error = run.particle.values, run.velocity_width.values, run[_ERROR].values
        fine = np.geomspace(1, i[-1], 2000)
        off = distances_in_plot(
            np.log(i),
            np.log(width),
            np.log(fine),
            np.log(fit(fine)),
            x_range=(0.0, longest),
            y_range=(lowest, free),
        )
        at = int(off.argmax())
        if off[at] > worst.value:
            worst = Estimate(float(off[at]), float(error[at] / width[at] / (free - lowest)))
        significance = max(significance, float(np.abs((fit(i) - width) / error).max()))
    return worst, significance


def _own_claims(results: Results) -> list[Claim]:
    """Check what the exponent depends on."""
    largest = STEPS[0]
    coarse, fine = (exponent(results, LARGE, step) for step in (largest, STEPS[-1]))
    middle = 300
    origins = {size: estimate(results, step_name(size, None), _origin) for size in _SIZES}
    listed = ", ".join(f"{size}: {each}" for size, each in origins.items())
    return [
        positive_claim(
            f"without c the exponent is flatter, L = {middle}",
            "nu without c less nu with it:",
            estimate(results, step_name(middle, None), _gained_without_c),
        ),
        positive_claim(
            f"weighing the rods by their error bars makes it steeper, L = {middle}",
            "nu from ordinary least squares less nu from weighted ones:",
            estimate(results, step_name(middle, None), _lost_with_weights),
        ),
        positive_claim(
            "the longer the chain, the further out the power laws begin",
            f"c by L: {listed}; c at 100 less c at {LARGE}:",
            origins[100].minus(origins[LARGE]),
        ),
        positive_claim(
            f"a long time step makes the exponent of L = {LARGE} flatter",
            f"nu = {coarse} at dt = {largest:g} and {fine} at dt = {STEPS[-1]:g}, difference",
            coarse.minus(fine),
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw W_v(i) with its fits, and nu against the time step."""
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(9.2, 3.9), layout="constrained", width_ratios=(1.5, 1)
    )
    for number, size in enumerate(_SIZES):
        run = pooled(results, step_name(size, None))
        unit = chain_of(run).free_velocity_width
        draw_rods(
            left,
            run,
            "velocity_width",
            number=number,
            unit=unit,
            along="particle",
            label=f"L = {size}",
        )
        half = np.geomspace(1, size, 200)
        left.plot(half, fit_border_power_law(run)(half) / unit, color=COLOURS[number], linewidth=1)
    left.set(xscale="log", yscale="log", xlabel="particle i", ylabel="velocity width $W_v/W$")
    left.legend(frameon=False, title="symbols: simulation\nlines: fits of two power laws")
    _draw_steps(right, results)
    return figure


def _draw_steps(ax: Axes, results: Results) -> None:
    for number, size in enumerate(_SIZES):
        steps = [chain_step(results, size), *reversed(STEPS)]
        each = [exponent(results, size, step) for step in (None, *reversed(STEPS))]
        order = np.argsort(steps)
        ax.errorbar(
            np.array(steps)[order],
            [each[k].value for k in order],
            [each[k].error for k in order],
            fmt=f"-{SYMBOLS[number]}",
            color=COLOURS[number],
            markerfacecolor="none",
            markersize=4,
            linewidth=0.8,
        )
    ax.axhline(_PAPER, color="0.4", linestyle="--", linewidth=1)
    ax.text(STEPS[0], _PAPER, " paper", va="bottom", ha="right", color="0.3", fontsize=8)
    ax.set(xscale="log", xlabel="time step dt [T]", ylabel=r"exponent $\nu$")


def chain_step(results: Results, size: int) -> float:
    """Return the default time step of that size, as the result records it."""
    run = results[f"{step_name(size, None)}/0"]
    return float(json.loads(run.attrs["provenance"])["schedule"]["time_step"])


FIGURE = PaperFigure(
    number=3,
    name="widths-inelastic",
    title="Velocity widths at e = 0: power laws from both borders",
    caption="Left: W_v against the rod's number, e = 0, at the default time step, with the fits "
    "a [(i - c)^nu + (L + 1 - c - i)^nu] to all rods. Right: the exponent against the time step; "
    "the leftmost point of each size is the default step.",
    cases=cases,
    draw=draw,
    claims=claims,
)
