"""Pictures of the kinetic equation: widths and displacements of the rods, f(y, v) as an image."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.side_by_side.parameter_series import SIMULATION
from crazybilliards.comparison.side_by_side.restitutions import LEGEND
from crazybilliards.model import chain_of
from crazybilliards.model.vocabulary import require

_DECADES = 5  # of f in the image
_STYLES = dict(zip(LEGEND, ("--", "-"), strict=True))


def draw_widths(tree: xr.DataTree) -> Figure:
    """W_v(i) and <dx_i> for every restitution, in units of the free rod; lines are theories."""
    figure, axes = panels(1, 2, height=2.5)
    for number, group in enumerate(tree.children.values()):
        run = group[SIMULATION].to_dataset()
        chain = chain_of(run)
        colour = COLOURS[number % len(COLOURS)]
        units = (chain.free_velocity_width, chain.thermal_length)
        for ax, name, unit in zip(
            axes, ("velocity_width", "mean_displacement"), units, strict=True
        ):
            draw_rods(ax, run, name, number=number, unit=unit, label=f"$e = {chain.restitution:g}$")
            for key, style in _STYLES.items():
                if key in group:
                    theory = group[key].to_dataset()
                    values = theory[name] / unit
                    ax.plot(theory.normalized_particle, values, style, color=colour, zorder=3)
    along_the_chain(axes[0])
    axes[0].set(ylabel="velocity width $W_v/W$")
    axes[0].set_ylim(bottom=0)
    along_the_chain(axes[1])
    axes[1].set(ylabel=r"displacement $\langle\Delta x\rangle/s$")
    for key, style in _STYLES.items():
        if any(key in group for group in tree.children.values()):
            axes[0].plot([], [], style, color="0.4", label=LEGEND[key].title)
    legend_above(figure, axes[0])
    return figure


def draw_phase_space(theory: xr.Dataset) -> Figure:
    """f(y, v) over five decades, in units of the free rod, with the width of v at each y."""
    require(theory, ("phase_space_density",))
    chain = chain_of(theory)
    s, W = chain.thermal_length, chain.free_velocity_width
    f = theory.phase_space_density * (s * W / chain.size)
    y, v = theory.y / s, theory.velocity / W
    floor = float(f.max()) * 10.0**-_DECADES
    figure, [ax] = panels(1, 1, height=2.7, wanted=1)
    image = ax.pcolormesh(
        y,
        v,
        np.maximum(f.values.T, floor),
        norm=LogNorm(floor, float(f.max())),
        shading="gouraud",
        rasterized=True,
    )
    density = f.integrate("velocity")
    alive = density.values > 1e-4 * float(density.max())
    square = (f * theory.velocity**2).integrate("velocity") / density
    width = np.sqrt(square[alive]) / W
    for sign in (1, -1):
        ax.plot(
            y[alive],
            sign * width,
            color="white",
            label=r"$\pm\langle v^2\rangle^{1/2}$ at $y$" if sign > 0 else None,
        )
    # The region above the floor, with a margin around it.
    reach = [np.abs(axis[(f.values > floor).any(axis=1 - k)]).max() for k, axis in ((0, y), (1, v))]
    ax.set(
        xlim=(-reach[0], reach[0]),
        ylim=(-reach[1], reach[1]),
        xlabel="reduced position $y/s$",
        ylabel="velocity $v/W$",
        title=rf"$L = {chain.size}$, $e = {chain.restitution:g}$, $\gamma = {chain.damping:g}$",
    )
    ax.legend(loc="upper right", labelcolor="white")
    figure.colorbar(image, ax=ax, label=r"$f(y, v)\; s W/L$")
    return figure


def draw_profile(theory: xr.Dataset, name: str) -> Figure:
    """W_v(i) and <dx_i> of a theory alone, called ``name`` in the legend."""
    chain = chain_of(theory)
    figure, axes = panels(1, 2)
    for ax, quantity, label in (
        (axes[0], "velocity_width", "velocity width $W_v$ [R/T]"),
        (axes[1], "mean_displacement", r"displacement $\langle\Delta x\rangle$ [R]"),
    ):
        ax.plot(theory.normalized_particle, theory[quantity], color=COLOURS[0], label=name)
        along_the_chain(ax)
        ax.set(ylabel=label)
    axes[0].axhline(
        chain.free_velocity_width, color="0.4", linestyle=":", label="free rod (and e = 1)"
    )
    axes[0].legend()
    axes[0].set_ylim(bottom=0)
    return figure
