"""The two pictures of the main comparison: densities and displacements, one panel per amplitude.

Each panel shows the quantity and below it the differences from the exact equilibrium, which are too
small to be seen above.
"""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.drawing import overlay
from crazybilliards.comparison.layout import entitle, legend_above, letter, picture_width
from crazybilliards.comparison.side_by_side.elastic_chain import LEGEND
from crazybilliards.comparison.side_by_side.parameter_series import SIMULATION
from crazybilliards.model import Chain, chain_of


def draw_density(tree: xr.DataTree) -> Figure:
    """rho(x) of simulation and theories for each amplitude, all smoothed as the paper does.

    The insets show the right edge, where the theories differ most, with every bin.
    """
    figure, axes_of_all = _panels(len(tree.children))
    for axes, group in zip(axes_of_all, tree.children.values(), strict=True):
        results = {name: smooth(result) for name, result in _results(group).items()}
        chain = chain_of(results[SIMULATION])
        _draw(axes, results, "density", unit=chain.close_packed_density)
        entitle(axes[0], _title(chain))
        axes[0].set(ylabel=r"density $\rho$ [1/R]")
        axes[1].set(xlabel="position $x$ [R]", ylabel=r"diff. $\times\, 2R$")
        reference = results.get(LEGEND["exact"], results[SIMULATION])
        inside = reference.density.values > 1e-4 * chain.close_packed_density
        ends = reference.x.values[inside][[0, -1]]
        axes[1].set_xlim(*ends)
        _draw_edge(axes[0], results, float(ends[1]))
    legend_above(figure, axes_of_all[0][0])
    return figure


def _draw_edge(ax: Axes, results: dict[str, xr.Dataset], end: float) -> None:
    """Draw the outermost three thermal lengths, at least ten radii, into an inset."""
    chain = chain_of(results[SIMULATION])
    begin = end - max(3 * chain.thermal_length, 10 * chain.radius)
    inset = ax.inset_axes((0.29, 0.13, 0.42, 0.56))
    run = results[SIMULATION].sel(x=slice(begin, end))
    inset.errorbar(
        run.x,
        run.density,
        run.get("density_error"),
        linestyle="none",
        marker=".",
        markersize=1.5,
        color="black",
        linewidth=0.5,
    )
    theories = {
        name: result.sel(x=slice(begin, end))
        for name, result in results.items()
        if name != SIMULATION
    }
    overlay(theories, ax=inset)
    inset.set(xlabel="", ylabel="", xlim=(begin, end))
    inset.tick_params(labelsize=6)
    inset.locator_params(nbins=3)
    ax.indicate_inset_zoom(inset, edgecolor="0.5")


def draw_displacement(tree: xr.DataTree) -> Figure:
    """<dx> at the rods' mean positions, with the paper's arctanh fit, for each amplitude."""
    figure, axes_of_all = _panels(len(tree.children))
    for axes, group in zip(axes_of_all, tree.children.values(), strict=True):
        results = _results(group)
        chain = chain_of(results[SIMULATION])
        _draw(axes, results, "mean_displacement", unit=chain.thermal_length)
        entitle(axes[0], _title(chain))
        axes[0].set(ylabel=r"displacement $\langle\Delta x\rangle$ [R]")
        axes[1].set(xlabel=r"mean position $\langle x_i\rangle$ [R]", ylabel="diff. / $s$")
    legend_above(figure, axes_of_all[0][0])
    return figure


def _results(group: xr.DataTree) -> dict[str, xr.Dataset]:
    """Return the results of one amplitude by their labels, in drawing order."""
    names = {SIMULATION: SIMULATION} | LEGEND
    return {name: group[key].to_dataset() for key, name in names.items() if key in group}


def _draw(axes: list[Axes], results: dict[str, xr.Dataset], quantity: str, unit: float) -> None:
    """Draw the quantity, and its differences from the exact one divided by ``unit``.

    If Ctrl-C came before the theories there are no differences.
    """
    overlay(results, quantity, along="mean_position", ax=axes[0])
    axes[0].set_xlabel("")
    if LEGEND["exact"] not in results:
        return
    reference = results[LEGEND["exact"]][quantity]
    differences = {}
    for name, result in results.items():
        difference = ((result[quantity] - reference) / unit).assign_attrs(reference.attrs)
        differences[name] = result.assign({quantity: difference})
        if f"{quantity}_error" in result:
            differences[name][f"{quantity}_error"] = result[f"{quantity}_error"] / unit
    overlay(differences, quantity, along="mean_position", ax=axes[1])


def _panels(number: int) -> tuple[Figure, list[list[Axes]]]:
    """Make a lettered panel for each amplitude, with one for differences below it."""
    width = picture_width(2 if number > 1 else 1)
    columns = min(number, 2 if width > picture_width(1) else 1)
    rows = math.ceil(number / columns)
    figure = plt.figure(figsize=(width, 2.7 * rows + 0.3), layout="constrained")
    parts = figure.subfigures(rows, columns, squeeze=False).ravel()[:number]
    made = [list(part.subplots(2, 1, sharex=True, height_ratios=(3, 1.3))) for part in parts]
    if number > 1:
        letter([above for above, _ in made])
    return figure, made


def _title(chain: Chain) -> str:
    return rf"$A = {chain.amplitude:g}$,  $s = {chain.thermal_length:.3g}\,R$"
