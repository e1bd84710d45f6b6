"""Pictures of chains side by side: densities, displacements, widths, and f(y, v) as an image.

The panels of densities and displacements have the differences from the exact equilibrium below
them, which are too small to be seen above; at e != 1 those from the simulation.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods, overlay
from crazybilliards.comparison.layout import entitle, legend_above, letter, panels, picture_width
from crazybilliards.comparison.side_by_side.grid import ELASTIC, KINETIC, SIMULATION, TITLES
from crazybilliards.comparison.symbols import LEAST_SEEN, keep_room
from crazybilliards.comparison.widths import displacement_unit, free_widths
from crazybilliards.model import chain_of
from crazybilliards.model.arrays import Array
from crazybilliards.model.vocabulary import require

_DECADES = 5  # of f in the image
_SYMBOLS = {"amplitude": "A", "restitution": "e", "size": "L", "gap": "g", "damping": r"\gamma"}
_LARGE, _FAINT = 0.2, 0.25  # a stated error, as a share of the axis; the opacity of such a curve
_STYLES = {"exact": "-"} | dict(zip(KINETIC, ("--", "-"), strict=True))


def draw_density(tree: xr.DataTree) -> Figure:
    """rho(x) of simulation and theories for each chain, all smoothed as the paper does.

    The insets show the right edge, where the theories differ most, with every bin.
    """
    figure, axes_of_all = _panels(tree)
    for axes, group in zip(axes_of_all, tree.children.values(), strict=True):
        results = {name: smooth(result) for name, result in _results(group).items()}
        chain = chain_of(results[SIMULATION])
        _draw(axes, results, "density", unit=chain.close_packed_density)
        axes[0].set(ylabel=r"density $\rho$ [1/R]")
        axes[1].set(xlabel="position $x$ [R]", ylabel=r"diff. $\times\, 2R$")
        reference = results[_reference(results)]
        inside = reference.density.values > 1e-4 * chain.close_packed_density
        ends = reference.x.values[inside][[0, -1]]
        axes[1].set_xlim(*ends)
        _fade_as_in(axes[0], _draw_edge(axes[0], results, float(ends[1])))
    legend_above(figure, axes_of_all[0][0])
    return figure


def _draw_edge(ax: Axes, results: dict[str, xr.Dataset], end: float) -> Axes:
    """Draw the outermost three thermal lengths, at least ten radii, into an inset; return it."""
    chain = chain_of(results[SIMULATION])
    begin = end - max(3 * chain.thermal_length if chain.stiffness else 0, 10 * chain.radius)
    inset = ax.inset_axes((0.29, 0.13, 0.42, 0.56))
    shown = {name: result.sel(x=slice(begin, end)) for name, result in results.items()}
    run = shown.pop(SIMULATION)
    look: Any = {"linestyle": "none", "marker": ".", "markersize": 1.5, "linewidth": 0.5}
    inset.errorbar(run.x, run.density, run.get("density_error"), color="black", **look)
    overlay(shown, ax=inset)
    inset.set(xlabel="", ylabel="", xlim=(begin, end))
    inset.tick_params(labelsize=6)
    inset.locator_params(nbins=3)
    ax.indicate_inset_zoom(inset, edgecolor="0.5")
    return inset


def draw_displacement(tree: xr.DataTree) -> Figure:
    """<dx> of simulation and theories at the rods' mean positions, for each chain."""
    figure, axes_of_all = _panels(tree)
    for axes, group in zip(axes_of_all, tree.children.values(), strict=True):
        results = _results(group)
        symbol, unit = displacement_unit(chain_of(results[SIMULATION]))
        _draw(axes, results, "mean_displacement", unit=unit)
        axes[0].set(ylabel=r"displacement $\langle\Delta x\rangle$ [R]")
        axes[1].set(xlabel=r"mean position $\langle x_i\rangle$ [R]", ylabel=f"diff. / ${symbol}$")
    legend_above(figure, axes_of_all[0][0])
    return figure


def _results(group: xr.DataTree) -> dict[str, xr.Dataset]:
    """Return the results of one chain by their titles, in drawing order."""
    return {title: group[key].to_dataset() for key, title in TITLES.items() if key in group}


def _reference(results: dict[str, xr.Dataset]) -> str:
    """Return the title of the result from which the others differ."""
    return ELASTIC["exact"] if ELASTIC["exact"] in results else SIMULATION


def _draw(axes: list[Axes], results: dict[str, xr.Dataset], quantity: str, unit: float) -> None:
    """Draw the quantity, and its differences from the reference divided by ``unit``.

    Without a theory there are no differences.
    """
    overlay(results, quantity, along="mean_position", ax=axes[0])
    axes[0].set_xlabel("")
    lines = {str(line.get_label()): line for line in axes[0].lines}
    theories = {name: each for name, each in results.items() if name != SIMULATION}
    fade((axes[0], lines[name], stated_error(each, quantity)) for name, each in theories.items())
    if len(results) == 1:
        return
    reference = results[_reference(results)][quantity]
    differences = {}
    for name, result in results.items():
        difference = ((result[quantity] - reference) / unit).assign_attrs(reference.attrs)
        differences[name] = result.assign({quantity: difference})
        if f"{quantity}_error" in result:
            differences[name][f"{quantity}_error"] = result[f"{quantity}_error"] / unit
    overlay(differences, quantity, along="mean_position", ax=axes[1])
    _fade_as_in(axes[0], axes[1])


def stated_error(theory: xr.Dataset, quantity: str) -> Array:
    """Return the error that a theory states of a quantity, in its unit; 0 where it states none."""
    chain = chain_of(theory)
    name, whole = {
        "velocity_width": ("velocity_width_model_error", np.abs(theory[quantity].values)),
        "mean_displacement": ("mean_displacement_model_error", displacement_unit(chain)[1]),
        "density": ("density_model_error", chain.close_packed_density),
    }[quantity]
    return theory.attrs.get(name, 0.0) * whole * np.ones(theory[quantity].shape)


def fade(drawn: Iterable[tuple[Axes, Line2D, Array]]) -> None:
    """Make lines faint whose error is above a fifth of their axis, and draw it as a band."""
    for ax, line, error in drawn:
        low, high = ax.get_ylim()
        if np.max(error) > _LARGE * (high - low):
            line.set_alpha(_FAINT)
            x, y = np.asarray(line.get_data(), dtype=float)
            band: Any = {"color": line.get_color(), "alpha": _FAINT / 2, "linewidth": 0}
            ax.fill_between(x, y - error, y + error, **band)
            ax.set_ylim(low, high)


def _fade_as_in(above: Axes, ax: Any) -> None:
    """Draw lines as faintly as those with the same labels are above."""
    opacities = {line.get_label(): line.get_alpha() for line in above.lines}
    for line in ax.lines:
        line.set_alpha(opacities.get(line.get_label()))


def _panels(tree: xr.DataTree) -> tuple[Figure, list[list[Axes]]]:
    """Make a lettered panel for each chain, with its title, and one for differences below it."""
    number = len(tree.children)
    width = picture_width(2 if number > 1 else 1)
    columns = min(number, 2 if width > picture_width(1) else 1)
    rows = math.ceil(number / columns)
    figure = plt.figure(figsize=(width, 2.7 * rows + 0.3), layout="constrained")
    parts = figure.subfigures(rows, columns, squeeze=False).ravel()[:number]
    made = [list(part.subplots(2, 1, sharex=True, height_ratios=(3, 1.3))) for part in parts]
    if number > 1:
        letter([above for above, _ in made])
    for (above, _), group in zip(made, tree.children.values(), strict=True):
        symbol, unit = displacement_unit(chain_of(group[SIMULATION].to_dataset()))
        entitle(above, rf"{_varied(group)},  ${symbol} = {unit:.3g}\,R$")
    return figure, made


def _varied(group: xr.DataTree) -> str:
    """Return what is special about a chain, from a name such as amplitude_3."""
    name, _, value = str(group.name).rpartition("_")
    return f"${_SYMBOLS[name]} = {value}$" if name in _SYMBOLS else f"{name} {value}"


def draw_widths(tree: xr.DataTree) -> Figure:
    """W_v(i) and <dx_i> of every chain, in units of the free rod; lines are theories."""
    figure, axes = panels(1, 2, height=2.5)
    count = len(tree.children)
    many = plt.get_cmap("cividis")(np.linspace(0.0, 0.9, count))
    colours = COLOURS if count <= len(COLOURS) else [to_hex(each) for each in many]
    drawn = []
    for number, (colour, group) in enumerate(zip(colours, tree.children.values(), strict=False)):
        run = group[SIMULATION].to_dataset()
        chain = chain_of(run)
        look: Any = {"number": number % len(COLOURS), "color": colour}
        symbol, length = displacement_unit(chain)
        units = (chain.free_velocity_width, length)
        for ax, name, unit in zip(
            axes, ("velocity_width", "mean_displacement"), units, strict=True
        ):
            draw_rods(ax, run, name, unit=unit, label=_varied(group), **look)
            for key, style in _STYLES.items():
                if key in group:
                    theory = group[key].to_dataset()
                    values = theory[name] / unit
                    place = theory.normalized_particle
                    [line] = ax.plot(place, values, style, color=colour, zorder=3)
                    drawn.append((ax, line, stated_error(theory, name) / unit))
                    keep_room(ax, values.values, LEAST_SEEN)
    along_the_chain(axes[0])
    axes[0].set(ylabel="velocity width $W_v/W$")
    along_the_chain(axes[1])
    axes[1].set(ylabel=rf"displacement $\langle\Delta x\rangle/{symbol}$")
    fade(drawn)
    for key, style in _STYLES.items():
        if any(key in group for group in tree.children.values()):
            axes[0].plot([], [], style, color="0.4", label=TITLES[key])
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
    drawn = []
    length = displacement_unit(chain)[1]
    for ax, quantity, label, unit in (
        (axes[0], "velocity_width", "velocity width $W_v$ [R/T]", chain.free_velocity_width),
        (axes[1], "mean_displacement", r"displacement $\langle\Delta x\rangle$ [R]", length),
    ):
        [line] = ax.plot(theory.normalized_particle, theory[quantity], color=COLOURS[0], label=name)
        drawn.append((ax, line, stated_error(theory, quantity)))
        keep_room(ax, theory[quantity].values, LEAST_SEEN * unit)
        along_the_chain(ax)
        ax.set(ylabel=label)
    for number, width in enumerate(free_widths(chain)):
        of_both = None if number else "free rod (and e = 1)"
        axes[0].axhline(width, color="0.4", linestyle=":", label=of_both)
    axes[0].legend()
    fade(drawn)
    return figure


def draw_density_alone(theory: xr.Dataset, name: str) -> Figure:
    """Draw the density of a theory alone, called ``name`` in the legend."""
    figure, [ax] = panels(1, 1, wanted=1)
    overlay({name: theory}, ax=ax).legend(loc="lower center")
    fade([(ax, ax.lines[0], stated_error(theory, "density"))])
    return figure
