"""Figure 5: mean displacements, and their widths, of perfectly inelastic chains."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import partial

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import along_the_chain, draw_rods
from crazybilliards.comparison.layout import panels
from crazybilliards.comparison.widths import central_width
from crazybilliards.reproduction.chains import LARGE, STEPS, at_step, at_steps
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate

TITLE = "Mean displacements at e = 0"
CAPTION = (
    "(a) Mean displacement and (b) its width (the paper's inset) against the normalized particle "
    "number, e = 0, in units of the thermal length s."
)

_SIZES = (30, 100, 300, LARGE)
_RUNS = {size: at_step(size, None) for size in _SIZES}  # at the default step
cases = partial(all_of, at_steps(_SIZES))


def swelling(run: xr.Dataset) -> float:
    """Return the slope of <dx> against i_n by least squares: all rods count."""
    place = run.normalized_particle.values
    return float(place @ run.mean_displacement.values / (place @ place))


def claims(results: Results) -> list[Claim]:
    """Check: displacements decrease with the size."""
    confined = partial(central_width, of="displacement_width")
    source = "section seq:e_0, fig.3_2"
    return [
        claim
        for small, large in itertools.pairwise(_SIZES)
        for claim in (
            _decrease(
                results,
                swelling,
                (small, large),
                f"the mean displacement decreases from L = {small} to L = {large}",
                "slope of <dx> against i_n",
                source,
            ),
            _decrease(
                results,
                confined,
                (small, large),
                f"the interior is confined more strongly at L = {large} than at L = {small}",
                "W_x in the centre, middle tenth",
                f"{source}, inset",
            ),
        )
    ]


def _decrease(
    results: Results,
    quantity: Callable[[xr.Dataset], float],
    sizes: tuple[int, int],
    statement: str,
    what: str,
    source: str,
) -> Claim:
    """Decide at all time steps whether a quantity decreases from one size to the next."""

    def at(step: float | None) -> list[Estimate]:
        return [at_step(size, step).estimate(results, quantity) for size in sizes]

    one, other = at(None)
    return Claim(
        statement,
        f"{what}: {one} less {other}, difference",
        found=one.minus(other),
        source=source,
        ours="the sizes and the time step",
        elsewhere={f"dt = {step:g}": Estimate.minus(*at(step)) for step in STEPS},
    )


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
