"""Figure 5: mean displacements, and their widths, of perfectly inelastic chains."""

from __future__ import annotations

import itertools
from functools import partial

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import along_the_chain, draw_rods
from crazybilliards.comparison.layout import panels
from crazybilliards.comparison.widths import central_width
from crazybilliards.reproduction.chains import LARGE, dissipative
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim

TITLE = "Mean displacements at e = 0"
CAPTION = (
    "(a) Mean displacement and (b) its width (the paper's inset) against the normalized particle "
    "number, e = 0, in units of the thermal length s."
)

_RUNS = {size: dissipative(size, 0.0) for size in (30, 100, 300, LARGE)}
cases = partial(all_of, _RUNS.values())


def swelling(run: xr.Dataset) -> float:
    """Return the slope of <dx> against i_n by least squares: all rods count."""
    place = run.normalized_particle.values
    return float(place @ run.mean_displacement.values / (place @ place))


def claims(results: Results) -> list[Claim]:
    """Check: displacements decrease with the size."""
    found = {size: runs.estimate(results, swelling) for size, runs in _RUNS.items()}
    confined = partial(central_width, of="displacement_width")
    spread = {size: runs.estimate(results, confined) for size, runs in _RUNS.items()}
    source, ours = "section seq:e_0, fig.3_2", "the sizes and the time step"
    return [
        claim
        for small, large in itertools.pairwise(_RUNS)
        for claim in (
            Claim(
                f"the mean displacement decreases from L = {small} to L = {large}",
                f"slope of <dx> against i_n: {found[small]} less {found[large]}, difference",
                found=found[small].minus(found[large]),
                source=source,
                ours=ours,
            ),
            Claim(
                f"the interior is confined more strongly at L = {large} than at L = {small}",
                f"W_x in the centre, middle tenth: {spread[small]} less {spread[large]}, "
                "difference",
                found=spread[small].minus(spread[large]),
                source=f"{source}, inset",
                ours=ours,
            ),
        )
    ]


def draw(results: Results) -> Figure:
    """Draw <dx> and W_x against i_n."""
    figure, axes = panels(1, 2)
    for number, (size, runs) in enumerate(_RUNS.items()):
        run = runs.pooled(results)
        s = runs.chain.thermal_length
        for ax, name in zip(axes, ("mean_displacement", "displacement_width"), strict=True):
            draw_rods(ax, run, name, number=number, unit=s, label=f"$L = {size}$")
    axes[0].set(ylabel=r"mean displacement $\langle\Delta x\rangle/s$")
    axes[1].set(ylabel="displacement width $W_x/s$")
    for ax in axes:
        along_the_chain(ax)
    axes[0].legend()
    return figure
