"""Figure 17: density of the elastic chain, simulation and theory, for several amplitudes."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.distances import deviation, distances_in_plot
from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.side_by_side.grid import ELASTIC, elastic_tree
from crazybilliards.comparison.side_by_side.grid_figures import draw_density
from crazybilliards.comparison.stationary_theories import TITLES
from crazybilliards.comparison.sweeps import Case
from crazybilliards.kinetic import force_balance
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction.claims.study import Cases, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, furthest_in_plot, in_plot

TITLE = "Density at e = 1: simulation and theory"
CAPTION = (
    "L = 100, e = 1, four driving amplitudes. Above: simulation, smoothed as in the paper, and "
    "exact density. Below: the differences from the exact density at the right end, in per cent of "
    f"close packing, of the simulation and of {'; '.join(TITLES[name] for name in ELASTIC[1:])}. "
    "At e = 1 without a gap equation 19 "
    "(diff_gl) is exact for the rods without their length, as points. What is approximate is to "
    "read rods off a fluid by 1/(1 - 2 rho R); rod by rod it is exact."
)

_AMPLITUDES = (1.0, 3.0, 10.0, 30.0)
_ARCTANH = 10.0  # the amplitude of the paper's arctanh fit, fig:atan
# Its displacements are compared to half a per cent (figure 16), densities to one of close packing.
# Some seconds at either quality, because elastic rods are flown exactly.
_DURATION, _SHARE = 1_000_000.0, 0.25  # share: of the duration, for the other amplitudes
_VISIBLE = 1e-3  # of close packing: where both densities are lower, nothing is drawn
_SOURCE = "section seq:analytics, diff_gl, fig:rho_num_sim"


def simulation(amplitude: float) -> Case:
    """L = 100, e = 1."""
    share = 1.0 if amplitude == _ARCTANH else _SHARE
    settings = {"duration": share * _DURATION, "observe": ["widths", "density"]}
    return Case("simulate", Chain(size=100, amplitude=amplitude), settings)


def cases(quality: Quality) -> Cases:
    """Four amplitudes."""
    return {f"amplitude_{a:g}": simulation(a) for a in _AMPLITUDES}


def claims(results: Results) -> list[Claim]:
    """Check: simulation and theory agree."""
    return [_match(run) for run in results.values()]


def _match(run: xr.Dataset) -> Claim:
    """Compare the theory fed with the fitted displacement with the simulated density."""
    chain = chain_of(run)
    fed = force_balance(chain, displacement=fit_arctanh(run))
    run, theory = smooth(run), smooth(fed)
    return Claim(
        f"simulated and integrated densities match perfectly, A = {chain.amplitude:g}",
        **in_plot(
            "rho(x) of simulation and theory, fed with the fitted displacement, both axes linear",
            _off_in_plot(run, theory),
            deviation(run, theory).maximum_in_errors or 0.0,
        ),
        source=_SOURCE,
        ours="the amplitude"
        + (", which is that of fig:atan" if chain.amplitude == _ARCTANH else ""),
        reason="a real rod is spread around the place that the fluid gives it",
    )


def _off_in_plot(run: xr.Dataset, theory: xr.Dataset) -> Estimate:
    """Return the distance in the plot of rho(x) that decides, as a share of it."""
    x, rho = run.x.values, run.density.values
    line = np.interp(x, theory.x.values, theory.density.values, left=0.0, right=0.0)
    least = _VISIBLE * chain_of(run).close_packed_density
    drawn = (rho > least) | (line > least)
    height = (0.0, float(rho.max()))
    off = distances_in_plot(x[drawn], rho[drawn], x[drawn], line[drawn], y_range=height)
    return furthest_in_plot(off, run.density_error.values[drawn] / height[1])


def draw(results: Results) -> Figure:
    """Draw rho(x) and the differences from the exact density."""
    return draw_density(elastic_tree(results))
