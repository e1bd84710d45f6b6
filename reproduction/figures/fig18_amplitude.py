"""Figure 18: the amplitude only sets the scale."""

from __future__ import annotations

from functools import partial

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import along_the_chain, draw_rods
from crazybilliards.comparison.layout import entitle, panels
from crazybilliards.model import chain_of
from crazybilliards.reproduction.chains import LARGE, dissipative
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, worst
from crazybilliards.reproduction.mirror_images import mirrored

TITLE = "The driving amplitude only sets the scale"
CAPTION = (
    "Velocity variance over A^2 and mean displacement over A against the normalized particle "
    "number, L = 1000, three amplitudes with random numbers of their own."
)

_RESTITUTIONS = (0.0, 0.95)
_AMPLITUDES = (1.0, 3.0, 10.0)
_DRAWN = ("velocity_variance", "mean_displacement")
_SCALED = {
    "velocity_variance": "W_v^2/A^2",
    "mean_displacement": "<dx>/A",
    "mean_square_displacement": "<dx^2>/A^2",
}
_LOGARITHMIC = ("velocity_variance",)  # axes; the others are linear
cases = partial(all_of, [dissipative(LARGE, e, a) for e in _RESTITUTIONS for a in _AMPLITUDES])


def _scaled(run: xr.Dataset) -> xr.Dataset:
    """Return W_v^2/A^2, <dx>/A and <dx^2>/A^2 with their errors."""
    amplitude = chain_of(run).amplitude
    error = 2 * run.velocity_width * run.velocity_width_error
    mean, width = run.mean_displacement, run.displacement_width
    square_error = 2 * np.hypot(
        mean * run.mean_displacement_error, width * run.displacement_width_error
    )
    return run.assign(
        velocity_variance=run.velocity_width**2 / amplitude**2,
        velocity_variance_error=error / amplitude**2,
        mean_square_displacement=(mean**2 + width**2) / amplitude**2,
        mean_square_displacement_error=square_error / amplitude**2,
        mean_displacement=run.mean_displacement / amplitude,
        mean_displacement_error=run.mean_displacement_error / amplitude,
    )


def claims(results: Results) -> list[Claim]:
    """Check: all amplitudes fall onto one curve."""
    return [_same(results, e, name) for e in _RESTITUTIONS for name in _SCALED]


def _same(results: Results, restitution: float, name: str) -> Claim:
    first, *others = (f"{a:g}" for a in _AMPLITUDES)
    axis = "logarithmic" if name in _LOGARITHMIC else "linear"
    return Claim(
        f"{_SCALED[name]} the same for all A, e = {restitution:g}",
        **worst(
            "mean over a tenth of the chain and its mirror image at "
            f"A = {' or '.join(others)} less that at A = {first}, as a share of the plotted range, "
            f"{axis} axis",
            _differences(results, restitution, name),
            EYE,
        ),
        source="appendix, fig:amp_influence",
        ours="the amplitudes and restitutions",
    )


def _differences(results: Results, restitution: float, name: str) -> list[Estimate]:
    """Return how tenths of the chain differ from those at the first amplitude, by the plot.

    A tenth is averaged with its mirror image. Neighbouring rods move together: the errors come from
    the scatter between runs.
    """

    def tenths(run: xr.Dataset) -> list[float]:
        both = _scaled(mirrored(run))[name].values
        means = [part.mean() for part in np.array_split(both[: both.size // 2], 5)]
        return list(np.log(means) if name in _LOGARITHMIC else means)

    reference, *others = (
        dissipative(LARGE, restitution, a).estimates(results, tenths) for a in _AMPLITUDES
    )
    plotted = _scaled(dissipative(LARGE, restitution).pooled(results))[name].values
    span = float(np.ptp(np.log(plotted) if name in _LOGARITHMIC else plotted))
    return [
        Estimate(difference.value / span, difference.error / span)
        for other in others
        for difference in (one.minus(first) for one, first in zip(other, reference, strict=True))
    ]


def draw(results: Results) -> Figure:
    """Draw both quantities for both restitutions."""
    figure, axes = panels(2, 2, height=2.3)
    labels = (r"$W_v^2/A^2$ [1/(M T)]", r"$\langle\Delta x\rangle/A$ [T$^{3/2}$/M]")
    for row, restitution in zip((axes[:2], axes[2:]), _RESTITUTIONS, strict=True):
        row[0].set_yscale("log")
        for number, amplitude in enumerate(_AMPLITUDES):
            scaled = _scaled(dissipative(LARGE, restitution, amplitude).pooled(results))
            for ax, name, label in zip(row, _DRAWN, labels, strict=True):
                draw_rods(ax, scaled, name, number=number, label=f"$A = {amplitude:g}$")
                ax.set_ylabel(label)
        for ax in row:
            along_the_chain(ax)
            entitle(ax, f"$e = {restitution:g}$")
    axes[0].legend()
    return figure
