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
from crazybilliards.comparison.studies.elastic_chain import LEGEND
from crazybilliards.comparison.studies.parameter_series import SIMULATION
from crazybilliards.model import Chain, chain_of


def draw_density(tree: xr.DataTree) -> Figure:
    """rho(x) of simulation and theories for each amplitude, all smoothed as the paper does."""
    figure, panels = _panels(len(tree.children))
    for axes, group in zip(panels, tree.children.values(), strict=True):
        results = {name: smooth(result) for name, result in _results(group).items()}
        chain = chain_of(results[SIMULATION])
        _draw(axes, results, "density", unit=chain.close_packed_density)
        axes[0].set(title=_title(chain), ylabel=r"density $\rho$ [1/R]")
        axes[1].set(xlabel="position x [R]", ylabel=r"diff. $\times\, 2R$")
        reference = results.get(LEGEND["exact"], results[SIMULATION])
        inside = reference.density.values > 1e-4 * chain.close_packed_density
        axes[1].set_xlim(*reference.x.values[inside][[0, -1]])
    _one_legend(figure, panels)
    return figure


def draw_displacement(tree: xr.DataTree) -> Figure:
    """<dx> at the rods' mean positions, with the paper's arctanh fit, for each amplitude."""
    figure, panels = _panels(len(tree.children))
    for axes, group in zip(panels, tree.children.values(), strict=True):
        results = _results(group)
        chain = chain_of(results[SIMULATION])
        _draw(axes, results, "mean_displacement", unit=chain.thermal_length)
        axes[0].set(title=_title(chain), ylabel=r"displacement $\langle\Delta x\rangle$ [R]")
        axes[1].set(xlabel="mean position x [R]", ylabel="diff. / s")
    _one_legend(figure, panels)
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
    columns = min(number, 2)
    rows = math.ceil(number / columns)
    figure = plt.figure(figsize=(4.6 * columns, 3.4 * rows + 0.5), layout="constrained")
    parts = figure.subfigures(rows, columns, squeeze=False).ravel()[:number]
    return figure, [
        list(part.subplots(2, 1, sharex=True, height_ratios=(3, 1.3))) for part in parts
    ]


def _one_legend(figure: Figure, panels: list[list[Axes]]) -> None:
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2, frameon=False)


def _title(chain: Chain) -> str:
    return rf"$A = {chain.amplitude:g}$,  $s = {chain.thermal_length:.3g}\,R$"
