"""Draw pictures of the README: the end of an elastic chain, a fluid in time, a dissipative chain.

Run it to write edge.png, profiles.png, spacetime.png and dissipative.png beside it, and to print
how far theory and simulation are apart. It takes a minute.
"""

from collections.abc import Mapping
from typing import Any

import xarray as xr
from matplotlib.figure import Figure
from small_files import save

import crazybilliards as cb
from crazybilliards.comparison.curves import axis_label
from crazybilliards.comparison.drawing import (
    COLOURS,
    TWO_COLUMNS,
    along_the_chain,
    draw_rods,
    entitle,
    house_style,
    legend_above,
    panels,
)
from crazybilliards.comparison.side_by_side.relaxation import LEGEND
from crazybilliards.comparison.stationary_theories import TITLES

SIZE = 100
SIMULATION = "simulation"
EXACT, BALANCE, GAS = (TITLES[name] for name in ("equilibrium", "force_balance", "steady_state"))
LOOKS: dict[str, dict[str, Any]] = {
    SIMULATION: {"color": "black", "linestyle": "none"},
    EXACT: {"color": COLOURS[0]},
    BALANCE: {"color": COLOURS[4], "linestyle": "--"},
    GAS: {"color": COLOURS[0]},
    f"{EXACT}, $e = 1$": {"color": "0.5", "linestyle": "--"},
}
TIMES = (0.0, 1.0, 4.0)  # t_0
RESTITUTIONS = (1.0, 0.98, 0.9, 0.5)


def edge() -> Figure:
    """Draw the densities at the right end of an elastic chain, binned as in the paper."""
    chain = cb.Chain(size=SIZE, amplitude=3)
    results = {
        SIMULATION: cb.simulate(chain, duration=100_000, replicas=2, threads=1, progress=False),
        EXACT: cb.equilibrium(chain),
        BALANCE: cb.force_balance(chain),
    }
    results = smoothed(results)
    figure = Figure(figsize=(TWO_COLUMNS, 2.9))
    ax = figure.subplots()
    shown = {name: each.sel(x=slice(88, 111)) for name, each in results.items()}
    cb.overlay(shown, ax=ax, style={name: LOOKS[name] for name in shown})
    ax.set(xlim=(88, 111), ylim=(0, None))
    ax.legend(loc="lower left")
    return figure


def smoothed(results: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """Return results with smooth densities; print their distances from the simulation."""
    densities = {name: cb.smooth(result) for name, result in results.items()}
    for name, each in densities.items():
        print(f"{name}: {100 * cb.deviation(densities[SIMULATION], each).maximum:.2f} %")
    return densities


def released() -> dict[str, xr.Dataset]:
    """Return the smoothed densities in time of a chain that is released from a compressed state."""
    chain = cb.Chain(size=SIZE, amplitude=30)
    tree = cb.compare_relaxation(chain, replicas=3000, threads=1, progress=False)
    keys = SIMULATION, "isothermal", "evolving"
    return {LEGEND.get(key, key): cb.smooth(tree[key].to_dataset()) for key in keys}


def profiles(densities: Mapping[str, xr.Dataset]) -> Figure:
    """Draw the densities at three times."""
    figure, [ax] = panels(1, 1, height=3.4)
    for colour, time in zip((COLOURS[0], COLOURS[4], COLOURS[2]), TIMES, strict=True):
        rods, isothermal, fluid = (each.sel(time=time) for each in densities.values())
        drawn = slice(None, None, rods.x.size // 60)
        ax.plot(rods.x[drawn], rods.density[drawn], "o", color=colour, markerfacecolor="none")
        ax.plot(fluid.x, fluid.density, color=colour, label=f"$t = {time:g}\\ t_0$")
        ax.plot(isothermal.x, isothermal.density, "--", color=colour, linewidth=0.8)
    ax.plot([], [], "o", color="0.4", markerfacecolor="none", label=SIMULATION)
    ax.plot([], [], color="0.4", label="with a temperature")
    ax.plot([], [], "--", color="0.4", label="isothermal")
    ax.set(xlabel=axis_label(rods.x), ylabel=axis_label(rods.density), xlim=(-220, 220))
    ax.set_ylim(0, 0.5)
    legend_above(figure, ax, title="lines: hydrodynamics")
    return figure


def spacetime(densities: Mapping[str, xr.Dataset]) -> Figure:
    """Draw the densities over position and time."""
    figure, axes = panels(1, 3, height=2.4, sharex=True, sharey=True)
    for ax, (name, each) in zip(axes, densities.items(), strict=True):
        inside = each.sel(x=slice(-225, 225), time=slice(0, 20))
        image = ax.pcolormesh(
            inside.x, inside.time, inside.density, vmin=0, vmax=0.5, rasterized=True
        )
        entitle(ax, name)
        ax.set_xlabel(axis_label(each.x))
    axes[0].set_ylabel(axis_label(each.time))
    figure.colorbar(image, ax=axes, label=axis_label(each.density))
    return figure


def dissipative() -> Figure:
    """Draw velocity widths at four restitutions, and the density at one of them."""
    figure, (left, right) = panels(1, 2, height=2.6)
    for number, e in enumerate(RESTITUTIONS):
        chain = cb.Chain(size=SIZE, amplitude=30, restitution=e)
        run = cb.simulate(chain, duration=5000, replicas=2, threads=1, progress=False)
        gas = cb.steady_state(chain)
        rods, unit = gas.normalized_particle, chain.free_velocity_width
        draw_rods(left, run, "velocity_width", number=number, unit=unit, label=f"$e = {e:g}$")
        left.plot(rods, gas.velocity_width / unit, color=COLOURS[number])
        worst = abs(gas.velocity_width / run.velocity_width.values - 1).max()
        print(f"velocity width at e = {e:g}: {100 * float(worst):.1f} %")
    left.plot([], [], color="0.4", label=GAS)
    results = smoothed({SIMULATION: run, GAS: gas})
    elastic = cb.smooth(cb.equilibrium(chain.replace(restitution=1.0)))
    results |= {f"{EXACT}, $e = 1$": elastic}
    cb.overlay(results, ax=right, style={name: LOOKS[name] for name in results})
    entitle(right, f"$e = {e:g}$")
    along_the_chain(left)
    left.set(ylabel="velocity width $W_v/W$", ylim=(0, 1.1))
    left.legend(loc="upper center", bbox_to_anchor=(0.5, 0.92), ncols=2)
    right.set_xlim(-180, 180)
    right.legend(loc="lower center")
    return figure


if __name__ == "__main__":
    with house_style():
        save(edge(), "edge.png")
        save(dissipative(), "dissipative.png")
        flows = released()
        save(profiles(flows), "profiles.png")
        save(spacetime(flows), "spacetime.png", colours=256)
