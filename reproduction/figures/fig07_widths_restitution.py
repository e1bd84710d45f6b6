"""Figure 7: velocity widths for several restitutions, and the exponent against the restitution."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_points, draw_rods
from crazybilliards.comparison.fits import Fit
from crazybilliards.comparison.layout import legend_above, mosaic
from crazybilliards.comparison.widths import central_width
from crazybilliards.reproduction.chains import (
    LARGE,
    OTHER_STEP,
    RESTITUTIONS,
    at_other_step,
    dissipative,
    elastic,
)
from crazybilliards.reproduction.claims.repetition import Runs
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, in_plot, worst
from crazybilliards.reproduction.figures.fig12_widths_damping import bulge
from crazybilliards.reproduction.fits import fit_exponential
from crazybilliards.reproduction.power_laws import fits_in_plot, nu
from crazybilliards.reproduction.predictions import CROSSES, LINES, by_restitution, predicted

TITLE = "Velocity widths for several restitutions"
CAPTION = (
    "(a) W_v against the normalized particle number, L = 1000 (e = 1: L = 100). Lines: the kinetic "
    "equation in the colour of its e, dashed without pair correlations, full with them; nothing of "
    "the simulation goes into these lines. (b) The exponent of the two power laws against the "
    "restitution, and a exp(-lambda (1 - e)) + d fitted to it. (c) W_v in the centre."
)

_RUNS = {e: dissipative(LARGE, e) for e in RESTITUTIONS}
_AGAIN = {e: at_other_step(runs) for e, runs in _RUNS.items()}
_THERE = f"dt = {OTHER_STEP:g}"
_ELASTIC_SIZE = 100
_PRECISION = 0.005  # of exponents: the paper gives them with two decimals
_SOURCE = "section seq:e_larger, fig.4"
_OPEN: dict[str, Any] = {"number": 0, "color": "black"}
_OURS = "the restitutions (those of fig.5, and 0.5) and the time step"


def cases(quality: Quality) -> Cases:
    """L = 1000 at six restitutions, L = 100 at e = 1; theories."""
    return (
        all_of([*_RUNS.values(), *_AGAIN.values()], quality)
        | by_restitution(quality)
        | all_of([elastic(_ELASTIC_SIZE)], quality)
    )


def _exponents(results: Results, every: Mapping[float, Runs] = _RUNS) -> dict[float, Estimate]:
    return {e: -runs.estimate(results, nu) for e, runs in every.items()}


def _fit(found: dict[float, Estimate]) -> Fit:
    values, errors = zip(*found.values(), strict=True)
    return fit_exponential(list(found), values, errors)


def claims(results: Results) -> list[Claim]:
    """Check: flatter for larger e, two power laws, and the exponent's exponential."""
    low, high = RESTITUTIONS[0], RESTITUTIONS[-1]
    uneven, again = (
        {e: every[e].estimate(results, bulge) for e in (low, high)} for every in (_RUNS, _AGAIN)
    )
    fits, fits_again = (
        fits_in_plot(runs.pooled(results) for runs in every.values()) for every in (_RUNS, _AGAIN)
    )
    return [
        Claim(
            "the larger e, the less the width varies along the chain",
            f"ln of the border's width over the centre's: {uneven[low]} at e = {low:g} and "
            f"{uneven[high]} at e = {high:g}, difference",
            found=uneven[low].minus(uneven[high]),
            source=_SOURCE,
            ours=_OURS,
            elsewhere={_THERE: again[low].minus(again[high])},
        ),
        Claim(
            "W_v(i) is described by a sum of two power laws at every e < 1",
            **in_plot(
                "six restitutions, rods averaged with their mirror images, and their fits, both "
                "axes logarithmic",
                *fits,
            ),
            source=f"{_SOURCE}, eq:power_law",
            ours=_OURS,
            elsewhere={_THERE: fits_again[0]},
            reason="the two power laws leave systematic residuals",
        ),
        _exponential_claim(results),
    ]


def _exponential_claim(results: Results) -> Claim:
    found = _exponents(results)
    fit = _fit(found)
    amplitude = Estimate(fit.amplitude, fit.amplitude_error)
    exponents = ", ".join(f"{e:g}: {each}" for e, each in found.items())
    again = worst("", _residuals(_exponents(results, _AGAIN)), _PRECISION)
    return Claim(
        "-nu depends on e like exp(-lambda (1 - e)) + d, lambda unknown",
        **worst(
            f"with an amplitude a before it lambda = {Estimate(fit.rate, fit.rate_error)}, "
            f"a = {amplitude}, d = {Estimate(fit.offset, fit.offset_error)}; "
            f"-nu by e: {exponents}; -nu less the curve",
            _residuals(found),
            _PRECISION,
        ),
        source=f"{_SOURCE}, inset",
        ours=_OURS,
        elsewhere={_THERE: again["found"]},
        reason="the errors of the exponents are about as large as the limit",
    )


def _residuals(found: dict[float, Estimate]) -> list[Estimate]:
    fit = _fit(found)
    return [Estimate(each.value - float(fit(e)), each.error) for e, each in found.items()]


def draw(results: Results) -> Figure:
    """Draw W_v(i) with the kinetic equation, -nu against e with its fit."""
    figure, axes = mosaic(
        [["widths", "exponents"], ["widths", "centre"]], height=3.9, width_ratios=(1.4, 1)
    )
    left = axes["widths"]
    left.set(ylabel="velocity width $W_v/W$", yscale="log")
    for number, (e, runs) in enumerate((_RUNS | {1.0: elastic(_ELASTIC_SIZE)}).items()):
        run = runs.pooled(results)
        unit = runs.chain.free_velocity_width
        label = f"$e = {e:g}$" + (f", $L = {_ELASTIC_SIZE}$" if e == 1 else "")
        draw_rods(left, run, "velocity_width", number=number, unit=unit, label=label)
        _draw_theories(left, results, e, unit, COLOURS[number])
    along_the_chain(left)
    for theory, of_theory in predicted(results).items():
        solved = rf"{theory}, $e \geq {min(of_theory):g}$"
        left.plot([], [], LINES[theory], color="0.4", label=solved)
    legend_above(figure, left)
    axes["exponents"].sharex(axes["centre"])
    _draw_exponents(axes["exponents"], results)
    _draw_centre(axes["centre"], results)
    return figure


def _draw_theories(ax: Axes, results: Results, e: float, unit: float, colour: str) -> None:
    for theory, of_theory in predicted(results).items():
        if e in of_theory:
            # Above the symbols: one of them passes over those of another restitution.
            ax.plot(
                of_theory[e].normalized_particle,
                of_theory[e].velocity_width / unit,
                LINES[theory],
                color=colour,
                path_effects=[withStroke(linewidth=1.9, foreground="white")],
                zorder=4,
            )


def _draw_centre(ax: Axes, results: Results) -> None:
    unit = _RUNS[0.0].chain.free_velocity_width
    widths = [runs.estimate(results, central_width) for runs in _RUNS.values()]
    values, errors = np.transpose(widths) / unit
    draw_points(ax, list(_RUNS), values, errors, label="simulation", **_OPEN)
    for theory, of_theory in predicted(results).items():
        centres = [central_width(each) / unit for each in of_theory.values()]
        ax.plot(list(of_theory), centres, **CROSSES[theory], label=theory)
    ax.set(xlabel="restitution $e$", ylabel="central width $W_v^{\\min}/W$")
    ax.legend()


def _draw_exponents(ax: Axes, results: Results) -> None:
    found = _exponents(results)
    fit = _fit(found)
    values, errors = np.array(list(found.values())).T
    draw_points(ax, list(found), values, errors, label="simulation", **_OPEN)
    for theory, of_theory in predicted(results).items():
        exponents = [-nu(each) for each in of_theory.values()]
        ax.plot(list(of_theory), exponents, **CROSSES[theory], label=theory)
    fine = np.linspace(0, 1, 101)
    ax.plot(fine, fit(fine), "0.4", label=rf"fit, $\lambda = {fit.rate:.1f}$")
    ax.set(ylabel=r"exponent $-\nu$")
    ax.tick_params(labelbottom=False)
    ax.legend()
