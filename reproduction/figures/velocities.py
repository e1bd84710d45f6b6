"""Figures 2, 10 and 11: distributions of velocities at e = 0 and of flippers."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from scipy.optimize import curve_fit

from crazybilliards.comparison.drawing import legend_above, panels
from crazybilliards.model import Array, chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction import chains, distributions
from crazybilliards.reproduction.claims.study import Results, Runs, Study
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, at_choices, in_plot
from crazybilliards.reproduction.fits import tail_length
from crazybilliards.reproduction.profiles import border_width, central_width


def _draw(results: Results, runs: Runs, particles: Sequence[int]) -> Figure:
    figure, [ax] = panels(1, 1, height=2.9)
    distributions.draw_distributions(ax, runs.members(results), particles)
    legend_above(figure, ax)
    return figure


# -- figure 2: the perfectly inelastic chain --------------------------------------------------

_BULK = range(1, chains.LARGE + 1)[middle_tenth(chains.LARGE)]
_WIDTHS_SHOWN = 5.0  # to either side in the plot of a distribution
_INELASTIC = {step: group[chains.LARGE] for step, group in chains.inelastic([chains.LARGE]).items()}


def _misfit_of_gaussian(runs: Sequence[xr.Dataset]) -> float:
    """Return how far p(v) in the bulk is off its best Gaussian, as a share of the plot."""

    def model(v: Array, height: float, centre: float, width: float) -> Array:
        return np.asarray(height * np.exp(-(((v - centre) / width) ** 2) / 2))

    width = float(np.sqrt(np.mean([central_width(run) ** 2 for run in runs])))
    v, p = distributions.histogram(runs, _BULK, _WIDTHS_SHOWN * width)
    values, _ = curve_fit(model, v, p, p0=(float(p.max()), 0.0, width))
    return distributions.distance_in_plot(v, p, lambda v: model(v, *values), _WIDTHS_SHOWN * width)


def _outward_skewness(run: xr.Dataset) -> float:
    """Return that of the outer three rods; the mirror image of the left end is the right end."""
    ends = range(1, 4), range(chains.LARGE - 2, chains.LARGE + 1)
    left, right = (distributions.mean_shape(run, end, "velocity_skewness") for end in ends)
    return (right - left) / 2


def _claims_inelastic(results: Results) -> list[Claim]:
    def of_each(quantity: chains.Quantity) -> dict[str, Estimate]:
        return {step: runs.estimate(results, quantity) for step, runs in _INELASTIC.items()}

    def misfit(runs: Runs) -> dict[str, Any]:
        return in_plot(
            "p(v) of the middle hundred rods and the Gaussian of best height, centre and width, "
            f"both axes linear, v to {_WIDTHS_SHOWN:g} widths",
            runs.estimate_together(results, _misfit_of_gaussian),
        )

    skewness, border, centre = map(of_each, (_outward_skewness, border_width, central_width))
    peaks = of_each(lambda run: distributions.mean_shape(run, _BULK, "velocity_kurtosis"))
    ours = peaks.pop(chains.DEFAULT)
    unit = _INELASTIC[chains.DEFAULT].chain.free_velocity_width
    narrowing = {step: border[step].minus(centre[step]).times(1 / unit) for step in border}
    claim = partial(Claim, source="section seq:e_0, fig.1")
    return [
        claim(
            "in the bulk the distributions can be fitted by Gaussians",
            **at_choices(_INELASTIC, misfit),
            ours="the time step, and whether the axes are linear",
            reason="the shorter the step, the more peaked is the distribution and the longer are "
            "its tails, while the kicks of a long step, which are Gaussian, hide this; excess "
            f"kurtosis {ours} at the {chains.DEFAULT}, "
            + ", ".join(f"{step}: {kurtosis}" for step, kurtosis in peaks.items()),
        ),
        claim(
            "close to the border the distributions are slightly skewed",
            f"skewness of the outer three rods {skewness[chains.DEFAULT]}, outward positive; its "
            "magnitude",
            **at_choices(skewness, lambda one: Estimate(abs(one.value), one.error)),
        ),
        claim(
            "narrower inside than at the border",
            "(W_v(border) - W_v(centre))/W =",
            **at_choices(narrowing, lambda one: one),
        ),
    ]


INELASTIC = Study(
    number=2,
    name="velocities-inelastic",
    title="Velocity distributions at e = 0",
    caption="L = 1000, e = 0. Symbols: simulation, rods i from the border to the centre. Lines: "
    "Gaussians of the same width. Dotted: a free rod. Error bars: standard errors from independent "
    "runs. Velocities in units of the free width W.",
    needs=list(_INELASTIC.values()),
    claims=_claims_inelastic,
    draw=partial(_draw, runs=_INELASTIC[chains.DEFAULT], particles=(1, 10, 100, 500)),
)

# -- figures 10 and 11: flippers --------------------------------------------------------------

_SIZE = 100
_WEAK, _STRONG = 4.0, 10.0
_FLIPPERS = chains.at_both_steps({g: chains.flippers(_SIZE, g) for g in (_WEAK, _STRONG)})
_FLIPPERS_SHOWN = (1, 10, 50)
_TAIL = 3.0  # widths of the rod, where the tail begins


def _border_density(run: xr.Dataset) -> tuple[Array, Array]:
    """Return outward speeds, descending, and p(v) of a border rod: the mean of both borders."""
    v, p = run.velocity_bin.values, run.velocity_density
    density = (p.sel(particle=1).values + p.sel(particle=_SIZE).values[::-1]) / 2
    return v[v < 0], density[v < 0]  # the leftmost rod is thrown to the left


def _tail_ratio(run: xr.Dataset) -> float:
    """Length of the border's outward tail far out over that nearer by: 1 if exponential."""
    far, near = (tail_length(*_border_density(run), w * border_width(run)) for w in (5, _TAIL))
    return far / near


def _widening(run: xr.Dataset) -> float:
    return (border_width(run) - central_width(run)) / chain_of(run).free_velocity_width


def _claims_weakly_damped(results: Results) -> list[Claim]:
    runs = _FLIPPERS[chains.DEFAULT][_WEAK]
    unit = runs.chain.free_velocity_width
    peak = partial(distributions.mean_shape, particles=(1, _SIZE), name="velocity_kurtosis")
    kurtosis = runs.estimate(results, peak)
    ratio = runs.estimate(results, _tail_ratio)
    measured = partial(chains.at_steps, results, _FLIPPERS, _WEAK)
    source = "section Anti-Dissipation, fig:mom_hist_antidiss_gamma4"
    return [
        Claim(
            "every rod is faster than a free one",
            "W_v/W of the slowest rod less 1:",
            **measured(lambda run: float(run.velocity_width.min()) / unit - 1.0),
            source=source,
        ),
        Claim(
            "large velocities are likelier at the border than in the centre",
            "(W_v(border) - W_v(centre))/W =",
            **measured(_widening),
            source=source,
        ),
        Claim(
            "the tail at the border falls off exponentially",
            f"excess kurtosis {kurtosis}; length of the tail beyond 5 W_v over that beyond 3 W_v "
            f"{ratio} (exponential: 1, Gaussian: 0.65), less half-way between the two",
            **measured(lambda run: _tail_ratio(run) - 0.825),
            source=f"{source}, inset",
            reason="the tail falls off faster than an exponential",
        ),
    ]


def _draw_weakly_damped(results: Results) -> Figure:
    runs = _FLIPPERS[chains.DEFAULT][_WEAK].members(results)
    figure, [ax] = panels(1, 1, height=2.9)
    distributions.draw_distributions(ax, runs, _FLIPPERS_SHOWN)
    both = [_border_density(run) for run in runs]
    v, p = both[0][0], np.mean([density for _, density in both], axis=0)
    begin = _TAIL * float(np.sqrt(np.mean([border_width(run) ** 2 for run in runs])))
    length = tail_length(v, p, begin)
    share = float((p * np.gradient(v))[v < -begin].sum())
    out = np.linspace(begin, begin + 7 * length, 50)
    tail = share / length * np.exp(-(out - begin) / length)
    unit = chain_of(runs[0]).free_velocity_width
    ax.plot(-out / unit, tail * unit, "--", color="0.3", label="exponential tail")
    legend_above(figure, ax)
    return figure


WEAKLY_DAMPED = Study(
    number=10,
    name="velocities-flippers",
    title="Velocity distributions at e = 1.05, gamma = 4",
    caption="L = 100, e = 1.05, gamma = 4. Symbols: simulation. Lines: Gaussians of the same "
    "width. Dashed: an exponential of the border's mean excess over three widths. Dotted: a free "
    "rod. Error bars: standard errors from independent runs.",
    needs=[group[_WEAK] for group in _FLIPPERS.values()],
    claims=_claims_weakly_damped,
    draw=_draw_weakly_damped,
)
STRONGLY_DAMPED = Study(
    number=11,
    name="velocities-flippers-damped",
    title="Velocity distributions at e = 1.05, gamma = 10",
    caption="L = 100, e = 1.05, gamma = 10. Symbols: simulation. Lines: Gaussians of the same "
    "width. Dotted: a free rod. Error bars: standard errors from independent runs.",
    needs=[group[_STRONG] for group in _FLIPPERS.values()],
    claims=lambda results: [
        Claim(
            "large velocities are likelier in the centre than at the border",
            "(W_v(centre) - W_v(border))/W =",
            **chains.at_steps(results, _FLIPPERS, _STRONG, lambda run: -_widening(run)),
            source="section Anti-Dissipation, fig:mom_hist_antidiss_gamma10",
        )
    ],
    draw=partial(_draw, runs=_FLIPPERS[chains.DEFAULT][_STRONG], particles=_FLIPPERS_SHOWN),
)
