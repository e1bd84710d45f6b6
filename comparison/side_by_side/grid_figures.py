"""Pictures of chains side by side: densities, displacements and widths.

Densities and displacements have the differences from the exact equilibrium, at e != 1 from the
simulation, below them, which are too small to be seen above.
"""

import math
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.curves import axis_label, displacement_unit
from crazybilliards.comparison.drawing import (
    COLOURS,
    ONE_COLUMN,
    TWO_COLUMNS,
    along_the_chain,
    draw_rods,
    entitle,
    legend_above,
    letter,
    overlay,
    panels,
)
from crazybilliards.comparison.side_by_side.grid import ELASTIC, GAS, SIMULATION
from crazybilliards.comparison.stationary_theories import TITLES
from crazybilliards.model import chain_of

_SYMBOLS = {"amplitude": "A", "restitution": "e", "size": "L", "gap": "g", "damping": r"\gamma"}
_EXACT = TITLES["equilibrium"]
_THEORIES, _OF_THEORIES = (*ELASTIC, GAS), ("-", "--", ":", "-.", "-")
# In a picture of theories, and in one of chains, which have a colour each.
_LOOKS: dict[str, dict[str, Any]] = {SIMULATION: {"color": "black"}} | {
    TITLES[name]: {"color": colour, "linestyle": dashes}
    for name, colour, dashes in zip(_THEORIES, COLOURS, _OF_THEORIES, strict=False)
}
_BEST = ("equilibrium", GAS)  # a comparison has one of them
_LEAST_DRAWN = 1e-4  # of close packing: pictures of densities end where they are lower


def draw_density(tree: xr.DataTree) -> Figure:
    """rho(x) of each simulated chain and the best theory, smoothed as the paper does.

    The panel below has the differences of all theories at the right end, where they are largest:
    the outermost three thermal lengths, at least ten radii.
    """
    figure, pairs = _pairs(tree)
    for whole, end, rough in pairs:
        results = {name: smooth(result) for name, result in rough.items()}
        chain = chain_of(results[SIMULATION])
        density = results.get(_EXACT, results[SIMULATION]).density
        inside = density.x.values[density > _LEAST_DRAWN * chain.close_packed_density]
        length = max(3 * chain.thermal_length if chain.stiffness else 0.0, 10 * chain.radius)
        _draw_best(whole, results, "density")
        whole.set_xlim(inside[0], inside[-1])
        last = slice(inside[-1] - length, inside[-1])
        cut = {name: result.sel(x=last) for name, result in results.items()}
        _draw_differences(end, cut, "density", chain.close_packed_density)
    _finish_pairs(figure, "difference at the end\n[% of close packing]")
    return figure


def draw_displacement(tree: xr.DataTree) -> Figure:
    """<dx> of each simulated chain and the best theory, at the rods' mean positions.

    The panel below has the differences of all theories.
    """
    figure, pairs = _pairs(tree)
    for above, below, results in pairs:
        symbol, unit = displacement_unit(chain_of(results[SIMULATION]))
        _draw_best(above, results, "mean_displacement")
        _draw_differences(below, results, "mean_displacement", unit)
    _finish_pairs(figure, f"difference\n[% of ${symbol}$]")
    return figure


def _pairs(tree: xr.DataTree) -> tuple[Figure, list[tuple[Axes, Axes, dict[str, xr.Dataset]]]]:
    """Make two panels for each chain, one below the other; return its results by their titles."""
    number = len(tree.children)
    width = ONE_COLUMN if number == 1 else max(TWO_COLUMNS, TWO_COLUMNS / 4 * number)
    figure = Figure(figsize=(width, 3.6))
    upper, lower = figure.subplots(2, number, squeeze=False, height_ratios=(3, 2))
    if number > 1:
        letter(upper)
    pairs = []
    for above, below, group in zip(upper, lower, tree.children.values(), strict=True):
        entitle(above, _varied(group))
        results = {title: group[key].to_dataset() for key, title in TITLES.items() if key in group}
        pairs.append((above, below, results))
    return figure, pairs


def _finish_pairs(figure: Figure, difference: str) -> None:
    """Label the vertical axes at the left only, and put one legend above."""
    above, below = figure.axes[:: len(figure.axes) // 2]
    for ax in figure.axes:
        if ax is not above:
            ax.set_ylabel("")
    below.set_ylabel(difference)
    legend_above(figure, above, below)


def _draw_best(ax: Axes, results: dict[str, xr.Dataset], quantity: str) -> None:
    """Draw the simulation and the exact equilibrium or the gas, of which a comparison has one."""
    titles = [TITLES[name] for name in (*_BEST, SIMULATION)]
    shown = {name: results[name] for name in titles if name in results}
    overlay(shown, quantity, along="mean_position", ax=ax, style={n: _LOOKS[n] for n in shown})
    ax.set_xlabel("")


def _draw_differences(ax: Axes, results: dict[str, xr.Dataset], quantity: str, unit: float) -> None:
    """Draw the differences from the equilibrium, or the simulation, in per cent of ``unit``."""
    reference = results.get(_EXACT, results[SIMULATION])[quantity]
    differences = {}
    for name, result in results.items():
        difference = 100 / unit * (result[quantity] - reference)
        differences[name] = result.assign({quantity: difference.assign_attrs(reference.attrs)})
        if (error := result.get(f"{quantity}_error")) is not None:
            differences[name][f"{quantity}_error"] = 100 / unit * error
    looks = {name: _LOOKS[name] for name in results} | {
        SIMULATION: {"color": "black", "marker": "none"}
    }
    overlay(differences, quantity, along="mean_position", ax=ax, style=looks)


def _varied(group: xr.DataTree) -> str:
    """Return what is special about a chain, from a name such as amplitude_3."""
    name, _, value = str(group.name).rpartition("_")
    return f"${_SYMBOLS[name]} = {value}$" if name in _SYMBOLS else f"{name} {value}"


def draw_widths(tree: xr.DataTree) -> Figure:
    """W_v(i) and <dx_i> of every chain, in units of the free rod; lines are theories."""
    figure, axes = panels(1, 2, height=2.5)
    for number, group in enumerate(tree.children.values()):
        run = group[SIMULATION].to_dataset()
        chain = chain_of(run)
        symbol, length = displacement_unit(chain)
        units = {"velocity_width": chain.free_velocity_width, "mean_displacement": length}
        for ax, (name, unit) in zip(axes, units.items(), strict=True):
            draw_rods(ax, run, name, unit=unit, number=number, label=_varied(group))
            for key in _BEST:
                if key in group:
                    colour = COLOURS[number % len(COLOURS)]
                    _draw_theory(ax, group[key].to_dataset(), name, unit, color=colour)
    for key in _BEST:
        if any(key in group for group in tree.children.values()):
            axes[0].plot([], [], color="0.4", label=TITLES[key])
    axes[0].set_ylabel("velocity width $W_v/W$")
    axes[1].set_ylabel(rf"displacement $\langle\Delta x\rangle/{symbol}$")
    _finish_rods(axes)
    legend_above(figure, axes[0])
    return figure


def _finish_rods(axes: list[Axes]) -> None:
    """Begin the axis of widths at 0, so that it does not magnify the noise of equal widths."""
    axes[0].set_ylim(0, 1.05 * axes[0].get_ylim()[1])
    for ax in axes:
        along_the_chain(ax)


def _draw_theory(
    ax: Axes, theory: xr.Dataset, quantity: str, unit: float = 1.0, **look: Any
) -> None:
    """Draw a theory as a line in a band of the error that it states, both divided by ``unit``."""
    chain = chain_of(theory)
    values = theory[quantity].values / unit
    scale: Any = {
        "velocity_width": values,
        "density": chain.close_packed_density / unit,
        "mean_displacement": displacement_unit(chain)[1] / unit,
    }
    error = theory.attrs.get(f"{quantity}_model_error", 0.0) * scale[quantity]
    x = theory.x if quantity == "density" else theory.normalized_particle
    ax.plot(x, values, **look)
    ax.fill_between(x, values - error, values + error, color=look["color"], alpha=0.15, linewidth=0)


def draw_profile(theory: xr.Dataset, name: str) -> Figure:
    """W_v(i) and <dx_i> of a theory alone, called ``name`` in the legend."""
    figure, axes = panels(1, 2)
    for ax, quantity in zip(axes, ("velocity_width", "mean_displacement"), strict=True):
        _draw_theory(ax, theory, quantity, color=COLOURS[0], label=name)
        ax.set_ylabel(axis_label(theory[quantity]))
    chain, label = chain_of(theory), "free rod (and e = 1)"
    for width in sorted({math.sqrt(chain.temperature / mass) for mass in chain.rod_masses[:2]}):
        axes[0].axhline(width, color="0.4", linestyle=":", label=label)
        label = ""  # of the other mass
    _finish_rods(axes)
    axes[0].legend()
    return figure


def draw_density_alone(theory: xr.Dataset, name: str) -> Figure:
    """Draw the density of a theory alone, called ``name`` in the legend."""
    figure, [ax] = panels(1, 1)
    _draw_theory(ax, theory, "density", color=COLOURS[0], label=name)
    ax.set(xlabel=axis_label(theory.x), ylabel=axis_label(theory.density))
    ax.set_ylim(bottom=0)
    ax.legend(loc="lower center")
    return figure
