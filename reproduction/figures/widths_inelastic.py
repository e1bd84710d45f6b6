"""Figures 3 and 4: velocity widths of the perfectly inelastic chain, along it and by its length."""

import itertools
import json
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import (
    COLOURS,
    draw_points,
    draw_rods,
    legend_above,
    mark_clipped,
    panels,
)
from crazybilliards.comparison.fits import Fit, fit_border_power_law
from crazybilliards.model import Chain
from crazybilliards.reproduction import chains
from crazybilliards.reproduction.claims.study import Results, Runs, Study, effort
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, around, at_choices, worst
from crazybilliards.reproduction.fits import fit_scaling
from crazybilliards.reproduction.profiles import central_width, fits_in_plot, nu

_FREE = Chain().free_velocity_width

# -- figure 3: along the chain ----------------------------------------------------------------

_SIZES = (30, 100, 300, chains.LARGE)
_STEPS = chains.inelastic(_SIZES)
_GAS = {size: chains.gas(size, 0.0) for size in _SIZES}
_SOURCE = "section seq:e_0, eq:power_law, fig.2"
_CROSS: dict[str, Any] = {"marker": "+", "linestyle": "none"}  # of the theory
_NU, _PRECISION = -0.46, 0.005  # "nu ~ -0.46": half a unit of the last digit


def _narrowing(runs: list[xr.Dataset]) -> Estimate:
    """Return 1 - W_v/W of the fastest rod of all chains."""
    widest = max(runs, key=lambda run: float(run.velocity_width.max()))
    rod = widest.isel(particle=int(widest.velocity_width.values.argmax()))
    return Estimate(1 - float(rod.velocity_width) / _FREE, float(rod.velocity_width_error) / _FREE)


def _difference_of_exponents(results: Results, group: dict[int, Runs]) -> dict[str, Any]:
    exponents = {size: runs.estimate(results, nu) for size, runs in group.items()}
    pairs = itertools.combinations(exponents.values(), 2)
    listed = ", ".join(f"{size}: {exponent}" for size, exponent in exponents.items())
    # Two numbers that are both written -0.46 differ by less than twice the precision.
    return worst(f"{listed}; difference of two", [a.minus(b) for a, b in pairs], 2 * _PRECISION)


def _claims_along(results: Results) -> list[Claim]:
    profiles = {dt: [one.mean(results) for one in group.values()] for dt, group in _STEPS.items()}
    claim = partial(Claim, source=_SOURCE, ours="the sizes below 1000 and the time step")
    return [
        claim(
            "collisions make every velocity distribution narrower than a free rod's",
            "1 - W_v/W of the fastest rod of all four chains:",
            **at_choices(profiles, _narrowing),
            source="section seq:e_0, fig.2",
        ),
        claim(
            "W_v(i) can be fitted by a sum of two power laws",
            **at_choices(profiles, partial(fits_in_plot, "four chains")),
        ),
        *(_nu_claim(results, size) for size in _SIZES),
        claim(
            "the same exponent for all L",
            **at_choices(_STEPS, partial(_difference_of_exponents, results)),
        ),
    ]


def _nu_claim(results: Results, size: int) -> Claim:
    def weighted(run: xr.Dataset) -> float:
        return fit_border_power_law(run, weighted=True).exponent

    numbers = chains.at_steps(results, _STEPS, size, nu)
    by_errors = _STEPS[chains.DEFAULT][size].estimate(results, weighted)
    numbers["elsewhere"]["rods weighed by their error bars"] = by_errors
    return Claim(
        f"nu = -0.46 at L = {size}",
        **numbers,
        within=around(_NU, _PRECISION),
        source=_SOURCE,
        ours="the time step, the weights" + (" and the size" if size < chains.LARGE else ""),
    )


def _draw_along(results: Results) -> Figure:
    figure, (widths, exponents) = panels(1, 2, height=3.2, width_ratios=(1.4, 1))
    widths.set(xscale="log", yscale="log")
    for number, (size, runs) in enumerate(_STEPS[chains.DEFAULT].items()):
        run, theory, colour = runs.mean(results), results[_GAS[size].name], COLOURS[number]
        draw_rods(
            widths,
            run,
            "velocity_width",
            number=number,
            unit=_FREE,
            along="particle",
            label=f"$L = {size}$",
        )
        i = np.geomspace(1, size, 200)
        widths.plot(i, fit_border_power_law(run)(i) / _FREE, color=colour)
        widths.plot(theory.particle, theory.velocity_width / _FREE, ":", color=colour, zorder=4)
    widths.plot([], [], color="0.4", label="fit of two power laws")
    widths.plot([], [], ":", color="0.4", label="gas")
    widths.legend(loc="lower left")
    widths.set(xlabel="particle $i$", ylabel="velocity width $W_v/W$")
    _draw_exponents(exponents, results)
    return figure


def _draw_exponents(ax: Axes, results: Results) -> None:
    """Draw nu against the time step, the theory's as crosses at the left margin."""
    margin = 2e-4
    for number, size in enumerate(_SIZES):
        exponents = sorted(
            (_time_step(group[size].members(results)[0]), *group[size].estimate(results, nu))
            for group in _STEPS.values()
        )
        draw_points(ax, *np.transpose(exponents), number=number, linewidth=0.8, linestyle="-")
        at = margin * 1.25 ** (number - 1.5)  # beside one another
        ax.plot(at, nu(results[_GAS[size].name]), **_CROSS, color=COLOURS[number])
    ax.axhline(_NU, color="0.4", linestyle="--", label="paper")
    ax.plot([], [], **_CROSS, color="0.4", label="gas")
    ax.legend(loc="upper right")
    ax.set(xscale="log", xlabel="time step $dt$ [$t_0$]", ylabel=r"exponent $\nu$")
    ax.set_xticks([margin, 1e-3, 1e-2], ["gas", "$10^{-3}$", "$10^{-2}$"])
    ax.set_xlim(0.5 * margin, 4e-2)


def _time_step(run: xr.Dataset) -> float:
    return float(json.loads(run.attrs["provenance"])["schedule"]["time_step"])


ALONG = Study(
    number=3,
    name="widths-inelastic",
    title="Velocity widths at e = 0: power laws from both borders",
    caption="(a) W_v against the rod's number, e = 0, at the default time step, with the fits a "
    "[(i - c)^nu + (L + 1 - c - i)^nu] to all rods; dotted, in (b) crosses: the gas. (b) The "
    "exponent against the time step; the leftmost symbol of each size is the default step.",
    needs=[*chains.all_of(_STEPS), *_GAS.values()],
    claims=_claims_along,
    draw=_draw_along,
)

# -- figure 4: the centre, by the length ------------------------------------------------------

_EXPONENT = -0.38  # of the paper, of the same precision
_ALL_STEPS = chains.inelastic(chains.SIZES)
# Beyond the paper: the default step would take hours there. The velocity kick of these steps is two
# thirds of the central width at both sizes, so that their error leaves the exponent alone.
_LONG = {
    size: Runs(
        f"long L={size}",
        Chain(size=size, restitution=0.0),
        runs,
        {"time_step": step, "observe": ["widths"]},
    )
    for size, step, runs in (
        (1000, 6.5e-3, effort((4, 60, 40), (4, 400, 60))),
        (10_000, 1e-3, effort((4, 5, 10), (4, 100, 60))),
    )
}


def _central_widths(results: Results, group: dict[int, Runs]) -> dict[int, Estimate]:
    return {size: runs.estimate(results, central_width) for size, runs in group.items()}


def _power_law(widths: dict[int, Estimate], least: int = 1) -> Fit:
    sizes = [size for size in widths if size >= least]
    return fit_scaling(sizes, *np.transpose([widths[size] for size in sizes]))


def _claims_by_length(results: Results) -> list[Claim]:
    widths = {name: _central_widths(results, group) for name, group in _ALL_STEPS.items()}
    fits = {name: _power_law(by_size) for name, by_size in widths.items()}
    fits["L = 30 to 1000"] = _power_law(widths[chains.DEFAULT], least=30)
    return [
        Claim(
            "W_v^min ~ L^-0.38, L = 10 to 1000",
            **at_choices(fits, lambda fit: Estimate(fit.exponent, fit.exponent_error)),
            within=around(_EXPONENT, _PRECISION),
            source="section seq:e_0, fig.3",
            ours="the least size, 10, and the time step",
            reason="-0.38 is the mean slope of L = 10 to 1000; the curve bends",
        )
    ]


def _draw_by_length(results: Results) -> Figure:
    figure, (top, bottom) = panels(2, 1, height=2.0, height_ratios=(2, 1), sharex=True)
    groups = _ALL_STEPS | {"kick 2/3 of $W_v$": _LONG}
    series = {name: _central_widths(results, group) for name, group in groups.items()}
    reference = _power_law(series[chains.DEFAULT])
    for number, (label, widths) in enumerate(series.items()):
        sizes = np.array(list(widths))
        values, errors = np.transpose(list(widths.values()))
        draw_points(top, sizes, values / _FREE, errors / _FREE, label=label, number=number)
        fit = reference(sizes)
        draw_points(bottom, sizes, values / fit, errors / fit, number=number)
    ends = np.array([8, 2e4])
    paper = ends**_EXPONENT * reference(100.0) / 100.0**_EXPONENT
    # On top they are one line to the eye; below, each is told from the other.
    for line, label, dashes, colour in (
        (reference(ends), f"$L^{{{reference.exponent:.3f}}}$", "-", "0.4"),
        (paper, f"paper: $L^{{{_EXPONENT}}}$", "--", "black"),
    ):
        top.plot(ends, line / _FREE, dashes, color=colour, label=label)
        bottom.plot(ends, line / reference(ends), dashes, color=colour)
    top.set(xscale="log", yscale="log", ylabel="central width $W_v^{\\min}/W$")
    bottom.set(xlabel="number of rods $L$", ylabel="ratio to the fit", ylim=(0.75, 1.15))
    mark_clipped(bottom)
    legend_above(figure, top)
    return figure


BY_LENGTH = Study(
    number=4,
    name="central-width",
    title="The central width against the size at e = 0",
    caption="Root mean square velocity of the middle tenth of the rods, e = 0. Grey line: a fit to "
    "the default time step, L = 10 to 1000. Dashed: the paper's exponent. (b) The ratio to the "
    "fit. Longer chains than the paper's are at time steps whose velocity kick is two thirds of "
    "the width at every size.",
    needs=[*chains.all_of(_ALL_STEPS), *_LONG.values()],
    claims=_claims_by_length,
    draw=_draw_by_length,
)
