"""Figure 7: velocity widths for several restitutions, and the exponent against the restitution."""

from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import (
    COLOURS,
    TWO_COLUMNS,
    along_the_chain,
    draw_points,
    draw_rods,
    legend_above,
    letter,
)
from crazybilliards.comparison.fits import Fit
from crazybilliards.reproduction import chains
from crazybilliards.reproduction.claims.study import Results, Runs, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, at_choices, worst
from crazybilliards.reproduction.fits import fit_exponential
from crazybilliards.reproduction.profiles import bulge, central_width, fits_in_plot, nu

_RUNS = {e: chains.dissipative(chains.LARGE, e) for e in chains.RESTITUTIONS}
_STEPS = chains.at_both_steps(_RUNS)
_UNIT = chains.ELASTIC.chain.free_velocity_width
_CROSSES: dict[str, dict[str, Any]] = {
    chains.MEAN_FIELD: {"marker": "x", "linestyle": "none", "color": COLOURS[4]},
    chains.GAS: {"marker": "+", "linestyle": "none", "color": COLOURS[2]},
}


def _exponential(results: Results, group: dict[float, Runs]) -> tuple[dict[float, Estimate], Fit]:
    """Return the exponents -nu by the restitution, and the exponential that fits them."""
    exponents = {e: runs.estimate(results, nu).times(-1) for e, runs in group.items()}
    return exponents, fit_exponential(list(exponents), *np.transpose(list(exponents.values())))


def _claims(results: Results) -> list[Claim]:
    low, high = chains.RESTITUTIONS[0], chains.RESTITUTIONS[-1]
    at_low, at_high, flatter = chains.difference(results, _STEPS, (low, high), bulge)
    claim = partial(Claim, ours="the restitutions (those of fig.5, and 0.5) and the time step")
    source = "section seq:e_larger, fig.4"

    def fits(group: dict[float, Runs]) -> dict[str, Any]:
        return fits_in_plot("six restitutions", [runs.mean(results) for runs in group.values()])

    return [
        claim(
            "the larger e, the less the width varies along the chain",
            f"ln of the border's width over the centre's: {at_low} at e = {low:g} and {at_high} at "
            f"e = {high:g}, difference",
            **flatter,
            source=source,
        ),
        claim(
            "W_v(i) is described by a sum of two power laws at every e < 1",
            **at_choices(_STEPS, fits),
            source=f"{source}, eq:power_law",
            reason="the two power laws leave systematic residuals",
        ),
        claim(
            "-nu depends on e like exp(-lambda (1 - e)) + d, lambda unknown",
            **at_choices(_STEPS, partial(_residuals, results)),
            source=f"{source}, inset",
            reason="the errors of the exponents are about as large as the limit",
        ),
    ]


def _residuals(results: Results, group: dict[float, Runs]) -> dict[str, Any]:
    exponents, fit = _exponential(results, group)
    rate, amplitude, offset = (
        Estimate(fit.parameters[name], fit.errors[name]) for name in ("rate", "amplitude", "offset")
    )
    listed = ", ".join(f"{e:g}: {exponent}" for e, exponent in exponents.items())
    return worst(
        f"with an amplitude a before it lambda = {rate}, a = {amplitude}, d = {offset}; -nu by e: "
        f"{listed}; -nu less the curve",
        [Estimate(value - float(fit(e)), error) for e, (value, error) in exponents.items()],
        0.005,  # the paper gives exponents with two decimals
    )


def _draw(results: Results) -> Figure:
    figure = Figure(figsize=(TWO_COLUMNS, 3.9))
    axes = figure.subplot_mosaic("ab;ac", width_ratios=(1.4, 1))
    letter(axes.values())
    widths, exponents, centre = axes.values()
    _draw_widths(widths, results)
    legend_above(figure, widths)
    exponents.sharex(centre)
    _draw_by_restitution(exponents, results, lambda result: -nu(result))
    (_, fit), fine = _exponential(results, _RUNS), np.linspace(0, 1, 101)
    exponents.plot(fine, fit(fine), "0.4", label=rf"fit, $\lambda = {fit.rate:.1f}$")
    exponents.set(ylabel=r"exponent $-\nu$")
    exponents.tick_params(labelbottom=False)
    exponents.legend()
    _draw_by_restitution(centre, results, lambda result: central_width(result) / _UNIT)
    centre.set(xlabel="restitution $e$", ylabel="central width $W_v^{\\min}/W$")
    centre.legend()
    return figure


def _draw_widths(ax: Axes, results: Results) -> None:
    solved = chains.predictions(results)
    ax.set(ylabel="velocity width $W_v/W$", yscale="log")
    for number, (e, runs) in enumerate((_RUNS | {1.0: chains.ELASTIC}).items()):
        label = f"$e = {e:g}$" + (f", $L = {runs.chain.size}$" if e == 1 else "")
        draw_rods(ax, runs.mean(results), "velocity_width", number=number, unit=_UNIT, label=label)
        for name, theories in solved.items():
            if theory := theories.get(e):
                ax.plot(
                    theory.normalized_particle,
                    theory.velocity_width / _UNIT,
                    color=COLOURS[number],
                    linestyle=chains.LINES[name],
                    zorder=4,
                )
    along_the_chain(ax)
    for name, theories in solved.items():
        label = rf"{name}, $e \geq {min(theories):g}$"
        ax.plot([], [], chains.LINES[name], color="0.4", label=label)


def _draw_by_restitution(ax: Axes, results: Results, quantity: chains.Quantity) -> None:
    """Draw a quantity of the simulations, of the gas and of its mean field against e."""
    values, errors = np.transpose([runs.estimate(results, quantity) for runs in _RUNS.values()])
    draw_points(ax, list(_RUNS), values, errors, number=0, color="black", label="simulation")
    for name, theories in chains.predictions(results).items():
        values = [quantity(theory) for theory in theories.values()]
        ax.plot(list(theories), values, label=name, **_CROSSES[name])


RESTITUTION = Study(
    number=7,
    name="widths-restitution",
    title="Velocity widths for several restitutions",
    caption="(a) W_v against the normalized particle number, L = 1000 (e = 1: L = 100). Lines: the "
    "gas in the colour of its e, dashed in the mean field, full with correlations; nothing of the "
    "simulation goes into these lines. (b) The exponent of the two power laws against the "
    "restitution, and a exp(-lambda (1 - e)) + d fitted to it. (c) W_v in the centre.",
    needs=[*chains.all_of(_STEPS), *chains.all_of(chains.PREDICTIONS), chains.ELASTIC],
    claims=_claims,
    draw=_draw,
)
