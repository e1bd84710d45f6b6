"""Figure 16: the arctanh fit of the mean displacement at e = 1, and the exact curve."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.layout import panels
from crazybilliards.kinetic import equilibrium
from crazybilliards.model import chain_of
from crazybilliards.reproduction.claims.study import Cases, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Claim, furthest_in_plot, in_plot
from crazybilliards.reproduction.figures.fig17_density import simulation

TITLE = "The mean displacement at e = 1 and its arctanh fit"
CAPTION = (
    "L = 100, e = 1, A = 10. (b) Curves less simulation; grey: one standard error. s is the "
    "thermal length."
)

_AMPLITUDE = 10.0


def cases(quality: Quality) -> Cases:
    """L = 100, e = 1, A = 10."""
    return {"run": simulation(_AMPLITUDE)}


def claims(results: Results) -> list[Claim]:
    """Check: the arctanh fits."""
    run = results["run"]
    fit = fit_arctanh(run)
    x, displacement = run.mean_position.values, run.mean_displacement.values
    errors, fitted = run.mean_displacement_error.values, fit(run.mean_position)
    fine = np.linspace(x[0], x[-1], 4001)
    off = distances_in_plot(x, displacement, fine, fit(fine))
    return [
        Claim(
            "<dx> is described by B arctanh(C x)",
            **in_plot(
                f"B = {fit.scale:.3f} R, C = {fit.steepness:.5f}/R, all rods, both axes linear",
                furthest_in_plot(off, errors / np.ptp(displacement)),
                float((np.abs(displacement - fitted) / errors).max()),
            ),
            source="section seq:analytics, fig:atan",
            reason="the curve misses the outermost rods",
        )
    ]


def draw(results: Results) -> Figure:
    """Draw <dx>(x), the fit and the exact curve, and their differences."""
    run = results["run"]
    chain = chain_of(run)
    s = chain.thermal_length
    fit = fit_arctanh(run)
    exact = equilibrium(chain)
    x = run.mean_position.values
    figure, (top, bottom) = panels(2, 1, height=1.7, sharex=True, height_ratios=(2, 1))
    measured = run.mean_displacement.values
    error = run.mean_displacement_error.values
    look: Any = {"number": 0, "color": "black", "linewidth": 0.7, "label": "simulation"}
    draw_points(top, x, measured / s, error / s, **look)
    curves = {
        "exact": (exact.mean_displacement.values, "-", COLOURS[1]),
        "arctanh fit": (fit(x), "--", COLOURS[0]),
    }
    for label, (curve, style, colour) in curves.items():
        top.plot(x, curve / s, style, color=colour, label=label)
        bottom.plot(x, (curve - measured) / s, style, color=colour)
    bottom.fill_between(x, -error / s, error / s, color="0.8", label="one standard error")
    bottom.legend(loc="lower center")
    top.set(ylabel=r"displacement $\langle\Delta x\rangle/s$")
    bottom.set(xlabel=r"mean position $\langle x_i\rangle$ [R]", ylabel="curve less\nsimulation")
    top.legend()
    return figure
