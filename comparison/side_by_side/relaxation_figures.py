"""Pictures of a relaxation: space and time, profiles, width and centre, and those of a film."""

import math
from collections.abc import Callable

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.curves import axis_label, displacement_unit, unit_label
from crazybilliards.comparison.drawing import TWO_COLUMNS, entitle, legend_above, overlay, panels
from crazybilliards.comparison.side_by_side.grid import SIMULATION
from crazybilliards.comparison.side_by_side.relaxation import LEGEND, cloud
from crazybilliards.model import Chain, chain_of

_NAMES = {SIMULATION: SIMULATION} | LEGEND
_MOMENTS = np.array([0.0, 0.05, 0.1, 1.0])  # of the duration, for the profiles
_LEAST_DRAWN = 2e-3  # of close packing: pictures end where every density is lower
_AT_REST = 0.1  # an axis of the centre is not narrower, so that it does not magnify noise
_LOOK = {SIMULATION: {"color": "black"}}


def draw_spacetime(tree: xr.DataTree) -> Figure:
    """rho(x, t) of the simulation, both fluids and the rods, on one colour scale."""
    densities = _densities(tree)
    columns = math.ceil(len(densities) / 2)
    figure, axes = panels(2, columns, height=2.3, sharex=True, sharey=True)
    highest = chain_of(densities[SIMULATION]).close_packed_density
    for ax, (name, result) in zip(axes, densities.items(), strict=False):
        image = ax.pcolormesh(
            result.x, result.time, result.density, vmin=0, vmax=highest, rasterized=True
        )
        entitle(ax, name)
    while len(axes) > len(densities):
        axes.pop().remove()
    for ax in axes[-columns:]:  # the lowest of each column, because the last row may be shorter
        ax.set_xlabel(axis_label(result.x))
        ax.tick_params(labelbottom=True)
    for ax in axes[::columns]:
        ax.set_ylabel(axis_label(result.time))
    figure.colorbar(image, ax=axes, label=axis_label(result.density))
    return figure


def draw_profiles(tree: xr.DataTree) -> Figure:
    """rho(x) at a few times: simulation with its standard errors, over the lines of the fluids."""
    densities = _densities(tree)
    time = densities[SIMULATION].time
    last = time.size - 1
    later = np.maximum(np.rint(_MOMENTS * last).astype(int), range(4))  # each another one
    moments = np.unique(np.minimum(later, last))
    rows, columns = (2, 2) if moments.size == 4 else (1, moments.size)
    figure, axes = panels(rows, columns, height=2.1, sharex=True, sharey=True)
    for ax, moment in zip(axes, moments, strict=True):
        overlay({n: each.isel(time=moment) for n, each in densities.items()}, ax=ax, style=_LOOK)
        entitle(ax, f"$t = {float(time[moment]):.3g}$ {unit_label(time)}")
        ax.margins(x=0)
        ax.label_outer()
        _draw_walls(ax, chain_of(densities[SIMULATION]))
    legend_above(figure, axes[0])
    return figure


def draw_cloud(tree: xr.DataTree) -> Figure:
    """Width and centre of the cloud in the reduced coordinate against time, in units of s or h."""
    figure, axes = panels(1, 2, height=2.4)
    symbol, unit = displacement_unit(chain_of(tree[SIMULATION].to_dataset()))
    clouds = {  # that of the rods is that of the fluid
        name: (cloud(tree[key].to_dataset()) / unit).assign_attrs(tree[key].attrs)
        for key, name in _NAMES.items()
        if key in tree and key != "rods"
    }
    quantities = {"cloud_width": "width of the cloud", "centre": "centre"}
    for ax, (quantity, label) in zip(axes, quantities.items(), strict=True):
        overlay(clouds, quantity, ax=ax, style=_LOOK)
        ax.set_ylabel(f"{label} / ${symbol}$")
    low, high = axes[1].get_ylim()
    axes[1].set_ylim(min(low, -_AT_REST), max(high, _AT_REST))
    legend_above(figure, axes[0])
    return figure


def relaxation_film(tree: xr.DataTree, most: int) -> tuple[Figure, Callable[[int], None], int]:
    """Return a figure of rho(x), what draws a picture of the film into it, and their number."""
    densities = _densities(tree)
    last = densities[SIMULATION].time.size - 1
    chosen = np.unique(np.linspace(0, last, most).round().astype(int))
    densities = {name: each.isel(time=chosen) for name, each in densities.items()}
    figure = Figure(figsize=(TWO_COLUMNS, 3.9), dpi=120)
    ax = figure.subplots()
    rods = densities[SIMULATION]
    ax.plot(rods.x, rods.density[0], color="black", linewidth=1, label=SIMULATION, zorder=3)
    fluids = {name: each.isel(time=0) for name, each in densities.items() if name != SIMULATION}
    overlay(fluids, ax=ax)
    ax.set_ylim(0, 1.05 * max(float(each.density.max()) for each in densities.values()))
    ax.margins(x=0)
    chain = chain_of(rods)
    _draw_walls(ax, chain)
    legend_above(figure, ax)
    title = (
        f"{chain.size} rods, A = {chain.amplitude:g}, g = {chain.gap:g}, "
        f"{tree.attrs['release']} by {tree.attrs['by']:g} and released at t = 0"
    )
    lines = {str(line.get_label()): line for line in ax.lines}

    def show(picture: int) -> None:
        ax.set_title(f"{title}: $t = {float(rods.time[picture]):.2f}$ {unit_label(rods.time)}")
        for name, each in densities.items():
            lines[name].set_ydata(each.density.values[picture])

    return figure, show, chosen.size


def _draw_walls(ax: Axes, chain: Chain) -> None:
    for wall in [-chain.box / 2, chain.box / 2] if chain.box else []:
        ax.axvline(wall, color="0.6", linewidth=2, zorder=1)


def _densities(tree: xr.DataTree) -> dict[str, xr.Dataset]:
    """Return the smoothed densities by the names they are drawn with, where any is not small."""
    if SIMULATION not in tree:
        raise ValueError(
            f"run must be what compare_relaxation returns, got a tree of {list(tree.children)}"
        )
    densities = {
        name: smooth(tree[key].to_dataset())
        for key, name in _NAMES.items()
        if key in tree and "density" in tree[key]
    }
    least = _LEAST_DRAWN * chain_of(densities[SIMULATION]).close_packed_density
    inside = [each.x.values[(each.density > least).any("time")] for each in densities.values()]
    shown = slice(min(x[0] for x in inside), max(x[-1] for x in inside))
    return {name: each.sel(x=shown) for name, each in densities.items()}
