"""Figure 9: mean displacements for several restitutions."""

from __future__ import annotations

import itertools
from functools import partial
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods, mark_clipped
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.model import chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction.chains import LARGE, dissipative
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate
from crazybilliards.reproduction.figures.fig05_displacements_inelastic import swelling
from crazybilliards.reproduction.predictions import LINES, by_restitution, predicted

TITLE = "Mean displacements for several restitutions"
CAPTION = (
    "Mean displacement, L = 1000, in units of the thermal length s, (a) of all rods against the "
    "normalized particle number, (b) of the left half against the rod's number. Lines: the kinetic "
    "equation, dashed without pair correlations, full with them. Triangles at the frame of (a): "
    "rods beyond it, which (b) shows."
)

_FRAME = 0.7
_LABEL = r"displacement $\langle\Delta x\rangle/s$"
_RUNS = {e: dissipative(LARGE, e) for e in (0.0, 0.75, 0.85, 0.92, 0.95)}


def cases(quality: Quality) -> Cases:
    """L = 1000 at five restitutions, and the kinetic equation without and with pairs."""
    return by_restitution(quality) | all_of(_RUNS.values(), quality)


def claims(results: Results) -> list[Claim]:
    """Check: displacements grow with e, and the border has the larger energy at large e."""
    found = {e: runs.estimate(results, swelling) for e, runs in _RUNS.items()}
    growing = [
        Claim(
            f"the mean displacement grows from e = {low:g} to {high:g}",
            f"slope of <dx> against i_n: {found[low]} and {found[high]}, difference",
            found=found[high].minus(found[low]),
            source="section seq:e_larger, fig.5",
        )
        for low, high in itertools.pairwise(_RUNS)
    ]
    return growing + _energy_claims(results)


def _energy_claims(results: Results) -> list[Claim]:
    e = max(_RUNS)
    potential, kinetic = (
        _RUNS[e].estimate(results, partial(_excess, name=name)) for name in ("potential", "kinetic")
    )
    what = f"border's less centre's, in units of m W^2/2: potential {potential}, kinetic {kinetic}"
    both = Estimate(potential.value + kinetic.value, potential.error + kinetic.error)
    less = Estimate(potential.value - kinetic.value, both.error)
    claim = partial(Claim, source="section seq:e_larger", ours="the restitution")
    return [
        claim(f"the energy is larger at the border, e = {e:g}", f"{what}; their sum", found=both),
        claim(
            f"because the potential energy is, e = {e:g}",
            f"{what}; potential less kinetic",
            found=less,
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
