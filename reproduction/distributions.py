"""Distributions of velocities and avalanche sizes, as several figures draw them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.optimize import curve_fit

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.model import chain_of
from crazybilliards.model.arrays import Array
from crazybilliards.model.vocabulary import require
from crazybilliards.reproduction.claims.repetition import error_of_mean

# Counts of avalanches: their names, and their coordinates.
COUNTS = {
    "triggered_count": ("the paper's count", "triggered_collisions"),
    "avalanche_count": ("pushes", "avalanche_size"),
}
_LEAST = 1e-5  # of the largest density: below, counts are too few to draw
_SYMBOLS_DRAWN = 41


def mean_shape(run: xr.Dataset, particles: Sequence[int], name: str) -> float:
    """Mean over the particles of their ``velocity_skewness`` or excess ``velocity_kurtosis``."""
    require(run, (name,))  # a result of an old version lacks it
    return float(run[name].sel(particle=list(particles)).mean())


def histogram(run: xr.Dataset, particles: Sequence[int], reach: float) -> tuple[Array, Array]:
    """Return velocities and the mean density of some particles in 41 equal bins to +-``reach``."""
    v = run.velocity_bin.values
    weight = np.gradient(v)
    p = run.velocity_density.sel(particle=list(particles)).mean("particle").values
    edges = np.linspace(-reach, reach, _SYMBOLS_DRAWN + 1)
    share, _ = np.histogram(v, edges, weights=p * weight)
    width, _ = np.histogram(v, edges, weights=weight)
    middle, _ = np.histogram(v, edges, weights=v * weight)
    filled = width > 0
    return middle[filled] / width[filled], share[filled] / width[filled]


def off_in_plot(v: Array, p: Array, line: Callable[[Array], Array], reach: float) -> float:
    """Return how far off a line the symbols are at most, in a plot to +-``reach`` from p = 0 up."""
    fine = np.linspace(-reach, reach, 4001)
    height = (0.0, float(p.max()))
    return float(
        distances_in_plot(v, p, fine, line(fine), x_range=(-reach, reach), y_range=height).max()
    )


def figure_of_distributions(runs: Sequence[xr.Dataset], particles: Sequence[int]) -> Figure:
    """Return :func:`draw_distributions` as a figure of one panel, with a legend."""
    figure, [ax] = panels(1, 1, height=2.9)
    draw_distributions(ax, runs, particles)
    legend_above(figure, ax)
    return figure


def draw_distributions(ax: Axes, runs: Sequence[xr.Dataset], particles: Sequence[int]) -> None:
    """Draw p(v) of some particles on a logarithmic scale, v in free widths W, and Gaussians.

    Error bars are standard errors from the scatter between the independent ``runs``. The lines are
    Gaussians of the same width, and the free rod's.
    """
    run = runs[0]
    unit = chain_of(run).free_velocity_width
    v = run.velocity_bin.values / unit
    reach = 0.0
    for number, particle in enumerate(particles):
        each = np.array([run.velocity_density.sel(particle=particle) for run in runs]) * unit
        p, error = each.mean(axis=0), error_of_mean(each)
        variance = np.mean([run.velocity_width.sel(particle=particle) ** 2 for run in runs])
        width = float(np.sqrt(variance)) / unit
        drawable = p > _LEAST * p.max()
        reach = max(reach, float(np.abs(v[drawable]).max()))
        # Bins grow with v: draw those nearest to equally spaced velocities.
        inside = v[drawable]
        spaced = np.linspace(inside[0], inside[-1], _SYMBOLS_DRAWN)
        shown = np.unique(np.abs(v[:, None] - spaced).argmin(axis=0))
        label = f"$i = {particle}$"
        draw_points(ax, v[shown], p[shown], error[shown], number=number, label=label, linewidth=0.6)
        fine = np.linspace(-5 * width, 5 * width, 201)
        ax.plot(fine, gaussian(fine, width), color=COLOURS[number], linewidth=0.9)
    ax.plot([], [], color="0.4", linewidth=0.9, label="Gaussian")
    fine = np.linspace(-5, 5, 201)
    ax.plot(fine, gaussian(fine, 1.0), "k:", label="free rod")
    ax.set_yscale("log")
    top = ax.get_ylim()[1]
    ax.set(ylim=(3e-6, top), xlim=(-1.05 * reach, 1.05 * reach))
    ax.set(xlabel="velocity $v/W$", ylabel="probability density $W p(v)$")


def waves(run: xr.Dataset, count: str, particles: slice) -> tuple[Array, Array]:
    """Return sizes of avalanches from 1 on, and how many of a count began at some rods."""
    sizes = run[COUNTS[count][1]].values
    counts = run[count].sel(particle=particles).sum("particle").values.astype(float)
    return sizes[sizes >= 1], counts[sizes >= 1]


def draw_sizes(ax: Axes, sizes: Array, p: Array, counts: Array, *, number: int, label: str) -> None:
    """Draw the probability of avalanche sizes, with error bars of counting statistics."""
    counted = counts > 0
    p, error = p[counted], p[counted] / np.sqrt(counts[counted])
    draw_points(ax, sizes[counted], p, error, number=number, label=label, linewidth=0.7)
    ax.set(xscale="log", yscale="log", xlabel="avalanche size $N_c$")


def gaussian(v: Array, width: float) -> Array:
    """Return the normal density of that width."""
    return np.asarray(np.exp(-((v / width) ** 2) / 2) / (width * np.sqrt(2 * np.pi)))


def fit_gaussian(v: Array, p: Array, width: float) -> Callable[[Array], Array]:
    """Return the Gaussian that fits best by least squares, its height, centre and width free."""

    def model(v: Array, height: float, centre: float, width: float) -> Array:
        return np.asarray(height * np.exp(-(((v - centre) / width) ** 2) / 2))

    values, _ = curve_fit(model, v, p, p0=(float(p.max()), 0.0, width))
    return lambda v: model(v, *values)
