"""Distributions of velocities, as figures 2, 8, 10 and 11 fit and draw them."""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.model import Array, chain_of
from crazybilliards.reproduction.claims.study import error_of_mean

_SYMBOLS_DRAWN = 41


def mean_shape(run: xr.Dataset, particles: Sequence[int], name: str) -> float:
    """Mean over the particles of their ``velocity_skewness`` or excess ``velocity_kurtosis``."""
    return float(run[name].sel(particle=list(particles)).mean())


def histogram(runs: Sequence[xr.Dataset], rods: Sequence[int], reach: float) -> tuple[Array, Array]:
    """Return velocities and the mean density of some rods in 41 equal bins to +-``reach``."""
    v = runs[0].velocity_bin.values
    weight = np.gradient(v)
    density = np.mean([run.velocity_density.sel(particle=list(rods)) for run in runs], axis=0)
    p = density.mean(axis=runs[0].velocity_density.get_axis_num("particle"))
    edges = np.linspace(-reach, reach, _SYMBOLS_DRAWN + 1)
    share, width, middle = (
        np.histogram(v, edges, weights=weights)[0] for weights in (p * weight, weight, v * weight)
    )
    filled = width > 0
    return middle[filled] / width[filled], share[filled] / width[filled]


def distance_in_plot(v: Array, p: Array, line: Callable[[Array], Array], reach: float) -> float:
    """Return how far off a line the symbols are at most, in a plot to +-``reach`` from p = 0 up."""
    fine = np.linspace(-reach, reach, 4001)
    distances = distances_in_plot(
        v, p, fine, line(fine), x_range=(-reach, reach), y_range=(0.0, float(p.max()))
    )
    return float(distances.max())


def gaussian(v: Array, width: float) -> Array:
    """Return the normal density of that width."""
    return np.asarray(np.exp(-((v / width) ** 2) / 2) / (width * np.sqrt(2 * np.pi)))


def draw_distributions(ax: Axes, runs: Sequence[xr.Dataset], particles: Sequence[int]) -> None:
    """Draw p(v) of some particles, v in free widths W, and Gaussians of the same width."""
    unit = chain_of(runs[0]).free_velocity_width
    v = runs[0].velocity_bin.values / unit
    reach = 0.0
    for number, particle in enumerate(particles):
        rods = [run.sel(particle=particle) for run in runs]
        densities = np.array([rod.velocity_density for rod in rods]) * unit
        p, error = densities.mean(axis=0), error_of_mean(densities)
        width = float(np.sqrt(np.mean([rod.velocity_width**2 for rod in rods]))) / unit
        drawable = p > 1e-5 * p.max()  # below, counts are too few
        reach = max(reach, float(np.abs(v[drawable]).max()))
        # Bins grow with v: draw those nearest to equally spaced velocities.
        first, last = v[drawable][[0, -1]]
        spaced = np.linspace(first, last, _SYMBOLS_DRAWN)
        shown = np.unique(np.abs(v[:, None] - spaced).argmin(axis=0))
        label = f"$i = {particle}$"
        draw_points(ax, v[shown], p[shown], error[shown], number=number, label=label, linewidth=0.6)
        fine = np.linspace(-5 * width, 5 * width, 201)
        ax.plot(fine, gaussian(fine, width), color=COLOURS[number], linewidth=0.9)
    ax.plot([], [], color="0.4", linewidth=0.9, label="Gaussian")
    fine = np.linspace(-5, 5, 201)
    ax.plot(fine, gaussian(fine, 1.0), "k:", label="free rod")
    ax.set_yscale("log")
    ax.set(
        xlabel="velocity $v/W$",
        ylabel="probability density $W p(v)$",
        xlim=(-1.05 * reach, 1.05 * reach),
        ylim=(3e-6, ax.get_ylim()[1]),
    )
