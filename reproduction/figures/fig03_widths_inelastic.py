"""Figure 3: velocity widths along the perfectly inelastic chain, power laws from both borders."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points, draw_rods
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.layout import panels
from crazybilliards.reproduction.chains import (
    LARGE,
    STEPS,
    at_step,
    at_steps,
    chain_step,
    correlated_equation,
)
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, all_of
from crazybilliards.reproduction.claims.verdicts import (
    Claim,
    Estimate,
    Found,
    around,
    in_plot,
    worst,
)
from crazybilliards.reproduction.power_laws import fits_in_plot, nu
from crazybilliards.reproduction.predictions import CROSSES, PAIRS

TITLE = "Velocity widths at e = 0: power laws from both borders"
CAPTION = (
    "(a) W_v against the rod's number, e = 0, at the default time step, with the fits a [(i - "
    "c)^nu + (L + 1 - c - i)^nu] to all rods; dotted, in (b) crosses: the kinetic equation with "
    "pair correlations. (b) The exponent against the time step; the leftmost symbol of each size "
    "is the default step."
)

_SIZES = (30, 100, 300, LARGE)
_SOLVED = {"quick": (30,), "full": _SIZES}  # by the theory with pair correlations
_RUNS = {size: at_step(size, None) for size in _SIZES}  # at the default step
_CROSS, _PAIRS = CROSSES[PAIRS], "theory with pairs"
_PAPER, _PRECISION = -0.46, 0.005  # "nu ~ -0.46": half a unit of the last digit
_SAME = 2 * _PRECISION  # two numbers that are both written -0.46 differ by less
_ERROR = "velocity_width_error"
_SOURCE = "section seq:e_0, eq:power_law, fig.2"
_OURS = "the sizes below 1000 and the time step"


def cases(quality: Quality) -> Cases:
    """E = 0, four sizes, four time steps; the theory with pair correlations."""
    theories = [correlated_equation(size, 0.0) for size in _SOLVED[quality]]
    return all_of([*at_steps(_SIZES), *theories], quality)


def _predicted(results: Results) -> dict[int, xr.Dataset]:
    """Return the results of the theory."""
    names = {size: correlated_equation(size, 0.0).name for size in _SIZES}
    return {size: results[name] for size, name in names.items() if name in results}


def exponent(results: Results, size: int, step: float | None = None) -> Estimate:
    """Return nu, from the scatter between independent runs."""
    return at_step(size, step).estimate(results, nu)


def claims(results: Results) -> list[Claim]:
    """Check: two power laws fit, nu is -0.46, the same for all L."""
    exponents = {
        step: {size: exponent(results, size, step) for size in _SIZES} for step in (None, *STEPS)
    }
    fits = {step: fits_in_plot(_pooled(results, step)) for step in (None, *STEPS)}
    same = {step: _same_exponent(found) for step, found in exponents.items()}
    return [
        Claim(
            "collisions make every velocity distribution narrower than a free rod's",
            "1 - W_v/W of the fastest rod of all four chains:",
            found=_narrower(_pooled(results)),
            source="section seq:e_0, fig.2",
            ours=_OURS,
            elsewhere={f"dt = {step:g}": _narrower(_pooled(results, step)) for step in STEPS},
        ),
        Claim(
            "W_v(i) can be fitted by a sum of two power laws",
            **in_plot(
                "four chains, rods averaged with their mirror images, and their fits, both axes "
                "logarithmic",
                *fits[None],
            ),
            source=_SOURCE,
            ours=_OURS,
            elsewhere={f"dt = {step:g}": fits[step][0] for step in STEPS},
        ),
        *(
            Claim(
                f"nu = -0.46 at L = {size}",
                found=each,
                within=around(_PAPER, _PRECISION),
                source=_SOURCE,
                ours="the time step, the weights" + (" and the size" if size < LARGE else ""),
                elsewhere={
                    **{f"dt = {step:g}": exponents[step][size] for step in STEPS},
                    "rods weighed by their error bars": _RUNS[size].estimate(results, _weighted_nu),
                },
            )
            for size, each in exponents[None].items()
        ),
        Claim(
            "the same exponent for all L",
            **same[None],
            source=_SOURCE,
            ours=_OURS,
            elsewhere={f"dt = {step:g}": same[step]["found"] for step in STEPS},
        ),
    ]


def _pooled(results: Results, step: float | None = None) -> list[xr.Dataset]:
    """Return the four chains at a time step; None: the default one."""
    return [at_step(size, step).pooled(results) for size in _SIZES]


def _narrower(runs: list[xr.Dataset]) -> Estimate:
    """Return 1 - W_v/W of the fastest rod of all chains."""
    widest = max(runs, key=lambda run: float(run.velocity_width.max()))
    at = int(widest.velocity_width.values.argmax())
    free = _RUNS[LARGE].chain.free_velocity_width
    width, error = (float(widest[name][at]) / free for name in ("velocity_width", _ERROR))
    return Estimate(1 - width, error)


def _same_exponent(found: dict[int, Estimate]) -> Found:
    """Return what decides whether the exponents of two chains differ."""
    pairs = itertools.combinations(found.values(), 2)
    listed = ", ".join(f"{size}: {each}" for size, each in found.items())
    return worst(f"{listed}; difference of two", [one.minus(two) for one, two in pairs], _SAME)


def _weighted_nu(run: xr.Dataset) -> float:
    return fit_border_power_law(run, weighted=True).exponent


def draw(results: Results) -> Figure:
    """Draw W_v(i) with its fits, and nu against the time step."""
    figure, (widths, exponents) = panels(1, 2, height=3.2, width_ratios=(1.4, 1))
    widths.set(xscale="log", yscale="log")
    for number, (size, runs) in enumerate(_RUNS.items()):
        run = runs.pooled(results)
        unit = runs.chain.free_velocity_width
        look: Any = {"number": number, "along": "particle"}
        draw_rods(widths, run, "velocity_width", unit=unit, label=f"$L = {size}$", **look)
        half = np.geomspace(1, size, 200)
        fit = fit_border_power_law(run)(half) / unit
        widths.plot(half, fit, color=COLOURS[number])
    widths.plot([], [], color="0.4", label="fit of two power laws")
    for size, theory in _predicted(results).items():
        unit, colour = _RUNS[size].chain.free_velocity_width, COLOURS[_SIZES.index(size)]
        widths.plot(theory.particle, theory.velocity_width / unit, ":", color=colour, zorder=4)
    widths.plot([], [], ":", color="0.4", label=_PAIRS)
    widths.legend(loc="lower left")
    widths.set(xlabel="particle $i$", ylabel="velocity width $W_v/W$")
    _draw_steps(exponents, results)
    return figure


def _draw_steps(ax: Axes, results: Results) -> None:
    """Draw nu against the time step, the theory's as crosses at the left margin."""
    theories = _predicted(results)
    first = 0.3 * min(chain_step(results, size) for size in _SIZES)
    for number, size in enumerate(_SIZES):
        steps = [chain_step(results, size), *reversed(STEPS)]
        each = [exponent(results, size, step) for step in (None, *reversed(STEPS))]
        order = np.argsort(steps)
        values, errors = np.transpose(each)[:, order]
        look: Any = {"number": number, "linewidth": 0.8, "linestyle": "-"}
        draw_points(ax, np.array(steps)[order], values, errors, **look)
        if size in theories:
            at = first * 1.25 ** (number - 1.5)  # beside one another
            ax.plot(at, nu(theories[size]), **_CROSS | {"color": COLOURS[number]})
    ax.axhline(_PAPER, color="0.4", linestyle="--", label="paper")
    ax.plot([], [], **_CROSS | {"color": "0.4"}, label=_PAIRS)
    ax.legend(loc="upper right")
    ax.set(xscale="log", xlabel="time step $dt$ [T]", ylabel=r"exponent $\nu$")
    ax.set_xticks([first, 1e-3, 1e-2], ["theory", "$10^{-3}$", "$10^{-2}$"])
    ax.set_xticks([tenth * k for tenth in (1e-3, 1e-2) for k in range(2, 10)], minor=True)
    ax.set_xlim(0.5 * first, 4e-2)
