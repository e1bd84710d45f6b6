"""Pictures of a relaxation: space and time, profiles, width and centre, and those of a film."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.drawing import overlay
from crazybilliards.comparison.layout import entitle, label_outer, legend_above, panels
from crazybilliards.comparison.side_by_side.grid import SIMULATION
from crazybilliards.comparison.side_by_side.relaxation import LEGEND, PARTICLES, cloud
from crazybilliards.comparison.symbols import LEAST_SEEN, keep_room
from crazybilliards.comparison.widths import displacement_unit
from crazybilliards.model import Chain, chain_of

_NAMES = {PARTICLES: SIMULATION} | LEGEND
_DENSITY, _POSITION = r"density $\rho$ [1/R]", "position $x$ [R]"
_MOMENTS = (0.0, 0.05, 0.1, 1.0)  # of the duration, for the profiles
_LEAST_DRAWN = 2e-3  # of close packing: pictures end where every density is lower


def draw_spacetime(tree: xr.DataTree) -> Figure:
    """rho(x, t) of the simulation, both fluids and the rods, on one colour scale."""
    densities = _densities(tree)
    figure, axes = panels(2, math.ceil(len(densities) / 2), height=2.3, sharex=True, sharey=True)
    chain = _chain(tree)
    for ax, (name, result) in zip(axes, densities.items(), strict=False):
        image = ax.pcolormesh(
            result.x,
            result.time,
            result.density,
            vmin=0,
            vmax=chain.close_packed_density,
            rasterized=True,
        )
        entitle(ax, name)
        ax.set_xlim(_extent(densities))
    if len(axes) > len(densities):
        axes.pop().remove()
    label_outer(axes, x=_POSITION, y="time $t$ [T]")
    figure.colorbar(image, ax=axes, label=_DENSITY)
    return figure


def draw_profiles(tree: xr.DataTree) -> Figure:
    """rho(x) at a few times: simulation with its standard errors, over the lines of the fluids."""
    densities = _densities(tree)
    times = densities[SIMULATION].time.values
    chosen = np.round(np.array(_MOMENTS) * (times.size - 1)).astype(int)
    figure, axes = panels(2, 2, height=2.1, sharex=True, sharey=True)
    extent = _extent(densities)
    for ax, moment in zip(axes, chosen, strict=True):
        # Of what is shown, or the symbols would be few there.
        shown = {
            name: each.isel(time=moment).sel(x=slice(*extent)) for name, each in densities.items()
        }
        overlay(shown, ax=ax)
        entitle(ax, f"$t = {times[moment]:.3g}$ T")
        ax.set(xlim=extent, xlabel="", ylabel="")
        _draw_walls(ax, _chain(tree))
    label_outer(axes, x=_POSITION, y=_DENSITY)
    legend_above(figure, axes[0])
    return figure


def draw_cloud(tree: xr.DataTree) -> Figure:
    """Width and centre of the cloud in the reduced coordinate against time, in units of s or h."""
    figure, axes = panels(1, 2, height=2.4)
    symbol, s = displacement_unit(_chain(tree))
    for ax, which, label in zip(
        axes, ("cloud_width", "centre"), ("width of the cloud", "centre"), strict=True
    ):
        curves = {}
        for key, name in _NAMES.items():
            if key in tree and key != "rods":  # whose cloud is that of the fluid
                found = cloud(tree[key].to_dataset())
                curves[name] = (found / s).assign_attrs(tree[key].attrs)
                curves[name][which].attrs = {"long_name": "", "units": "1"}
        overlay(curves, which, ax=ax)
        ax.set_ylabel(f"{label} / ${symbol}$")
        for curve in curves.values():  # the noise of a centre at rest
            keep_room(ax, curve[which].values, LEAST_SEEN)
    legend_above(figure, axes[0])
    return figure


def relaxation_animation(tree: xr.DataTree, most: int) -> tuple[FuncAnimation, int]:
    """Return the film of rho(x, t) of the simulation and the fluids, and its number of pictures."""
    densities = _densities(tree)
    extent = _extent(densities)
    last = densities[SIMULATION].time.size - 1
    chosen = np.unique(np.linspace(0, last, most).round().astype(int))
    densities = {
        name: each[["density"]].sel(x=slice(*extent)).isel(time=chosen)
        for name, each in densities.items()
    }
    figure, ax = plt.subplots(figsize=(8, 4.5), layout="constrained")
    rods = densities[SIMULATION]
    # Every bin: symbols that tell the curve at one time may show false waves at another.
    ax.plot(rods.x, rods.density[0], color="black", linewidth=1, label=SIMULATION, zorder=3)
    fluids = {name: each.isel(time=0) for name, each in densities.items() if name != SIMULATION}
    overlay(fluids, ax=ax)
    high = max(float(each.density.max()) for each in densities.values())
    ax.set(xlim=extent, ylim=(0, 1.05 * high), xlabel=_POSITION, ylabel=_DENSITY)
    _draw_walls(ax, chain_of(rods))
    legend_above(figure, ax)
    lines = {str(line.get_label()): line for line in ax.lines}

    def show(picture: int) -> None:
        ax.set_title(f"{title(tree)}: $t = {float(rods.time[picture]):.2f}$ T")
        for name, each in densities.items():
            lines[name].set_ydata(each.density.values[picture])

    return FuncAnimation(figure, show, chosen.size, repeat=False), chosen.size


def _draw_walls(ax: Axes, chain: Chain) -> None:
    for wall in [-chain.box / 2, chain.box / 2] if chain.box else []:
        ax.axvline(wall, color="0.6", linewidth=2, zorder=1)


def title(tree: xr.DataTree) -> str:
    """Say in one line what was released, and how."""
    chain = _chain(tree)
    return (
        f"{chain.size} rods, A = {chain.amplitude:g}, g = {chain.gap:g}, "
        f"{tree.attrs['release']} by {tree.attrs['by']:g} and released at t = 0"
    )


def _densities(tree: xr.DataTree) -> dict[str, xr.Dataset]:
    """Return the available smoothed densities by the names they are drawn with."""
    if PARTICLES not in tree:
        raise ValueError(
            f"run must be what compare_relaxation returns, got a tree of {list(tree.children)}"
        )
    return {
        name: smooth(tree[key].to_dataset())
        for key, name in _NAMES.items()
        if key in tree and "density" in tree[key]
    }


def _extent(densities: dict[str, xr.Dataset]) -> tuple[float, float]:
    """Return the interval outside of which every density is small at all times."""
    ends = []
    for result in densities.values():
        threshold = _LEAST_DRAWN * chain_of(result).close_packed_density
        inside = result.x.values[(result.density.values > threshold).any(axis=0)]
        ends += [float(inside[0]), float(inside[-1])]
    return min(ends), max(ends)


def _chain(tree: xr.DataTree) -> Chain:
    return chain_of(tree[PARTICLES].to_dataset())
