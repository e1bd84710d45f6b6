"""Figures 18 and 19, of the paper's appendix: what the amplitude and the gap change."""

import itertools
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import (
    along_the_chain,
    draw_rods,
    entitle,
    legend_above,
    panels,
)
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction import chains
from crazybilliards.reproduction.claims.study import Results, Runs, Study, effort
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, at_choices, worst
from crazybilliards.reproduction.profiles import central_width, mirrored

# -- figure 18: the amplitude only sets the scale ---------------------------------------------

_AMPLITUDES = (1.0, 3.0, 10.0)
# Of the quantities over powers of A: how they are called, and their axes.
_SCALED = {
    "velocity_variance": ("W_v^2/A^2", "logarithmic"),
    "mean_displacement": ("<dx>/A", "linear"),
    "mean_square_displacement": ("<dx^2>/A^2", "linear"),
}
_BY_AMPLITUDE = {
    e: {amplitude: chains.dissipative(chains.LARGE, e, amplitude) for amplitude in _AMPLITUDES}
    for e in (0.0, 0.95)
}


def _scaled(run: xr.Dataset) -> xr.Dataset:
    """Return W_v^2/A^2, <dx>/A and <dx^2>/A^2, the first two with their errors."""
    a, mean, width = chain_of(run).amplitude, run.mean_displacement, run.velocity_width
    return run.assign(
        velocity_variance=width**2 / a**2,
        velocity_variance_error=2 * width * run.velocity_width_error / a**2,
        mean_square_displacement=(mean**2 + run.displacement_width**2) / a**2,
        mean_displacement=mean / a,
        mean_displacement_error=run.mean_displacement_error / a,
    )


def _claims_of_amplitude(results: Results) -> list[Claim]:
    first, *others = (f"{amplitude:g}" for amplitude in _AMPLITUDES)
    quantity = (
        f"mean over a tenth of the chain and its mirror image at A = {' or '.join(others)} less "
        f"that at A = {first}, as a share of the plotted range"
    )
    return [
        Claim(
            f"{symbol} the same for all A, e = {e:g}",
            **worst(f"{quantity}, {axis} axis", _differences(results, e, name), EYE),
            source="appendix, fig:amp_influence",
            ours="the amplitudes and restitutions",
        )
        for e in _BY_AMPLITUDE
        for name, (symbol, axis) in _SCALED.items()
    ]


def _differences(results: Results, restitution: float, name: str) -> list[Estimate]:
    """Return how tenths of the chain differ from those at the first amplitude, by the plot."""
    axis = np.log if _SCALED[name][1] == "logarithmic" else np.asarray

    def tenths(run: xr.Dataset) -> Any:
        both = _scaled(mirrored(run))[name].values
        return axis([part.mean() for part in np.array_split(both[: both.size // 2], 5)])

    group = _BY_AMPLITUDE[restitution].values()
    reference, *others = (runs.estimates(results, tenths) for runs in group)
    span = float(np.ptp(axis(_scaled(next(iter(group)).mean(results))[name].values)))
    return [
        tenth.minus(first).times(1 / span)
        for other in others
        for tenth, first in zip(other, reference, strict=True)
    ]


def _draw_amplitude(results: Results) -> Figure:
    figure, axes = panels(2, 2, height=2.3)
    labels = {
        "velocity_variance": r"$W_v^2/A^2$ [1/(M $t_0$)]",
        "mean_displacement": r"$\langle\Delta x\rangle/A$ [$t_0^{3/2}$/M]",
    }
    for row, (e, group) in zip((axes[:2], axes[2:]), _BY_AMPLITUDE.items(), strict=True):
        row[0].set_yscale("log")
        scaled = {f"$A = {a:g}$": _scaled(runs.mean(results)) for a, runs in group.items()}
        for ax, (name, label) in zip(row, labels.items(), strict=True):
            for number, (amplitude, run) in enumerate(scaled.items()):
                draw_rods(ax, run, name, number=number, label=amplitude)
            along_the_chain(ax)
            ax.set_ylabel(label)
            entitle(ax, f"$e = {e:g}$")
    axes[0].legend()
    return figure


AMPLITUDE = Study(
    number=18,
    name="amplitude",
    title="The driving amplitude only sets the scale",
    caption="Velocity variance over A^2 and mean displacement over A against the normalized "
    "particle number, L = 1000, three amplitudes with random numbers of their own.",
    needs=chains.all_of(_BY_AMPLITUDE),
    claims=_claims_of_amplitude,
    draw=_draw_amplitude,
)

# -- figure 19: a plateau in the interior of chains with gaps ---------------------------------

_GAPS = (0.05, 0.2, 1.0)
_WIDE = 3.0  # a gap that hardly any rods cross, where only the motion in the centre is looked at
_FLAT = 0.1  # change of ln W_v^2 that still counts as a plateau
_claim = partial(
    Claim, source="appendix, fig:mom_var_gaps", ours="the gaps, the restitutions and the time step"
)


def _with_gap(restitution: float, gap: float) -> Runs:
    without = chains.dissipative(chains.LARGE, restitution)
    if gap == 0:
        return without
    return Runs(
        f"{without.name} g={gap:g}",
        without.chain.replace(gap=gap),
        effort((4, 80, 50), (4, 600, 100)),
        {"observe": ["widths"]},
    )


# By restitution: by time step, the runs by their gaps.
_BY_GAP = {
    e: chains.at_both_steps({gap: _with_gap(e, gap) for gap in (0.0, *_GAPS)})
    for e in (0.0, 0.75, 0.95)
}
_ALMOST_FREE = {e: _with_gap(e, _WIDE) for e in _BY_GAP}


def _change(run: xr.Dataset) -> float:
    """Ln of W_v^2 half-way to the border over that in the centre."""
    half_way = np.abs(np.abs(run.normalized_particle.values) - 0.5) < 0.05
    variance = float((run.velocity_width.values[half_way] ** 2).mean())
    return float(np.log(variance / central_width(run) ** 2))


def _border_layer(run: xr.Dataset) -> float:
    """Rods from the border on, the mean of both, whose ln W_v^2 is above the plateau's."""
    variance = run.velocity_width.values**2
    inward = (variance + variance[::-1])[: run.sizes["particle"] // 2] / 2
    flat = np.log(inward / central_width(run) ** 2) <= _FLAT
    return float(flat.argmax()) if flat.any() else float(flat.size)


def _equipartition(run: xr.Dataset) -> float:
    """Ln of m W_v^2/(k W_x^2) in the centre."""
    chain = chain_of(run)
    ratio = central_width(run) / central_width(run, of="displacement_width")
    return float(np.log(chain.mass / chain.stiffness * ratio**2))


def _dissipation(run: xr.Dataset) -> float:
    """Ln of W^2/W_v^2 in the centre."""
    return 2 * float(np.log(chain_of(run).free_velocity_width / central_width(run)))


def _plateau_claim(results: Results, e: float, gap: float) -> Claim:
    about = chains.at_steps(results, _BY_GAP[e], gap, _change)
    statement = f"no plateau without a gap, e = {e:g}"
    if gap > 0:
        statement = f"plateau in the interior, e = {e:g}, g = {gap:g}"
        about["within"] = (-_FLAT, _FLAT)
        about["reason"] = "the gap is too small for the interior to become homogeneous"
    return _claim(statement, "ln of W_v^2 half-way to the border over that in the centre:", **about)


def _widening_claim(results: Results, e: float) -> Claim:
    """Decide whether the plateau widens with every larger gap, by the least of the gains."""
    layers = {
        step: [group[gap].estimate(results, _border_layer) for gap in _GAPS]
        for step, group in _BY_GAP[e].items()
    }

    def least_gain(widths: list[Estimate]) -> Estimate:
        gains = [narrow.minus(wide) for narrow, wide in itertools.pairwise(widths)]
        return min(gains, key=lambda gain: gain.value - 3 * gain.error)

    ours = zip(_GAPS, layers[chains.DEFAULT], strict=True)
    listed = ", ".join(f"{layer} at g = {gap:g}" for gap, layer in ours)
    return _claim(
        f"the larger the gap, the wider the plateau, e = {e:g}",
        f"rods at each border where ln W_v^2 is more than {_FLAT:g} above the centre's: {listed}; "
        "what the plateau gains at each border, at least:",
        **at_choices(layers, least_gain),
        reason="at the larger gaps the plateau reaches the last rod or two already",
    )


def _claims_of_gap(results: Results, e: float) -> list[Claim]:
    gap, *others = reversed(_GAPS)
    ours, other = _BY_GAP[e].values()
    of_gaps = {f"g = {gap:g}": ours[gap], f"g = {gap:g}, {chains.OTHER}": other[gap]}
    of_gaps |= {f"g = {g:g}": ours[g] for g in others} | {f"g = {_WIDE:g}": _ALMOST_FREE[e]}
    return [
        *(_plateau_claim(results, e, gap) for gap in (*_GAPS, 0.0)),
        _widening_claim(results, e),
        _claim(
            f"rods in the centre move like free ones, e = {e:g}",
            f"g = {gap:g}, ln of m W_v^2/(k W_x^2) in the centre, which is 0 for a free rod of any "
            "damping:",
            **at_choices(of_gaps, lambda runs: runs.estimate(results, _equipartition)),
            within=(-_FLAT, _FLAT),
            reason="with a small gap neighbours confine a rod more than its spring does",
        ),
        _claim(
            f"but with a larger dissipation, e = {e:g}",
            f"g = {gap:g}, ln of W^2/W_v^2 in the centre, that of the dissipation over gamma:",
            **chains.at_steps(results, _BY_GAP[e], gap, _dissipation),
        ),
    ]


def _draw_gap(results: Results) -> Figure:
    figure, axes = panels(1, len(_BY_GAP), sharey=True)
    unit = Chain().free_velocity_width ** 2
    for ax, (e, steps) in zip(axes, _BY_GAP.items(), strict=True):
        ax.set_yscale("log")
        for number, (gap, runs) in enumerate(steps[chains.DEFAULT].items()):
            run, label = _scaled(runs.mean(results)), f"$g = {gap:g}$"
            draw_rods(ax, run, "velocity_variance", number=number, unit=unit, label=label)
        along_the_chain(ax)
        entitle(ax, f"$e = {e:g}$")
    axes[0].set_ylabel("velocity variance $W_v^2/W^2$")
    legend_above(figure, axes[0])
    return figure


GAP = Study(
    number=19,
    name="gap",
    title="Velocity variances of chains with gaps",
    caption="W_v^2 against the normalized particle number, L = 1000, for several gaps g between "
    "neighbouring rods at their anchors, in units of R.",
    needs=[runs for steps in _BY_GAP.values() for runs in chains.all_of(steps)]
    + list(_ALMOST_FREE.values()),
    claims=lambda results: [claim for e in _BY_GAP for claim in _claims_of_gap(results, e)],
    draw=_draw_gap,
)
