"""Figure 3: velocity widths along the perfectly inelastic chain, power laws from both borders."""

from __future__ import annotations

import json

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.claims.repetition import estimate, pooled
from crazybilliards.comparison.claims.study import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.claims.verdicts import Claim, Estimate, number_claim, same_claim
from crazybilliards.comparison.drawing import COLOURS, SYMBOLS, draw_rods
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.paper.chains import LARGE
from crazybilliards.comparison.paper.time_steps import STEPS, at_steps, step_name
from crazybilliards.model import chain_of

_SIZES = (30, 100, 300, LARGE)
_OFFSET_SIZE = 300
_PAPER, _PRECISION = -0.46, 0.015


def cases(quality: Quality) -> Cases:
    """E = 0, four sizes, four time steps."""
    return at_steps(quality, _SIZES)


def exponent(results: Results, size: int, step: float | None = None) -> Estimate:
    """Return nu, from the scatter between independent runs."""
    return estimate(results, step_name(size, step), _exponent)


def _exponent(run: xr.Dataset) -> float:
    return fit_border_power_law(run).exponent


def _exponent_with_offset(run: xr.Dataset) -> float:
    return fit_border_power_law(run, offset=True).exponent


def claims(results: Results) -> list[Claim]:
    """Check: nu is -0.46, the same for all L."""
    found = {size: exponent(results, size) for size in _SIZES}
    largest = STEPS[0]
    at_large_step = exponent(results, LARGE, largest)
    weights = [1 / each.error**2 for each in found.values()]
    mean = float(np.average([each.value for each in found.values()], weights=weights))
    deviation = max(abs(each.value - mean) / each.error for each in found.values())
    reason = (
        f"the power law holds for short chains only approximately, and the time step matters: "
        f"L = {LARGE} gives {at_large_step} at dt = {largest:g}"
    )
    return [
        *(
            number_claim(f"nu = -0.46 at L = {size}", _PAPER, _PRECISION, each, reason=reason)
            for size, each in found.items()
        ),
        number_claim(
            f"(beyond the paper) with a constant added to the two power laws, L = {_OFFSET_SIZE}",
            _PAPER,
            _PRECISION,
            estimate(results, step_name(_OFFSET_SIZE, None), _exponent_with_offset),
            reason="a constant and a power law are hard to tell apart: nu is no robust number",
        ),
        same_claim(
            "the same exponent for all L",
            ", ".join(f"{size}: {each}" for size, each in found.items()),
            deviation,
            reason="nu drifts with L: there is more than one power law in the profile",
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
    "B [i^nu + (L + 1 - i)^nu] (L/30 rods at each border left out). Right: the exponent against "
    "the time step; the leftmost point of each size is the default step.",
    cases=cases,
    draw=draw,
    claims=claims,
)
