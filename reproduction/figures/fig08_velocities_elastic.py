"""Figure 8: at e = 1 every rod has the velocity distribution of a free one."""

from __future__ import annotations

from functools import partial

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import along_the_chain, draw_rods
from crazybilliards.comparison.layout import entitle, panels
from crazybilliards.model import Chain
from crazybilliards.reproduction.chains import LARGE, elastic
from crazybilliards.reproduction.claims.repetition import Granted, Runs
from crazybilliards.reproduction.claims.study import Results, all_of
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, in_plot, worst
from crazybilliards.reproduction.distributions import (
    draw_distributions,
    gaussian,
    histogram,
    off_in_plot,
)

TITLE = "Velocity distributions at e = 1"
CAPTION = (
    "(a) Symbols: simulated rods 1 and 50 of 100, with standard errors. Dotted: the exact "
    "distribution, that of a free rod. (b) W_v of 1000 rods, exact at any step with event-driven "
    "collisions, wrong with Contact Dynamics at steps that are affordable."
)

_SIZE = 100
_RUNS = elastic(_SIZE)
_PARTICLES = (1, 50)
_LONG: Granted = {"quick": (4, {"duration": 2000.0}), "full": (4, {"duration": 2000.0})}
# Contact Dynamics is off by far more, and its steps are short.
_SHORT: Granted = {
    "quick": (4, {"duration": 50.0, "warmup": 30.0}),
    "full": (4, {"duration": 200.0}),
}
_SHOWN = 4.0  # free widths to either side in the plot of a distribution
_SOURCE = "section seq:e_larger, fig.4.2"
_STEPS = (1e-2, 1e-3)  # of Contact Dynamics
_EXACT = Runs("long chain, event-driven", Chain(size=LARGE), _LONG, {"observe": ["widths"]})
_CONTACT = {
    step: Runs(
        f"long chain, Contact Dynamics, dt={step:g}",
        _EXACT.chain,
        _SHORT,
        {"method": "contact-dynamics", "time_step": step, **_EXACT.settings},
    )
    for step in _STEPS
}
cases = partial(all_of, [_RUNS, _EXACT, *_CONTACT.values()])


def claims(results: Results) -> list[Claim]:
    """Check: identical to the free Gaussian."""
    run = _RUNS.pooled(results)
    unit = _RUNS.chain.free_velocity_width
    shares = (run.velocity_width / unit - 1, run.velocity_width_error / unit)
    return [
        Claim(
            "W_v of every rod is that of a free rod",
            **worst("W_v/W - 1 of a rod", map(Estimate, *(each.values for each in shares)), EYE),
            source=_SOURCE,
        ),
        Claim(
            "the distributions of rods 1 and 50 are a free rod's Gaussian",
            **in_plot(
                f"p(v) and the free rod's, both axes linear, v to {_SHOWN:g} W",
                Estimate(_off(run), _RUNS.estimate(results, _off).error),
            ),
            source=_SOURCE,
        ),
    ]


def _off(run: xr.Dataset) -> float:
    """Return how far p(v) is off the free rod's, as a share of the plot: the worse of two rods."""
    unit = _RUNS.chain.free_velocity_width
    reach = _SHOWN * unit
    densities = [histogram(run, [particle], reach) for particle in _PARTICLES]
    return max(off_in_plot(v, p, lambda v: gaussian(v, unit), reach) for v, p in densities)


def draw(results: Results) -> Figure:
    """Draw p(v) of two rods, and W_v of long chains by three methods."""
    figure, (left, right) = panels(1, 2, height=2.7)
    draw_distributions(left, _RUNS.members(results), _PARTICLES)
    entitle(left, f"$L = {_SIZE}$")
    left.legend(loc="lower center")
    _draw_long_chains(right, results)
    return figure


def _draw_long_chains(ax: Axes, results: Results) -> None:
    shown = {"event-driven": _EXACT}
    shown |= {f"Contact Dyn., $dt = {step:g}$": runs for step, runs in _CONTACT.items()}
    for number, (label, runs) in enumerate(shown.items()):
        run = runs.pooled(results)
        unit = runs.chain.free_velocity_width
        draw_rods(ax, run, "velocity_width", number=number, unit=unit, label=label)
    ax.axhline(1, color="black", linestyle=":", label="exact")
    along_the_chain(ax)
    ax.set(ylabel="velocity width $W_v/W$")
    entitle(ax, f"$L = {LARGE}$")
    ax.legend(loc="center")
