"""Figures 12 and 14: velocity widths of flippers, by their damping and by their number."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import (
    COLOURS,
    along_the_chain,
    draw_rods,
    legend_above,
    panels,
)
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.model import Array, Chain, chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction import chains
from crazybilliards.reproduction.claims.study import Results, Runs, Study, effort, share_of_runs
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, at_choices
from crazybilliards.reproduction.profiles import beyond_the_eye, bulge, central_width, mirrored, nu

_RESTITUTION = 1.05
_CONVEX = "ln of the border's width over the centre's:"
_CONCAVE = "ln of the centre's width over the border's:"


def _draw(results: Results, curves: dict[str, Any], ylabel: str) -> Figure:
    """Draw W_v(i): of runs as symbols, of the gas as lines, both in a unit, by their label."""
    figure, [ax] = panels(1, 1, height=3.1)
    for number, (label, (runs, theory, unit)) in enumerate(curves.items()):
        draw_rods(ax, runs.mean(results), "velocity_width", number=number, unit=unit, label=label)
        solved = results[theory.name]
        ax.plot(solved.normalized_particle, solved.velocity_width / unit, color=COLOURS[number])
    along_the_chain(ax)
    ax.set_ylabel(ylabel)
    ax.plot([], [], color="0.4", label="gas")
    legend_above(figure, ax)
    return figure


# -- figure 12: by the damping, from convex to concave ----------------------------------------

_SIZE = 100
_DAMPINGS = (4.0, 5.0, 6.0, 8.0, 10.0)
_WEAK, _STRONG = _DAMPINGS[0], _DAMPINGS[-1]
_BY_DAMPING = chains.at_both_steps({g: chains.flippers(_SIZE, g) for g in _DAMPINGS})
_DAMPED = {g: chains.gas(_SIZE, _RESTITUTION, g) for g in _DAMPINGS}
_SOURCE = "section Anti-Dissipation, fig:mom_var_antidiss_diff_gamma_sq"


def _crowding(run: xr.Dataset) -> float:
    """Ln of the collision rate in the middle over that at the borders."""
    rate = run.collision_rate.values[:-1]  # the last rod has no right neighbour
    return float(np.log(rate[middle_tenth(rate.size)].mean() / rate[[0, -1]].mean()))


def _concavity(run: xr.Dataset) -> float:
    return -bulge(run)


def _claims_by_damping(results: Results) -> list[Claim]:
    bulges = [runs.estimate(results, bulge) for runs in _BY_DAMPING[chains.DEFAULT].values()]
    change = np.interp(0.0, [value for value, _ in bulges][::-1], _DAMPINGS[::-1])
    claim = partial(Claim, source=_SOURCE)
    measured = partial(chains.at_steps, results, _BY_DAMPING)
    return [
        claim(f"convex at gamma = {_WEAK:g}", _CONVEX, **measured(_WEAK, bulge)),
        claim(
            f"concave at gamma = {_STRONG:g}",
            f"it changes at gamma = {change:.1f}; {_CONCAVE}",
            **measured(_STRONG, _concavity),
        ),
        *(
            claim(
                f"rods collide more often in the bulk than at the border, gamma = {g:g}",
                "ln of the collision rate of the middle tenth of the contacts over that of the "
                "outermost:",
                **measured(g, _crowding),
            )
            for g in (_STRONG, _WEAK)
        ),
        _power_law_claim(results),
    ]


def _power_law_claim(results: Results) -> Claim:
    """Decide whether the best sum of two power laws is visibly off in a plot like the paper's."""
    ours, other = _BY_DAMPING.values()
    try:
        words = f"nu = {nu(ours[_WEAK].mean(results)):.3f} fits best"
    except ValueError:
        words = "no such law fits"
    return Claim(
        f"the convex profile at gamma = {_WEAK:g} cannot be described by a power law",
        "gamma W_v against i for the five dampings, rods averaged with their mirror images, both "
        f"axes linear: {words}; how much further than an eye sees, {EYE:g} of the plotted range, "
        "the symbol that decides is away from the nearest point of the line:",
        number=_off_the_fit(results, ours, np.asarray),
        elsewhere={
            "both axes logarithmic": _off_the_fit(results, ours, np.log),
            chains.OTHER: _off_the_fit(results, other, np.asarray),
        },
        source=_SOURCE,
        ours="whether the axes are linear",
        reason="a sum of two flat power laws fits",
    )


def _off_the_fit(
    results: Results, group: dict[float, Runs], axes: Callable[[Array], Array]
) -> Estimate:
    """Return how much further than an eye sees the fit is off."""
    profiles = {damping: runs.mean(results) for damping, runs in group.items()}
    plotted = axes(np.concatenate([g * run.velocity_width.values for g, run in profiles.items()]))
    low, high = float(plotted.min()), float(plotted.max())
    run = mirrored(profiles[_WEAK])
    try:
        fit = fit_border_power_law(run)
    except ValueError:  # no such law fits
        return Estimate(1.0 - EYE, 0.0)
    width, error = run.velocity_width.values, run.velocity_width_error.values
    fine = np.geomspace(1, _SIZE, 2000)
    symbols, line = (run.particle.values, _WEAK * width), (fine, _WEAK * fit(fine))
    distances = distances_in_plot(*map(axes, (*symbols, *line)), y_range=(low, high))
    below, above = axes(_WEAK * (width - error)), axes(_WEAK * (width + error))
    return beyond_the_eye(distances, (above - below) / 2 / (high - low))


BY_DAMPING = Study(
    number=12,
    name="widths-damping",
    title="Velocity widths of flippers for several dampings",
    caption="Damping times velocity width against the normalized particle number, L = 100, e = "
    "1.05. Lines: the gas, in which colliding rods are independent.",
    needs=[*chains.all_of(_BY_DAMPING), *_DAMPED.values()],
    claims=_claims_by_damping,
    draw=partial(
        _draw,
        curves={
            # In units of gamma W_v of a free rod at gamma = 1.
            rf"$\gamma = {g:g}$": (runs, _DAMPED[g], Chain().free_velocity_width / g)
            for g, runs in _BY_DAMPING[chains.DEFAULT].items()
        },
        ylabel=r"$\gamma W_v/(A/\sqrt{2m})$  [(M/$t_0$)$^{1/2}$]",
    ),
)

# -- figure 14: by the length, concave, convex, then divergence -------------------------------

_DAMPING = 4.0
_SIZES = (25, 50, 75, 100, 105)
_SHORT, _LONG = _SIZES[0], _SIZES[-1]
_BY_LENGTH = chains.at_both_steps({size: chains.flippers(size, _DAMPING) for size in _SIZES})
_OF_LENGTH = {size: chains.gas(size, _RESTITUTION, _DAMPING) for size in _SIZES}
_DIVERGING = Runs(
    "unsteady",
    Chain(size=150, restitution=_RESTITUTION, damping=_DAMPING),
    effort((4,), (4,)),
    {"duration": 1000.0, "warmup": 0.0, "observe": ["energy"]},
)
_UNSTEADY = {
    chains.DEFAULT: _DIVERGING,
    chains.OTHER: _DIVERGING.at_step(chains.OTHER_STEP, _DIVERGING.effort),
}


def _claims_by_length(results: Results) -> list[Claim]:
    def diverged(runs: Runs) -> list[bool]:
        return [run.attrs["status"] == "diverged" for run in runs.members(results)]

    def centre(run: xr.Dataset) -> float:
        return central_width(run) / chain_of(run).free_velocity_width

    claim = partial(Claim, source="section Anti-Dissipation, fig:antidiss_diff_L")
    measured = partial(chains.at_steps, results, _BY_LENGTH)
    _, _, growth = chains.difference(results, _BY_LENGTH, (_LONG, _SHORT), centre)
    released = diverged(_DIVERGING)
    return [
        claim(f"concave at L = {_SHORT}", _CONCAVE, **measured(_SHORT, _concavity)),
        claim(f"convex at L = {_LONG}", _CONVEX, **measured(_LONG, bulge)),
        claim(
            "the longer the chain, the larger W_v",
            f"W_v/W in the centre at L = {_LONG} less that at L = {_SHORT}:",
            **growth,
        ),
        claim(
            f"without a steady state at L = {_DIVERGING.chain.size}",
            f"{sum(released)} of {len(released)} runs, released from rest, diverged; their "
            "share, as far as so few runs show it:",
            **at_choices(_UNSTEADY, lambda runs: share_of_runs(diverged(runs))),
            ours="the size that is too large",
        ),
    ]


BY_LENGTH = Study(
    number=14,
    name="widths-size",
    title="Velocity widths of flippers for several sizes",
    caption="W_v against the normalized particle number, e = 1.05, gamma = 4. Lines: the gas, "
    "in which colliding rods are independent. Longer chains have no steady state: L = 150 "
    "diverges.",
    needs=[*chains.all_of(_BY_LENGTH), *_OF_LENGTH.values(), *_UNSTEADY.values()],
    claims=_claims_by_length,
    draw=partial(
        _draw,
        curves={
            f"$L = {size}$": (runs, _OF_LENGTH[size], runs.chain.free_velocity_width)
            for size, runs in _BY_LENGTH[chains.DEFAULT].items()
        },
        ylabel="velocity width $W_v/W$",
    ),
)
