"""Figure 4: the smallest velocity width against the size of the perfectly inelastic chain."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import draw_points, mark_clipped
from crazybilliards.comparison.fits import Fit
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.widths import central_width
from crazybilliards.model import Chain
from crazybilliards.reproduction.chains import SIZES, STEPS, at_step, at_steps
from crazybilliards.reproduction.claims.repetition import Granted, Runs
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, around
from crazybilliards.reproduction.fits import fit_scaling

TITLE = "The central width against the size at e = 0"
CAPTION = (
    "Root mean square velocity of the middle tenth of the rods, e = 0. Grey line: a fit to the "
    "default time step, L = 10 to 1000. Dashed: the paper's exponent. (b) The ratio to the fit. "
    "Longer chains than the paper's are at time steps whose velocity kick is two thirds of the "
    "width at every size."
)

_PAPER, _PRECISION = -0.38, 0.005  # "with exponent -0.38": half a unit of the last digit
# Beyond the paper: the default step would take hours there. These steps are in the ratio of the
# widths squared, so that the velocity kick of a step is two thirds of the central width at every
# size: the error of the step is then the same for all, and leaves the exponent alone.
_LONG_STEPS = {1000: 6.5e-3, 10_000: 1e-3}
_GRANTED: dict[int, Granted] = {
    1000: {
        "quick": (4, {"duration": 60.0, "warmup": 40.0}),
        "full": (4, {"duration": 400.0, "warmup": 60.0}),
    },
    10_000: {
        "quick": (4, {"duration": 5.0, "warmup": 10.0}),
        "full": (4, {"duration": 100.0, "warmup": 60.0}),
    },
}
_LONG = [
    Runs(
        f"long L={size}",
        Chain(size=size, restitution=0.0),
        granted,
        {"time_step": _LONG_STEPS[size], "observe": ["widths"]},
    )
    for size, granted in _GRANTED.items()
]
cases = partial(all_of, [*at_steps(), *_LONG])


def _widths(results: Results, every: Iterable[Runs]) -> dict[int, Estimate]:
    """W_v in the centre by size."""
    return {runs.chain.size: runs.estimate(results, central_width) for runs in every}


def _at_step(step: float | None) -> list[Runs]:
    return [at_step(size, step) for size in SIZES]


def _fit(widths: dict[int, Estimate], least: int = 1) -> Fit:
    chosen = {size: each for size, each in widths.items() if least <= size}
    values, errors = zip(*chosen.values(), strict=True)
    return fit_scaling(list(chosen), values, errors)


def claims(results: Results) -> list[Claim]:
    """Check: the exponent is -0.38, for all sizes and time steps."""
    default = _widths(results, _at_step(None))
    others = {f"dt = {step:g}": _fit(_widths(results, _at_step(step))) for step in STEPS}
    others["L = 30 to 1000"] = _fit(default, least=30)
    return [
        Claim(
            "W_v^min ~ L^-0.38, L = 10 to 1000",
            found=_exponent(_fit(default)),
            within=around(_PAPER, _PRECISION),
            source="section seq:e_0, fig.3",
            ours="the least size, 10, and the time step",
            elsewhere={name: _exponent(fit) for name, fit in others.items()},
            reason="-0.38 is the mean slope of L = 10 to 1000; the curve bends",
        )
    ]


def _exponent(fit: Fit) -> Estimate:
    return Estimate(fit.exponent, fit.exponent_error)


def draw(results: Results) -> Figure:
    """Draw W_v in the centre against L for every time step."""
    figure, (top, bottom) = panels(2, 1, height=2.0, height_ratios=(2, 1), sharex=True)
    unit = Chain().free_velocity_width
    reference = _fit(_widths(results, _at_step(None)))
    series = {"default step": _widths(results, _at_step(None))}
    series |= {f"$dt = {step:g}$": _widths(results, _at_step(step)) for step in STEPS}
    series["kick 2/3 of $W_v$"] = _widths(results, _LONG)
    for number, (label, widths) in enumerate(series.items()):
        sizes = np.array(list(widths))
        values, errors = np.array(list(widths.values())).T
        look: Any = {"number": number}
        draw_points(top, sizes, values / unit, errors / unit, label=label, **look)
        draw_points(bottom, sizes, values / reference(sizes), errors / reference(sizes), **look)
    ends = np.array([8, 2e4])
    paper = ends**_PAPER * reference(100.0) / 100.0**_PAPER
    # On top they are one line to the eye; below, each is told from the other.
    for line, label, colour, dashes in (
        (reference(ends), f"$L^{{{reference.exponent:.3f}}}$", "0.4", "-"),
        (paper, f"paper: $L^{{{_PAPER}}}$", "black", "--"),
    ):
        top.plot(ends, line / unit, dashes, color=colour, label=label)
        bottom.plot(ends, line / reference(ends), dashes, color=colour)
    top.set(xscale="log", yscale="log", ylabel="central width $W_v^{\\min}/W$")
    bottom.set(xlabel="number of rods $L$", ylabel="ratio to the fit", ylim=(0.75, 1.15))
    mark_clipped(bottom)
    legend_above(figure, top)
    return figure
