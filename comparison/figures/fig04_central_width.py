"""Figure 4: the smallest velocity width against the size of the perfectly inelastic chain."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.figures.claims import Claim, Estimate, number_claim, small_claim
from crazybilliards.comparison.figures.figure import Cases, PaperFigure, Quality, Results
from crazybilliards.comparison.figures.runs import centre_width, estimate, runs
from crazybilliards.comparison.figures.time_steps import STEPS, at_steps, step_name
from crazybilliards.comparison.fits import ScalingFit, fit_scaling
from crazybilliards.model import Chain

_PAPER, _PRECISION = -0.38, 0.015
# Beyond the paper: size, time step, duration of each of two runs. At these sizes the default step
# would take hours; the error that the step causes is drawn.
_BEYOND = {
    "quick": ((10_000, 3e-3, 20.0),),
    "full": ((10_000, 1e-3, 100.0), (10_000, 1e-4, 40.0), (100_000, 1e-3, 20.0)),
}
_BEYOND_WARMUP = {"quick": 40.0, "full": 60.0}


def cases(quality: Quality) -> Cases:
    """E = 0, L = 10 to 1000 at four time steps; longer chains at one or two."""
    cases = at_steps(quality)
    for size, step, duration in _BEYOND[quality]:
        cases |= runs(
            step_name(size, step),
            Chain(size=size, restitution=0.0),
            2,
            duration=duration,
            warmup=_BEYOND_WARMUP[quality],
            time_step=step,
            observe=["widths"],
        )
    return cases


def _widths(results: Results, step: float | None) -> dict[int, Estimate]:
    """W_v in the centre of all sizes that were simulated at this step."""
    sizes = sorted({run.sizes["particle"] for run in results.values()})
    names = {size: step_name(size, step) for size in sizes}
    return {
        size: estimate(results, name, centre_width)
        for size, name in names.items()
        if f"{name}/0" in results
    }


def _fit(widths: dict[int, Estimate], least: int = 1, most: int = 10**9) -> ScalingFit:
    chosen = {size: each for size, each in widths.items() if least <= size <= most}
    values, errors = zip(*chosen.values(), strict=True)
    return fit_scaling(list(chosen), values, errors)


def claims(results: Results) -> list[Claim]:
    """Check: the exponent is -0.38."""
    widths = _widths(results, None)
    fit = _fit(widths)
    parts = _fit(widths, most=100), _fit(widths, least=100)
    local = [Estimate(part.exponent, part.exponent_error) for part in parts]
    coarse = _fit(_widths(results, STEPS[0]), least=100, most=1000)
    change = local[1].minus(local[0])
    return [
        number_claim(
            "W_v^min ~ L^-0.38, L = 10 to 1000",
            _PAPER,
            _PRECISION,
            Estimate(fit.exponent, fit.exponent_error),
            reason=f"the exponent depends on the sizes: {local[0]} for L up to 100, {local[1]} "
            f"from 100 to 1000 (at dt = {STEPS[0]:g}: {coarse.exponent:.3f})",
        ),
        small_claim(
            "one power law over all sizes",
            "exponent above L = 100 less that below:",
            change,
            0.02,
            reason="the double-logarithmic curve bends: -0.38 is a mean slope",
        ),
    ]


def draw(results: Results) -> Figure:
    """Draw W_v in the centre against L for every time step."""
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(5.4, 5.4), layout="constrained", height_ratios=(2, 1), sharex=True
    )
    unit = Chain().free_velocity_width
    fixed = sorted({*STEPS, *(step for _, step, _ in (*_BEYOND["quick"], *_BEYOND["full"]))})
    reference = _fit(_widths(results, None))
    for number, step in enumerate((None, *reversed(fixed))):
        widths = _widths(results, step)
        if not widths:
            continue
        sizes = np.array(list(widths))
        values, errors = np.array(list(widths.values())).T
        style = {
            "fmt": SYMBOLS[number % len(SYMBOLS)],
            "color": COLOURS[number % len(COLOURS)],
            "markerfacecolor": "none",
            "markersize": 5,
        }
        label = "default step" if step is None else f"dt = {step:g}"
        top.errorbar(sizes, values / unit, errors / unit, label=label, **style)
        bottom.errorbar(sizes, values / reference(sizes), errors / reference(sizes), **style)
    ends = np.array([8, 2e5])
    line = {"color": "0.4", "linewidth": 1}
    top.plot(ends, reference(ends) / unit, label=f"$L^{{{reference.exponent:.3f}}}$", **line)
    paper = ends**_PAPER * reference(100.0) / 100.0**_PAPER
    top.plot(ends, paper / unit, "--", label=f"paper: $L^{{{_PAPER}}}$", **line)
    bottom.axhline(1, **line)
    top.set(xscale="log", yscale="log", ylabel="central width $W_v^{\\min}/W$")
    bottom.set(xlabel="number of rods L", ylabel="ratio to the line", ylim=(0.6, 1.6))
    top.legend(frameon=False, fontsize=8)
    return figure


FIGURE = PaperFigure(
    number=4,
    name="central-width",
    title="The central width against the size at e = 0",
    caption="Root mean square velocity of the middle tenth of the rods, e = 0. The line is a fit "
    "to the default time step, L = 10 to 1000; below, the ratio to it. The paper ends at L = 1000.",
    cases=cases,
    draw=draw,
    claims=claims,
)
