"""Figures 8, 16 and 17: velocities, displacements and density of the elastic chain."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.distances import deviation, distances_in_plot
from crazybilliards.comparison.drawing import (
    along_the_chain,
    draw_points,
    draw_rods,
    entitle,
    panels,
)
from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.side_by_side.grid import ELASTIC, elastic_tree
from crazybilliards.comparison.side_by_side.grid_figures import draw_density
from crazybilliards.comparison.stationary_theories import TITLES
from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction import chains, distributions
from crazybilliards.reproduction.claims.study import Results, Runs, Study, effort
from crazybilliards.reproduction.claims.verdicts import (
    EYE,
    Claim,
    Estimate,
    furthest_in_plot,
    in_plot,
    worst,
)

# -- figure 8: velocities --------------------------------------------------------------

_UNIT = chains.ELASTIC.chain.free_velocity_width
_RODS = (1, 50)
_SHOWN = 4.0  # free widths to either side in the plot of a distribution
_LONG = Runs(
    "long chain", Chain(size=chains.LARGE), effort((4, 2000), (4, 2000)), {"observe": ["widths"]}
)
_METHODS = {"event-driven": _LONG} | {
    f"Contact Dyn., $dt = {step:g}$": replace(
        _LONG,
        name=f"long chain, Contact Dynamics, dt={step:g}",
        effort=effort((4, 50, 30), (4, 200)),  # it is off by far more
        settings={"method": "contact-dynamics", "time_step": step, "observe": ["widths"]},
    )
    for step in (1e-2, 1e-3)
}


def _distance_from_free_rod(runs: Sequence[xr.Dataset]) -> float:
    """Return how far p(v) is off the free rod's, as a share of the plot: the worse of two rods."""
    densities = [distributions.histogram(runs, [particle], _SHOWN * _UNIT) for particle in _RODS]
    law = partial(distributions.gaussian, width=_UNIT)
    return max(distributions.distance_in_plot(v, p, law, _SHOWN * _UNIT) for v, p in densities)


def _claims_of_velocities(results: Results) -> list[Claim]:
    claim = partial(Claim, source="section seq:e_larger, fig.4.2")
    run = chains.ELASTIC.mean(results)
    differences, errors = run.velocity_width / _UNIT - 1, run.velocity_width_error / _UNIT
    distance = chains.ELASTIC.estimate_together(results, _distance_from_free_rod)
    return [
        claim(
            "W_v of every rod is that of a free rod",
            **worst("W_v/W - 1 of a rod", map(Estimate, differences.values, errors.values), EYE),
        ),
        claim(
            "the distributions of rods 1 and 50 are a free rod's Gaussian",
            **in_plot(f"p(v) and the free rod's, both axes linear, v to {_SHOWN:g} W", distance),
        ),
    ]


def _draw_velocities(results: Results) -> Figure:
    figure, (left, right) = panels(1, 2, height=2.7)
    distributions.draw_distributions(left, chains.ELASTIC.members(results), _RODS)
    entitle(left, f"$L = {chains.ELASTIC.chain.size}$")
    left.legend(loc="lower center")
    for number, (label, runs) in enumerate(_METHODS.items()):
        run = runs.mean(results)
        draw_rods(right, run, "velocity_width", number=number, unit=_UNIT, label=label)
    right.axhline(1, color="black", linestyle=":", label=TITLES["equilibrium"])
    along_the_chain(right)
    right.set(ylabel="velocity width $W_v/W$")
    entitle(right, f"$L = {chains.LARGE}$")
    right.legend(loc="center")
    return figure


VELOCITIES = Study(
    number=8,
    name="velocities-elastic",
    title="Velocity distributions at e = 1",
    caption="(a) Symbols: simulated rods 1 and 50 of 100, with standard errors. Dotted: the exact "
    "distribution, that of a free rod. (b) W_v of 1000 rods, exact at any step with event-driven "
    "collisions, wrong with Contact Dynamics at steps that are affordable.",
    needs=[chains.ELASTIC, *_METHODS.values()],
    claims=_claims_of_velocities,
    draw=_draw_velocities,
)

# -- figures 16 and 17: the runs --------------------------------------------------------------

_ARCTANH = 10.0  # the amplitude of the paper's arctanh fit, fig:atan
# By amplitude. Displacements are compared to half a per cent (figure 16), densities to one of close
# packing. Some seconds at either quality, because elastic rods are flown exactly.
_DURATIONS = {1.0: 250_000, 3.0: 250_000, _ARCTANH: 1_000_000, 30.0: 250_000}
_RUNS = {
    amplitude: Runs(
        f"amplitude_{amplitude:g}",
        Chain(size=100, amplitude=amplitude),
        effort((1, duration), (1, duration)),
        {"observe": ["widths", "density"]},
    )
    for amplitude, duration in _DURATIONS.items()
}


def _run(results: Results, amplitude: float) -> xr.Dataset:
    [run] = _RUNS[amplitude].members(results)
    return run


# -- figure 16: the arctanh -------------------------------------------------------------------


def _claims_of_displacement(results: Results) -> list[Claim]:
    run = _run(results, _ARCTANH)
    fit, s = fit_arctanh(run), chain_of(run).thermal_length
    x, displacement = run.mean_position.values, run.mean_displacement.values
    errors = run.mean_displacement_error.values
    fine = np.linspace(x[0], x[-1], 4001)
    distances = distances_in_plot(x, displacement, fine, fit(fine))
    return [
        Claim(
            "<dx> is described by B arctanh(C x)",
            **in_plot(
                f"B = {fit.scale / s:.4f} s, C = {fit.steepness:.5f}/R, all rods, both axes linear",
                furthest_in_plot(distances, errors / np.ptp(displacement)),
                float((np.abs(displacement - fit(x)) / errors).max()),
            ),
            source="section seq:analytics, fig:atan",
            reason="the curve misses the outermost rods",
        )
    ]


def _draw_displacement(results: Results) -> Figure:
    run = _run(results, _ARCTANH)
    s, x = chain_of(run).thermal_length, run.mean_position.values
    measured, error = run.mean_displacement.values / s, run.mean_displacement_error.values / s
    exact, fitted = equilibrium(chain_of(run)).mean_displacement.values / s, fit_arctanh(run)(x) / s
    figure, (top, bottom) = panels(2, 1, height=1.7, sharex=True, height_ratios=(2, 1))
    draw_points(top, x, measured, error, number=0, color="black", linewidth=0.7, label="simulation")
    lines = ((TITLES["equilibrium"], exact, "C1-"), ("arctanh fit", fitted, "C0--"))
    for label, curve, style in lines:
        top.plot(x, curve, style, label=label)
        bottom.plot(x, curve - measured, style)
    bottom.fill_between(x, -error, error, color="0.8", label="one standard error")
    bottom.legend(loc="lower center")
    top.set(ylabel=r"displacement $\langle\Delta x\rangle/s$")
    bottom.set(xlabel=r"mean position $\langle x_i\rangle$ [R]", ylabel="curve less\nsimulation")
    top.legend()
    return figure


ARCTANH = Study(
    number=16,
    name="arctanh",
    title="The mean displacement at e = 1 and its arctanh fit",
    caption="L = 100, e = 1, A = 10. (b) Curves less simulation; grey: one standard error. s is "
    "the thermal length.",
    needs=[_RUNS[_ARCTANH]],
    claims=_claims_of_displacement,
    draw=_draw_displacement,
)

# -- figure 17: the density -------------------------------------------------------------------


def _match(results: Results, amplitude: float) -> Claim:
    """Compare the theory fed with the fitted displacement with the simulated density."""
    run = _run(results, amplitude)
    theory = smooth(force_balance(chain_of(run), displacement=fit_arctanh(run)))
    run = smooth(run)
    apart, x, rho = deviation(run, theory), run.x.values, run.density.values
    line = np.interp(x, theory.x.values, theory.density.values, left=0.0, right=0.0)
    drawn = np.maximum(rho, line) > 1e-3 * chain_of(run).close_packed_density
    height = (0.0, float(rho.max()))
    distances = distances_in_plot(x[drawn], rho[drawn], x[drawn], line[drawn], y_range=height)
    known = ", which is that of fig:atan" if amplitude == _ARCTANH else ""
    return Claim(
        f"simulated and integrated densities match perfectly, A = {amplitude:g}",
        **in_plot(
            "rho(x) of simulation and theory, fed with the fitted displacement, both axes linear, "
            f"vertically up to {100 * apart.maximum:.2f} % of close packing apart",
            furthest_in_plot(distances, run.density_error.values[drawn] / height[1]),
            apart.maximum_in_errors or 0.0,
        ),
        source="section seq:analytics, diff_gl, fig:rho_num_sim",
        ours=f"the amplitude{known}",
        reason="a real rod is spread around the place that the fluid gives it",
    )


DENSITY = Study(
    number=17,
    name="density",
    title="Density at e = 1: simulation and theory",
    caption="L = 100, e = 1, four driving amplitudes. Above: simulation, smoothed as in the paper, "
    "and exact density. Below: the differences from the exact density at the right end, in per "
    "cent of close packing, of the simulation and of "
    f"{'; '.join(TITLES[name] for name in ELASTIC[1:])}. At e = 1 without a gap equation 19 "
    "(diff_gl) is exact for the rods without their length, as points. What is approximate is to "
    "read rods off a fluid by 1/(1 - 2 rho R); rod by rod it is exact.",
    needs=list(_RUNS.values()),
    claims=lambda results: [_match(results, amplitude) for amplitude in _RUNS],
    draw=lambda results: draw_density(
        elastic_tree({_RUNS[a].name: _run(results, a) for a in _RUNS})
    ),
)
