"""Figure 12: velocity widths of flippers for several dampings: from convex to concave."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.widths import border_width, central_width
from crazybilliards.model.arrays import Array, middle_tenth
from crazybilliards.reproduction.chains import OTHER_STEP, at_other_step, flippers, kinetic_equation
from crazybilliards.reproduction.claims.repetition import Runs
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, furthest_in_plot
from crazybilliards.reproduction.mirror_images import mirrored
from crazybilliards.reproduction.power_laws import nu
from crazybilliards.reproduction.predictions import draw_flippers

TITLE = "Velocity widths of flippers for several dampings"
CAPTION = (
    "Damping times velocity width against the normalized particle number, L = 100, e = 1.05. "
    "Lines: the kinetic equation."
)

_SIZE = 100
_RESTITUTION = 1.05
_claim = partial(Claim, source="section Anti-Dissipation, fig:mom_var_antidiss_diff_gamma_sq")
_DAMPINGS = (4.0, 5.0, 6.0, 8.0, 10.0)
_RUNS = {damping: flippers(_SIZE, damping) for damping in _DAMPINGS}
_AGAIN = {damping: at_other_step(runs) for damping, runs in _RUNS.items()}
_THERE = f"dt = {OTHER_STEP:g}"
_THEORIES = {damping: kinetic_equation(_SIZE, _RESTITUTION, damping) for damping in _DAMPINGS}
cases = partial(all_of, [each[g] for g in _DAMPINGS for each in (_RUNS, _THEORIES, _AGAIN)])


def bulge(run: xr.Dataset) -> float:
    """Ln of the border's width over the centre's: positive for a convex profile."""
    return float(np.log(border_width(run) / central_width(run)))


def claims(results: Results) -> list[Claim]:
    """Check: convex at gamma = 4, concave at gamma = 10; where rods collide; no power law."""
    found, again = (
        {g: runs.estimate(results, bulge) for g, runs in every.items()} for every in (_RUNS, _AGAIN)
    )
    low, high = _DAMPINGS[0], _DAMPINGS[-1]
    change = np.interp(0.0, [each.value for each in found.values()][::-1], _DAMPINGS[::-1])
    return [
        _claim(
            f"convex at gamma = {low:g}",
            "ln of the border's width over the centre's:",
            found=found[low],
            elsewhere={_THERE: again[low]},
        ),
        _claim(
            f"concave at gamma = {high:g}",
            f"it changes at gamma = {change:.1f}; ln of the centre's width over the border's:",
            found=-found[high],
            elsewhere={_THERE: -again[high]},
        ),
        *(
            _claim(
                f"rods collide more often in the bulk than at the border, gamma = {damping:g}",
                "ln of the collision rate of the middle tenth of the contacts over that of the "
                "outermost:",
                found=_RUNS[damping].estimate(results, _crowding),
                elsewhere={_THERE: _AGAIN[damping].estimate(results, _crowding)},
            )
            for damping in (high, low)
        ),
        _power_law_claim(results),
    ]


def _crowding(run: xr.Dataset) -> float:
    rate = run.collision_rate.values[:-1]  # the last rod has no right neighbour
    return float(np.log(rate[middle_tenth(rate.size)].mean() / rate[[0, -1]].mean()))


def _power_law_claim(results: Results) -> Claim:
    """Decide whether the best sum of two power laws is visibly off in a plot like the paper's."""
    low = _DAMPINGS[0]
    try:
        words = f"nu = {nu(_RUNS[low].pooled(results)):.3f} fits best"
    except ValueError:
        words = "no such law fits"
    return _claim(
        f"the convex profile at gamma = {low:g} cannot be described by a power law",
        "gamma W_v against i for the five dampings, rods averaged with their mirror images, both "
        f"axes linear: {words}; how much further than an eye sees, {EYE:g} of the plotted range, "
        "the symbol that decides is away from the nearest point of the line:",
        found=_beyond_the_eye(results, _RUNS, np.asarray),
        ours="whether the axes are linear",
        elsewhere={
            "both axes logarithmic": _beyond_the_eye(results, _RUNS, np.log),
            _THERE: _beyond_the_eye(results, _AGAIN, np.asarray),
        },
        reason="a sum of two flat power laws fits",
    )


def _beyond_the_eye(
    results: Results, every: Mapping[float, Runs], axes: Callable[[Array], Array]
) -> Estimate:
    """Return the distance from the fit that decides, as a share of the plot, less EYE."""
    widths = {g: runs.pooled(results).velocity_width.values for g, runs in every.items()}
    plotted = axes(np.concatenate([g * width for g, width in widths.items()]))
    shown = float(plotted.min()), float(plotted.max())
    damping = _DAMPINGS[0]
    run = mirrored(every[damping].pooled(results))
    try:
        fit = fit_border_power_law(run)
    except ValueError:  # no such law fits
        return Estimate(1.0 - EYE, 0.0)
    i, width, error = (
        run[name].values for name in ("particle", "velocity_width", "velocity_width_error")
    )
    fine = np.geomspace(1, _SIZE, 2000)
    off = distances_in_plot(
        axes(i), axes(damping * width), axes(fine), axes(damping * fit(fine)), y_range=shown
    )
    # The height of the error bars on these axes.
    low, high = (axes(damping * (width + sign * error)) for sign in (-1, 1))
    furthest = furthest_in_plot(off, (high - low) / 2 / (shown[1] - shown[0]))
    return Estimate(furthest.value - EYE, furthest.error)


def draw(results: Results) -> Figure:
    """Draw gamma W_v(i) for every damping with the kinetic equation."""
    shown = {}
    for damping, runs in _RUNS.items():
        # gamma W_v over that of a free rod at gamma = 1, A/sqrt(2 m).
        unit = runs.chain.replace(damping=1.0).free_velocity_width / damping
        shown[rf"$\gamma = {damping:g}$"] = runs, _THEORIES[damping], unit
    label = r"$\gamma W_v/(A/\sqrt{2m})$  [M$^{1/2}$T$^{-1/2}$]"
    return draw_flippers(results, shown, label)
