"""Pictures of a relaxation: space and time, profiles, width and centre, and an animation."""

from __future__ import annotations

from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.drawing import overlay
from crazybilliards.comparison.studies.relaxation import LEGEND, PARTICLES, cloud
from crazybilliards.model import Chain, chain_of

Array = NDArray[np.float64]

_MOMENTS = (0.0, 0.05, 0.1, 1.0)  # of the duration, for the profiles
_LEAST_DRAWN = 2e-3  # of close packing: pictures end where every density is lower


def draw_spacetime(tree: xr.DataTree) -> Figure:
    """rho(x, t) of the particles and both fluids, side by side on one colour scale."""
    densities = _densities(tree)
    figure, panels = plt.subplots(
        1,
        len(densities),
        figsize=(3.1 * len(densities) + 0.8, 4),
        sharey=True,
        layout="constrained",
    )
    chain = _chain(tree)
    for ax, (name, result) in zip(panels, densities.items(), strict=True):
        image = ax.pcolormesh(
            result.x,
            result.time,
            result.density,
            cmap="cividis",
            vmin=0,
            vmax=chain.close_packed_density,
            rasterized=True,
        )
        ax.set(title=name, xlabel="position x [R]", xlim=_extent(densities))
    panels[0].set_ylabel("time t [T]")
    figure.colorbar(image, ax=panels, label=r"density $\rho$ [1/R]")
    return figure


def draw_profiles(tree: xr.DataTree) -> Figure:
    """rho(x) at a few times: symbols of the ensemble over lines of the fluids."""
    densities = _densities(tree)
    times = densities[PARTICLES].time.values
    chosen = np.round(np.array(_MOMENTS) * (times.size - 1)).astype(int)
    figure, panels = plt.subplots(
        2, 2, figsize=(8, 5.6), sharex=True, sharey=True, layout="constrained"
    )
    for ax, moment in zip(panels.ravel(), chosen, strict=True):
        overlay({name: each.isel(time=moment) for name, each in densities.items()}, ax=ax)
        ax.set(title=f"t = {times[moment]:.3g} T", xlim=_extent(densities), xlabel="", ylabel="")
    for ax in panels[1]:
        ax.set_xlabel("position x [R]")
    for ax in panels[:, 0]:
        ax.set_ylabel(r"density $\rho$ [1/R]")
    _legend_above(figure)
    return figure


def draw_cloud(tree: xr.DataTree) -> Figure:
    """Width and centre of the cloud in the reduced coordinate against time, in units of s."""
    figure, panels = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    s = _chain(tree).thermal_length
    names = {PARTICLES: PARTICLES} | LEGEND
    for ax, which, label in zip(
        panels, (1, 0), ("width of the cloud / s", "centre / s"), strict=True
    ):
        curves = {}
        for key, name in names.items():
            if key in tree:
                values = cloud(tree[key].to_dataset())[which] / s
                values.attrs = {"long_name": label, "units": "1"}
                curves[name] = xr.Dataset({"curve": values}, attrs=tree[key].attrs)
        overlay(curves, "curve", ax=ax)
        low, high = ax.get_ylim()
        if high - low < 0.1:  # do not magnify the noise of a centre at rest
            ax.set_ylim(low - 0.05, high + 0.05)
    _legend_above(figure)
    return figure


def animate(tree: xr.DataTree) -> FuncAnimation:
    """rho(x, t) of the ensemble and the fluids as an animation.

    ``standalone_page(animate(tree))`` plays in a notebook or a browser.
    ``.save("relaxation.gif", writer="pillow")`` makes a file.
    """
    densities = _densities(tree)
    times = densities[PARTICLES].time.values
    figure, ax = plt.subplots(figsize=(6.4, 4), layout="constrained")
    overlay({name: each.isel(time=0) for name, each in densities.items()}, ax=ax)
    high = max(float(each.density.max()) for each in densities.values())
    ax.set(xlim=_extent(densities), ylim=(0, 1.05 * high), xlabel="position x [R]")
    _legend_above(figure)
    moving = _movers(ax, densities)

    def show(frame: int) -> list[Artist]:
        ax.set_title(f"t = {times[frame]:.2f} T", fontsize=10)
        for move in moving:
            move(frame)
        return []

    animation = FuncAnimation(figure, show, frames=times.size, interval=80)
    plt.close(figure)  # the animation keeps the figure; notebooks would show it twice
    return animation


def _movers(ax: Axes, densities: dict[str, xr.Dataset]) -> list[Callable[[int], None]]:
    """Return functions that set each curve of ``ax`` to a frame."""

    def mover(line: Line2D, result: xr.Dataset) -> Callable[[int], None]:
        x, values = result.x.values, result.density.values
        shown = np.isin(x, line.get_xdata())

        def move(frame: int) -> None:
            line.set_ydata(values[frame][shown])

        return move

    lines = {}
    for container in ax.containers:  # the symbols
        if isinstance(container, ErrorbarContainer):
            lines[str(container.get_label())] = container.lines[0]
    lines |= {str(line.get_label()): line for line in ax.lines if line.get_label() in densities}
    return [mover(lines[name], result) for name, result in densities.items()]


def _densities(tree: xr.DataTree) -> dict[str, xr.Dataset]:
    """Return the available smoothed densities by their labels."""
    names = {PARTICLES: PARTICLES} | LEGEND
    return {
        name: smooth(tree[key].to_dataset())
        for key, name in names.items()
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


def _legend_above(figure: Figure) -> None:
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False, fontsize=9)
