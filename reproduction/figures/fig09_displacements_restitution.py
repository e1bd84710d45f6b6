"""Figure 9: mean displacements for several restitutions."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from scipy.optimize import least_squares

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods, mark_clipped
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.model import chain_of
from crazybilliards.model.arrays import Array, middle_tenth
from crazybilliards.reproduction.chains import LARGE, OTHER_STEP, at_other_step, dissipative
from crazybilliards.reproduction.claims.repetition import Runs
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, all_of
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, furthest_in_plot
from crazybilliards.reproduction.figures.fig05_displacements_inelastic import swelling
from crazybilliards.reproduction.mirror_images import mirrored
from crazybilliards.reproduction.predictions import LINES, by_restitution, predicted

TITLE = "Mean displacements for several restitutions"
CAPTION = (
    "Mean displacement, L = 1000, in units of the thermal length s, (a) of all rods against the "
    "normalized particle number, (b) of the left half against the rod's number. Lines: the kinetic "
    "equation, dashed without pair correlations, full with them. Triangles at the frame of (a): "
    "rods beyond it, which (b) shows."
)

Law = Callable[[Array, float, float, float], Array]
_FRAME = 0.7
_LABEL = r"displacement $\langle\Delta x\rangle/s$"
_RUNS = {e: dissipative(LARGE, e) for e in (0.0, 0.75, 0.85, 0.92, 0.95)}
_AGAIN = {e: at_other_step(runs) for e, runs in _RUNS.items()}
_THERE = f"dt = {OTHER_STEP:g}"


def cases(quality: Quality) -> Cases:
    """L = 1000 at five restitutions, and the kinetic equation without and with pairs."""
    return by_restitution(quality) | all_of([*_RUNS.values(), *_AGAIN.values()], quality)


def claims(results: Results) -> list[Claim]:
    """Check: displacements grow with e, no power law, and a larger energy at the border."""
    found, again = (
        {e: runs.estimate(results, swelling) for e, runs in every.items()}
        for every in (_RUNS, _AGAIN)
    )
    growing = [
        Claim(
            f"the mean displacement grows from e = {low:g} to {high:g}",
            f"slope of <dx> against i_n: {found[low]} and {found[high]}, difference",
            found=found[high].minus(found[low]),
            source="section seq:e_larger, fig.5",
            elsewhere={_THERE: again[high].minus(again[low])},
        )
        for low, high in itertools.pairwise(_RUNS)
    ]
    return [*growing, _power_law_claim(results), *_energy_claims(results)]


def _power_law_claim(results: Results) -> Claim:
    """Decide whether power laws are visibly off in plots of <dx>, at every restitution."""

    def least(law: Law, every: Mapping[float, Runs]) -> Estimate:
        each = [_beyond_the_eye(mirrored(runs.pooled(results)), law) for runs in every.values()]
        return min(each, key=lambda one: one.value - 3 * one.error)

    return Claim(
        "<dx> does not follow a power law",
        f"b i^nu fitted to the left half, rods averaged with their mirror images, e = "
        f"{', '.join(f'{e:g}' for e in _RUNS)}, both axes linear: how much further than an eye "
        f"sees, {EYE:g} of the plotted range, the symbol that decides is away from the nearest "
        "point of the line, at the e where it fits best:",
        found=least(_power_law, _RUNS),
        source="section seq:e_larger, fig.5",
        ours="the form of the power law, and whether the axes are linear",
        elsewhere={
            _THERE: least(_power_law, _AGAIN),
            "the difference of two power laws, b [(i - c)^nu - (L + 1 - c - i)^nu]": least(
                _two_power_laws, _RUNS
            ),
        },
        reason="the difference of two power laws with a small exponent is nearly an arctanh",
    )


def _power_law(i: Array, scale: float, nu: float, shift: float) -> Array:
    """Return a power law, which has no use for the shift."""
    return np.asarray(scale * i**nu)


def _two_power_laws(i: Array, scale: float, nu: float, shift: float) -> Array:
    ends = (np.maximum(end - shift, 1e-3) for end in (i, LARGE + 1 - i))
    left, right = (end**nu for end in ends)
    return np.asarray(scale * (left - right))


def _beyond_the_eye(run: xr.Dataset, law: Law) -> Estimate:
    """Return the distance from the best fit that decides, as a share of the plot, less EYE."""
    half = run.isel(particle=slice(0, LARGE // 2))
    i, shift = half.particle.values.astype(float), half.mean_displacement.values

    def residuals(values: Array) -> Array:
        return law(i, *values.tolist()) - shift

    values = least_squares(residuals, (shift[0], -0.5, 0.0), x_scale="jac").x
    fine = np.geomspace(1, i[-1], 2000)
    off = distances_in_plot(i, shift, fine, law(fine, *values))
    errors = half.mean_displacement_error.values / np.ptp(shift)
    furthest = furthest_in_plot(off, errors)
    return Estimate(furthest.value - EYE, furthest.error)


def _energy_claims(results: Results) -> list[Claim]:
    e = max(_RUNS)

    def excess(runs: Runs) -> tuple[Estimate, Estimate]:
        names = ("potential", "kinetic")
        one, other = (runs.estimate(results, partial(_excess, name=name)) for name in names)
        return one, other

    def total(potential: Estimate, kinetic: Estimate) -> Estimate:
        return Estimate(potential.value + kinetic.value, potential.error + kinetic.error)

    (potential, kinetic), again = excess(_RUNS[e]), excess(_AGAIN[e])
    what = f"border's less centre's, in units of m W^2/2: potential {potential}, kinetic {kinetic}"
    claim = partial(Claim, source="section seq:e_larger", ours="the restitution")
    return [
        claim(
            f"the energy is larger at the border, e = {e:g}",
            f"{what}; their sum",
            found=total(potential, kinetic),
            elsewhere={_THERE: total(*again)},
        ),
        claim(
            f"because the potential energy is, e = {e:g}",
            f"{what}; potential less kinetic",
            found=total(potential, -kinetic),
            elsewhere={_THERE: total(again[0], -again[1])},
        ),
    ]


def _excess(run: xr.Dataset, name: str) -> float:
    """Mean energy of the two border rods less that of the middle tenth, in units of m W^2/2."""
    chain = chain_of(run)
    if name == "kinetic":
        energy = (run.velocity_width.values / chain.free_velocity_width) ** 2
    else:
        squares = run.mean_displacement.values**2 + run.displacement_width.values**2
        energy = squares / chain.thermal_length**2
    return float(energy[[0, -1]].mean() - energy[middle_tenth(energy.size)].mean())


def draw(results: Results) -> Figure:
    """Draw <dx> against i_n, and of the rods at the left border against i; theory as lines."""
    figure, (whole, border) = panels(1, 2, height=2.5)
    border.set(xscale="log", xlabel="particle $i$", ylabel=_LABEL)
    for number, (e, runs) in enumerate(_RUNS.items()):
        run = runs.pooled(results)
        s, colour = runs.chain.thermal_length, COLOURS[number]
        half = run.isel(particle=slice(0, LARGE // 2))
        look: Any = {"number": number, "unit": s, "label": f"$e = {e:g}$"}
        draw_rods(whole, run, "mean_displacement", **look)
        draw_rods(border, half, "mean_displacement", along="particle", **look)
        for theory, of_theory in predicted(results).items():
            if e in of_theory:
                shift, style = of_theory[e].mean_displacement / s, LINES[theory]
                whole.plot(of_theory[e].normalized_particle, shift, style, color=colour)
                border.plot(half.particle, shift[: LARGE // 2], style, color=colour)
    along_the_chain(whole)
    whole.set(ylabel=_LABEL, ylim=(-_FRAME, _FRAME))
    mark_clipped(whole)
    for theory, style in LINES.items():
        whole.plot([], [], style, color="0.4", label=theory)
    legend_above(figure, whole)
    return figure
