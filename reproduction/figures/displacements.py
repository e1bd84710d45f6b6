"""Figures 5 and 9: mean displacements of dissipative chains, by length and by restitution."""

import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from scipy.optimize import least_squares

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import (
    COLOURS,
    along_the_chain,
    draw_rods,
    legend_above,
    mark_clipped,
    panels,
)
from crazybilliards.model import Array, Chain, chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction import chains
from crazybilliards.reproduction.claims.study import Results, Runs, Study
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, at_choices
from crazybilliards.reproduction.profiles import beyond_the_eye, central_width, mirrored

_S = Chain().thermal_length


def _swelling(run: xr.Dataset) -> float:
    """Return the slope of <dx>/s against i_n by least squares: all rods count."""
    place = run.normalized_particle.values
    return float(place @ run.mean_displacement.values / (place @ place) / _S)


def _confinement(run: xr.Dataset) -> float:
    return central_width(run, of="displacement_width") / _S


# -- figure 5: the perfectly inelastic chain, by its length -----------------------------------

_SIZES = (30, 100, 300, chains.LARGE)
_INELASTIC = chains.inelastic(_SIZES)


def _claims_by_length(results: Results) -> list[Claim]:
    claims = []
    for small, large in itertools.pairwise(_SIZES):
        shrinks = f"the mean displacement decreases from L = {small} to L = {large}"
        narrows = f"the interior is confined more strongly at L = {large} than at L = {small}"
        for quantity, name, statement, source in (
            (_swelling, "slope of <dx>/s against i_n", shrinks, "fig.3_2"),
            (_confinement, "W_x/s in the centre, middle tenth", narrows, "fig.3_2, inset"),
        ):
            first, second, about = chains.difference(results, _INELASTIC, (small, large), quantity)
            claims.append(
                Claim(
                    statement,
                    f"{name}: {first} less {second}, difference",
                    **about,
                    source=f"section seq:e_0, {source}",
                    ours="the sizes and the time step",
                )
            )
    return claims


def _draw_by_length(results: Results) -> Figure:
    figure, axes = panels(1, 2)
    for number, (size, runs) in enumerate(_INELASTIC[chains.DEFAULT].items()):
        run = runs.mean(results)
        for ax, name in zip(axes, ("mean_displacement", "displacement_width"), strict=True):
            draw_rods(ax, run, name, number=number, unit=_S, label=f"$L = {size}$")
    axes[0].set(ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
    axes[1].set(ylabel="displacement width $W_x/s$")
    for ax in axes:
        along_the_chain(ax)
    axes[0].legend()
    return figure


BY_LENGTH = Study(
    number=5,
    name="displacements-inelastic",
    title="Mean displacements at e = 0",
    caption="(a) Mean displacement and (b) its width (the paper's inset) against the normalized "
    "particle number, e = 0, in units of the thermal length s.",
    needs=chains.all_of(_INELASTIC),
    claims=_claims_by_length,
    draw=_draw_by_length,
)

# -- figure 9: 1000 rods, by their restitution ------------------------------------------------

Law = Callable[[Array, float, float, float], Array]
_RUNS = {e: chains.dissipative(chains.LARGE, e) for e in (0.0, 0.75, 0.85, 0.92, 0.95)}
_STEPS = chains.at_both_steps(_RUNS)
_FRAME = 0.7  # of the picture of all rods


def _claims_by_restitution(results: Results) -> list[Claim]:
    claims = []
    for low, high in itertools.pairwise(_RUNS):
        of_high, of_low, numbers = chains.difference(results, _STEPS, (high, low), _swelling)
        claims.append(
            Claim(
                f"the mean displacement grows from e = {low:g} to {high:g}",
                f"slope of <dx>/s against i_n: {of_low} and {of_high}, difference",
                **numbers,
                source="section seq:e_larger, fig.5",
            )
        )
    return [*claims, _power_law_claim(results), *_energy_claims(results)]


def _power_law_claim(results: Results) -> Claim:
    """Decide whether power laws are visibly off in plots of <dx>, at every restitution."""

    def least(law: Law, group: dict[float, Runs]) -> Estimate:
        distances = [_off_the_best(runs.mean(results), law) for runs in group.values()]
        return min(distances, key=lambda distance: distance.value - 3 * distance.error)

    ours, other = _STEPS.values()
    difference = "the difference of two power laws, b [(i - c)^nu - (L + 1 - c - i)^nu]"
    return Claim(
        "<dx> does not follow a power law",
        f"b i^nu fitted to the left half, rods averaged with their mirror images, e = "
        f"{', '.join(f'{e:g}' for e in _RUNS)}, both axes linear: how much further than an eye "
        f"sees, {EYE:g} of the plotted range, the symbol that decides is away from the nearest "
        "point of the line, at the e where it fits best:",
        number=least(_power_law, ours),
        elsewhere={
            chains.OTHER: least(_power_law, other),
            difference: least(_two_power_laws, ours),
        },
        source="section seq:e_larger, fig.5",
        ours="the form of the power law, and whether the axes are linear",
        reason="the difference of two power laws with a small exponent is nearly an arctanh",
    )


def _power_law(i: Array, scale: float, nu: float, shift: float) -> Array:
    """Return a power law, which has no use for the shift."""
    return np.asarray(scale * i**nu)


def _two_power_laws(i: Array, scale: float, nu: float, shift: float) -> Array:
    left, right = (np.maximum(end - shift, 1e-3) ** nu for end in (i, chains.LARGE + 1 - i))
    return np.asarray(scale * (left - right))


def _off_the_best(run: xr.Dataset, law: Law) -> Estimate:
    """Return how much further than an eye sees the best fit is off."""
    half = mirrored(run).isel(particle=slice(0, chains.LARGE // 2))
    i, shift = half.particle.values.astype(float), half.mean_displacement.values

    def residuals(values: Array) -> Array:
        return law(i, *values.tolist()) - shift

    values = least_squares(residuals, (shift[0], -0.5, 0.0), x_scale="jac").x
    fine = np.geomspace(1, i[-1], 2000)
    distances = distances_in_plot(i, shift, fine, law(fine, *values))
    return beyond_the_eye(distances, half.mean_displacement_error.values / np.ptp(shift))


def _energy_claims(results: Results) -> list[Claim]:
    """Decide whether rods at the border have more energy, and whether it is the potential one."""
    e = max(_RUNS)

    def excess(group: dict[float, Runs], sign: int) -> Estimate:
        potential, kinetic = group[e].estimates(results, _excess)
        # Both are of the same rods: their errors add.
        return Estimate(potential.value + sign * kinetic.value, potential.error + kinetic.error)

    potential, kinetic = _RUNS[e].estimates(results, _excess)
    both = f"border's less centre's, in units of m W^2/2: potential {potential}, kinetic {kinetic}"
    return [
        Claim(
            f"{statement}, e = {e:g}",
            f"{both}; {quantity}",
            **at_choices(_STEPS, partial(excess, sign=sign)),
            source="section seq:e_larger",
            ours="the restitution",
        )
        for statement, quantity, sign in (
            ("the energy is larger at the border", "their sum", 1),
            ("because the potential energy is", "potential less kinetic", -1),
        )
    ]


def _excess(run: xr.Dataset) -> Array:
    """Potential and kinetic energy of the border rods less those of the middle tenth [m W^2/2]."""
    chain = chain_of(run)
    potential = run.mean_displacement.values**2 + run.displacement_width.values**2
    scales = [[chain.thermal_length**2], [chain.free_velocity_width**2]]
    energy = np.array([potential, run.velocity_width.values**2]) / scales
    centre = energy[:, middle_tenth(run.sizes["particle"])]
    return np.asarray(energy[:, [0, -1]].mean(axis=1) - centre.mean(axis=1))


def _draw_by_restitution(results: Results) -> Figure:
    figure, (whole, border) = panels(1, 2, height=2.5)
    label = r"displacement $\langle\Delta x\rangle/s$"
    border.set(xscale="log", xlabel="particle $i$", ylabel=label)
    left = {"particle": slice(0, chains.LARGE // 2)}
    for number, (e, runs) in enumerate(_RUNS.items()):
        run = runs.mean(results)
        look: Any = {"number": number, "unit": _S, "label": f"$e = {e:g}$"}
        draw_rods(whole, run, "mean_displacement", **look)
        draw_rods(border, run.isel(left), "mean_displacement", along="particle", **look)
        for name, theories in chains.predictions(results).items():
            if e in theories:
                shift = theories[e].mean_displacement / _S
                line: Any = {"color": COLOURS[number], "linestyle": chains.LINES[name]}
                whole.plot(shift.normalized_particle, shift, **line)
                border.plot(shift.particle.isel(left), shift.isel(left), **line)
    along_the_chain(whole)
    whole.set(ylabel=label, ylim=(-_FRAME, _FRAME))
    mark_clipped(whole)
    for name, style in chains.LINES.items():
        whole.plot([], [], style, color="0.4", label=name)
    legend_above(figure, whole)
    return figure


BY_RESTITUTION = Study(
    number=9,
    name="displacements-restitution",
    title="Mean displacements for several restitutions",
    caption="Mean displacement, L = 1000, in units of the thermal length s, (a) of all rods "
    "against the normalized particle number, (b) of the left half against the rod's number. Lines: "
    "the gas, dashed in the mean field, full with correlations. Triangles at the frame of (a): "
    "rods beyond it, which (b) shows.",
    needs=[*chains.all_of(chains.PREDICTIONS), *chains.all_of(_STEPS)],
    claims=_claims_by_restitution,
    draw=_draw_by_restitution,
)
