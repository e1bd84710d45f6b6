"""Figure 19: velocity variances of chains with gaps: a plateau in the interior."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import along_the_chain, draw_rods
from crazybilliards.comparison.layout import entitle, legend_above, panels
from crazybilliards.comparison.widths import central_width
from crazybilliards.model import chain_of
from crazybilliards.reproduction.chains import LARGE, OTHER_STEP, at_other_step, dissipative
from crazybilliards.reproduction.claims.repetition import Granted, Runs
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, around

TITLE = "Velocity variances of chains with gaps"
CAPTION = (
    "W_v^2 against the normalized particle number, L = 1000, for several gaps g between "
    "neighbouring rods at their anchors, in radii."
)

_RESTITUTIONS = (0.0, 0.75, 0.95)
_GAPS = (0.05, 0.2, 1.0)
_WIDE = 3.0  # a gap that hardly any rods cross, where only the motion in the centre is looked at
_GRANTED: Granted = {
    "quick": (4, {"duration": 80.0, "warmup": 50.0}),
    "full": (4, {"duration": 600.0, "warmup": 100.0}),
}
_claim = partial(
    Claim, source="appendix, fig:mom_var_gaps", ours="the gaps, the restitutions and the time step"
)
_THERE = f"dt = {OTHER_STEP:g}"
_FLAT = 0.1  # change of ln W_v^2 that still counts as a plateau


def _runs(restitution: float, gap: float) -> Runs:
    without = dissipative(LARGE, restitution)
    if gap == 0:
        return without
    chain = without.chain.replace(gap=gap)
    return Runs(f"{without.name} g={gap:g}", chain, _GRANTED, {"observe": ["widths"]})


_EVERY = [_runs(e, gap) for e in _RESTITUTIONS for gap in (0.0, *_GAPS)]
_ALMOST_FREE = [_runs(e, _WIDE) for e in _RESTITUTIONS]
cases = partial(all_of, [*_EVERY, *map(at_other_step, _EVERY), *_ALMOST_FREE])


def _measured(
    results: Results, restitution: float, gap: float, quantity: Callable[[xr.Dataset], float]
) -> tuple[Estimate, Estimate]:
    """Return the quantity at the default step and at the other one."""
    runs = _runs(restitution, gap)
    one, other = (each.estimate(results, quantity) for each in (runs, at_other_step(runs)))
    return one, other


def _change(run: xr.Dataset) -> float:
    """Ln of W_v^2 half-way to the border over that in the centre."""
    there = np.abs(np.abs(run.normalized_particle.values) - 0.5) < 0.05
    half_way = float((run.velocity_width.values[there] ** 2).mean())
    return float(np.log(half_way / central_width(run) ** 2))


def _border_layer(run: xr.Dataset) -> float:
    """Rods at a border, from the outermost one on, whose ln W_v^2 is ``_FLAT`` above the centre's.

    The mean of both borders counts. Single rods count too: with a large gap the layer has few.
    """
    variance = run.velocity_width.values**2
    inward = (variance + variance[::-1])[: run.sizes["particle"] // 2] / 2
    flat = np.log(inward / central_width(run) ** 2) <= _FLAT
    return float(flat.argmax()) if flat.any() else float(flat.size)


def _widening(results: Results, restitution: float) -> Claim:
    """Decide whether the plateau widens with every larger gap, by the least of the gains."""
    each = [_measured(results, restitution, gap, _border_layer) for gap in _GAPS]
    layers, again = zip(*each, strict=True)
    listed = ", ".join(f"{layer} at g = {gap:g}" for gap, layer in zip(_GAPS, layers, strict=True))
    return _claim(
        f"the larger the gap, the wider the plateau, e = {restitution:g}",
        f"rods at each border where ln W_v^2 is more than {_FLAT:g} above the centre's: {listed}; "
        "what the plateau gains at each border, at least:",
        found=_least_gain(layers),
        elsewhere={_THERE: _least_gain(again)},
        reason="at the larger gaps the plateau reaches the last rod or two already",
    )


def _least_gain(layers: Sequence[Estimate]) -> Estimate:
    gains = [narrow.minus(wide) for narrow, wide in itertools.pairwise(layers)]
    return min(gains, key=lambda gain: gain.value - 3 * gain.error)


def claims(results: Results) -> list[Claim]:
    """Check: a plateau with a gap, the wider the larger the gap, and free rods in it."""
    return [
        claim
        for restitution in _RESTITUTIONS
        for claim in (
            *_plateau(results, restitution),
            _widening(results, restitution),
            *_free_centre(results, restitution),
        )
    ]


def _free_centre(results: Results, restitution: float) -> list[Claim]:
    """Decide whether the centre moves like a free rod that is damped more strongly.

    Such a rod has less than the free width, and m <v^2> = k <(dx - <dx>)^2>.
    """
    gap, *others = reversed(_GAPS)
    balance, again = _measured(results, restitution, gap, _equipartition)
    damped, damped_again = _measured(results, restitution, gap, _damping)
    return [
        _claim(
            f"rods in the centre move like free ones, e = {restitution:g}",
            f"g = {gap:g}, ln of m W_v^2/(k W_x^2) in the centre, which is 0 for a free rod of any "
            "damping:",
            found=balance,
            within=around(0.0, _FLAT),
            elsewhere={
                f"g = {gap:g}, {_THERE}": again,
                **{
                    f"g = {other:g}": _runs(restitution, other).estimate(results, _equipartition)
                    for other in (*others, _WIDE)
                },
            },
            reason="with a small gap neighbours confine a rod more than its spring does",
        ),
        _claim(
            f"but with a larger dissipation, e = {restitution:g}",
            f"g = {gap:g}, ln of W^2/W_v^2 in the centre, that of the dissipation over gamma:",
            found=damped,
            elsewhere={_THERE: damped_again},
        ),
    ]


def _equipartition(run: xr.Dataset) -> float:
    ratio = central_width(run) / central_width(run, of="displacement_width")
    chain = chain_of(run)
    return float(np.log(chain.mass / chain.stiffness * ratio**2))


def _damping(run: xr.Dataset) -> float:
    return 2 * float(np.log(chain_of(run).free_velocity_width / central_width(run)))


def _plateau(results: Results, restitution: float) -> list[Claim]:
    what = "ln of W_v^2 half-way to the border over that in the centre:"
    found = {gap: _measured(results, restitution, gap, _change) for gap in (0.0, *_GAPS)}
    with_a_gap = [
        _claim(
            f"plateau in the interior, e = {restitution:g}, g = {gap:g}",
            what,
            found=found[gap][0],
            elsewhere={_THERE: found[gap][1]},
            within=around(0.0, _FLAT),
            reason="the gap is too small for the interior to become homogeneous",
        )
        for gap in _GAPS
    ]
    without, again = found[0.0]
    statement = f"no plateau without a gap, e = {restitution:g}"
    return [*with_a_gap, _claim(statement, what, found=without, elsewhere={_THERE: again})]


def draw(results: Results) -> Figure:
    """Draw W_v^2(i) for every gap, a panel a restitution."""
    figure, axes = panels(1, len(_RESTITUTIONS), sharey=True)
    for ax, restitution in zip(axes, _RESTITUTIONS, strict=True):
        ax.set_yscale("log")
        for number, gap in enumerate((0.0, *_GAPS)):
            runs = _runs(restitution, gap)
            run = runs.pooled(results)
            run = run.assign(
                velocity_variance=run.velocity_width**2,
                velocity_variance_error=2 * run.velocity_width * run.velocity_width_error,
            )
            unit, label = runs.chain.free_velocity_width**2, f"$g = {gap:g}$"
            draw_rods(ax, run, "velocity_variance", number=number, unit=unit, label=label)
        along_the_chain(ax)
        entitle(ax, f"$e = {restitution:g}$")
    axes[0].set_ylabel("velocity variance $W_v^2/W^2$")
    legend_above(figure, axes[0])
    return figure
