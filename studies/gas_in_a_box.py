"""When are rods between two walls a fluid? Sound, the release from one half, and the pressure.

    python -m studies.gas_in_a_box docs/figures

writes ``gas_sound.png``, ``gas_release.png`` and ``gas_pressure.png`` there, and prints the numbers
behind them. There are no springs, R = 1, and T and the mean mass are 1, so that W = 1. kappa = pi/l
is the slowest wave in the free length l = X - 2RL. Takes a minute on one core.
"""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points, entitle, legend_above, panels
from crazybilliards.kinetic import equilibrium_states, hydrodynamics
from crazybilliards.model import Array, Chain
from crazybilliards.particles import simulate
from studies.common import Table, options, print_table, save_picture

LOOKS: dict[str, dict[str, Any]] = {  # the lines, in order
    "isothermal fluid": {"color": COLOURS[1], "linestyle": "--"},
    "fluid with a temperature": {"color": COLOURS[0], "linestyle": "-"},
    "one mass, exact": {"color": COLOURS[6], "linestyle": ":", "linewidth": 1.5},
}
FLUIDS = {"isothermal fluid": None, "fluid with a temperature": "evolving"}
RODS = {1.0: "rods of one mass", 3.0: "rods of two masses"}  # by the ratio
NONE = 1e-3  # damping in place of 0 for a fluid, whose temperature is that of the noise

WAVES = ((1.0, 0.0), (3.0, 0.0), (3.0, 0.2))  # mass ratio, Gamma/kappa W
WAVE_SIZE, WAVE_RUNS, WAVE_TIMES = 256, 1500, 48
DRAWN = 2, 4  # every such point of the waves and of the releases
PERIOD = 2 * math.pi / math.sqrt(3)  # of the fluid with a temperature, times kappa W

RELEASES = (0.0, 5.0)  # Gamma l/W
RELEASED = {1.0: (50, 2000), 3.0: (200, 500)}  # mass ratio: rods, runs
RELEASE_TIMES = 64
RELEASE_END = 2.0  # l/W
RELEASE_T = np.linspace(0, RELEASE_END, RELEASE_TIMES + 1)

FILLINGS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95)
GAS_SIZE, GAS_TIMES = 50, {1.0: 40_000.0, 0.9: 12_000.0}  # by restitution, in m/gamma
SHARE = 0.1  # Gamma l/LW, how far a rod flies in m/gamma


def gas(size: int, room: float, damping: float, ratio: float = 1.0) -> Chain:
    """Return a chain without springs at T = 1, of the mean mass 1; ``room`` is l."""
    kick, light = math.sqrt(2 * damping), 2 / (1 + ratio)
    walls: dict[str, Any] = {"box": room + 2 * size, "stiffness": 0.0, "mass_ratio": ratio}
    return Chain(size=size, mass=light, damping=damping, amplitude=kick, **walls)


def places(result: xr.Dataset, size: int) -> Array:
    """Return y of the snapshots, over time, replica and particle."""
    x = result.position.transpose("time", "replica", "particle").values
    return x - 2 * (np.arange(size) - (size - 1) / 2)


def run(
    chain: Chain, start: xr.Dataset, duration: float, outputs: int, *, free: bool
) -> xr.Dataset:
    """Return snapshots of all states of ``start``; ``free`` without noise and damping."""
    every, damping = duration / outputs, chain.damping
    if free:
        chain, damping = chain.replace(damping=0.0, amplitude=0.0), 0.0
    light = chain.rod_masses.min()
    steps = math.ceil(every * damping / (0.1 * light)) if chain.mass_ratio != 1 else 1
    how: dict[str, Any] = {"average": "ensemble", "replicas": start.sizes["replica"], "seed": 2}
    how |= {"threads": 1, "every": every, "time_step": every / max(steps, 1), "progress": False}
    return simulate(chain, start=start, duration=duration, observe="snapshots", **how)


# -- sound ----------------------------------------------------------------------------------------


def sound(ratio: float, damping: float) -> dict[str, tuple[Array, Array]]:
    """Return <p(t) p(0)>/<p(0)^2>, p = sum of m v sin(kappa y), with errors; and the lines."""
    k = math.pi / WAVE_SIZE
    chain = gas(WAVE_SIZE, WAVE_SIZE, (damping or NONE) * k, ratio)
    start = equilibrium_states(chain, WAVE_RUNS, seed=1)
    found = run(chain, start, PERIOD / k, WAVE_TIMES, free=not damping)
    wave = np.sin(k * (places(found, chain.size) + chain.size / 2))
    v = found.velocity.transpose("time", "replica", "particle").values
    p = np.einsum("trp,p,trp->tr", v, chain.rod_masses, wave)
    values = (p * p[0]).mean(1) / (p[0] ** 2).mean()
    rest = (p - values[:, None] * p[0]) * p[0]
    errors = rest.std(1) / math.sqrt(WAVE_RUNS) / (p[0] ** 2).mean()
    curves = {name: fluid_wave(chain, kind) for name, kind in FLUIDS.items()}
    if ratio == 1:
        t = found.time.values * k
        curves["one mass, exact"] = (1 - t**2) * np.exp(-(t**2) / 2)
    none = np.zeros(values.size)
    return {"rods": (values, errors)} | {name: (each, none) for name, each in curves.items()}


def fluid_wave(chain: Chain, kind: str | None) -> Array:
    """Return the same of a fluid, from a small wave of its velocity."""
    L, k = chain.size, math.pi / chain.size
    label = np.linspace(0, L, 2001)
    x = 3 * (label - L / 2)  # l = L
    columns = {"density": np.full(x.size, 1 / 3), "label": label}
    columns |= {"velocity_variance": np.ones(x.size), "flow_velocity": 0.01 * np.sin(k * label)}
    start = xr.Dataset({name: ("x", each) for name, each in columns.items()}, {"x": x})
    times: dict[str, Any] = {"duration": PERIOD / k, "every": PERIOD / k / WAVE_TIMES}
    flow = hydrodynamics(chain, start, velocity_variance=kind, progress=False, **times)
    rod = np.sin(k * (np.arange(L) + 0.5))
    wave = flow.mean_velocity.transpose("time", "particle").values @ rod
    return wave / wave[0]


def draw_sound(found: dict[tuple[float, float], dict[str, tuple[Array, Array]]]) -> Figure:
    figure, axes = panels(1, len(WAVES), height=2.5, sharex=True, sharey=True)
    t = np.linspace(0, PERIOD, WAVE_TIMES + 1)
    for ax, ((ratio, damping), curves) in zip(axes, found.items(), strict=True):
        draw_every(ax, DRAWN[0], t, curves["rods"], number=4, label="rods")
        draw_lines(ax, t, curves)
        masses = "one mass" if ratio == 1 else "two masses"
        entitle(ax, f"{masses}, " + (rf"$\Gamma = {damping}\,\kappa W$" if damping else "undamped"))
        ax.set(xlim=(-0.06, PERIOD + 0.06), ylim=(-1.1, 1.1), xlabel=r"time $t$ [$1/\kappa W$]")
    axes[0].set_ylabel(r"$\langle p(t)\,p(0)\rangle\,/\,\langle p(0)^2\rangle$")
    legend_above(figure, axes[0])
    return figure


def draw_every(ax: Axes, step: int, t: Array, of: tuple[Array, Array], **look: Any) -> None:
    shown = (each[::step] for each in (t, *of))
    draw_points(ax, *shown, linestyle="none", markerfacecolor="none", zorder=3, **look)


def draw_lines(ax: Axes, t: Array, curves: dict[str, tuple[Array, Array]]) -> None:
    for name, look in LOOKS.items():
        if name in curves:
            ax.plot(t, curves[name][0], label=name, **look)


def table_of_sound(found: dict[tuple[float, float], dict[str, tuple[Array, Array]]]) -> Table:
    """Give the first minimum, and how far the fluids are (root mean square over time)."""
    heads = "mass ratio", "Gamma/kappa W", "minimum", "at kappa W t =", "at last", "errors"
    yield *heads, *(f"{name}, rms" for name in LOOKS)
    for (ratio, damping), curves in found.items():
        values, errors = curves["rods"]
        least = int(values.argmin())
        off = [
            f"{np.sqrt(np.mean((values - curves[name][0]) ** 2)):.3f}" if name in curves else ""
            for name in LOOKS
        ]
        low, last = (f"{values[n]:.3f} ± {errors[n]:.3f}" for n in (least, -1))
        time, mean = f"{PERIOD * least / WAVE_TIMES:.2f}", f"{np.sqrt((errors**2).mean()):.3f}"
        yield f"{ratio:g}", f"{damping:g}", low, time, last, mean, *off


# -- release --------------------------------------------------------------------------------------


def release(damping: float) -> dict[str, tuple[Array, Array]]:
    """Return the share of the rods beyond the middle, over time, with errors; and the lines."""
    curves = {}
    for ratio, (size, runs) in RELEASED.items():
        chain = gas(size, size, (damping or NONE) / size, ratio)
        generator = np.random.default_rng(1)
        y = np.sort(generator.uniform(-size / 2, 0, (runs, size)), axis=1)
        v = generator.normal(size=y.shape) / np.sqrt(chain.rod_masses)
        states = {"position": chain.physical(y), "velocity": v}
        start = xr.Dataset({name: (("replica", "particle"), each) for name, each in states.items()})
        found = run(chain, start, RELEASE_END * size, RELEASE_TIMES, free=not damping)
        beyond = (places(found, size) > 0).mean(2)
        curves[RODS[ratio]] = beyond.mean(1), beyond.std(1) / math.sqrt(runs)
    size, _ = RELEASED[1.0]
    chain, none = gas(size, size, (damping or NONE) / size), np.zeros(RELEASE_TIMES + 1)
    curves |= {name: (fluid_release(chain, kind), none) for name, kind in FLUIDS.items()}
    return curves | {"one mass, exact": (exact_release(RELEASE_T, damping), none)}


def fluid_release(chain: Chain, kind: str | None) -> Array:
    L, end = chain.size, chain.box / 2
    label = np.linspace(0, L, 2001)
    x = label / 2 - L / 2 + 2 * (label - L / 2)  # y from -l/2 to 0, and l = L
    columns = {"density": np.append(np.full(x.size, 0.4), [0, 0])}
    columns |= {"label": np.append(label, [L, L])}
    x = np.append(x, [x[-1] + 1e-6, end])
    start = xr.Dataset({name: ("x", each) for name, each in columns.items()}, {"x": x})
    times: dict[str, Any] = {"duration": RELEASE_END * L, "every": RELEASE_END * L / RELEASE_TIMES}
    how: dict[str, Any] = {"frame": "eulerian", "progress": False}  # has the jumps of shocks
    flow = hydrodynamics(chain, start, velocity_variance=kind, **times, **how)
    y = np.maximum.accumulate(flow.x.values - 2 * (flow.label.values - L / 2), axis=1)
    pairs = zip(y, flow.label.values, strict=True)
    return np.array([1 - np.interp(0, *each) / L for each in pairs])


def exact_release(t: Array, damping: float) -> Array:
    """Return 1/2 - sum over odd q of (2/(pi q))^2 exp(-(pi q)^2 M/2), in units of l and l/W."""
    M = t**2
    if damping:
        M = 2 * (damping * t + np.expm1(-damping * t)) / damping**2
    q = np.pi * np.arange(1, 2001, 2)
    return 0.5 - ((2 / q) ** 2 * np.exp(-np.multiply.outer(M, q**2) / 2)).sum(1)


def draw_release(found: dict[float, dict[str, tuple[Array, Array]]]) -> Figure:
    figure, axes = panels(1, len(RELEASES), height=2.6, sharey=True)
    for ax, (damping, curves) in zip(axes, found.items(), strict=True):
        for number, name in zip((4, 2), RODS.values(), strict=True):
            draw_every(ax, DRAWN[1], RELEASE_T, curves[name], number=number, label=name)
        draw_lines(ax, RELEASE_T, curves)
        entitle(ax, rf"$\Gamma = {damping:g}\,W/l$" if damping else "undamped")
        ax.set(xlim=(-0.04, 2.04), xticks=(0, 1, 2), ylim=(0, 0.8), xlabel="time $t$ [$l/W$]")
    axes[0].set_ylabel("share beyond the middle")
    legend_above(figure, axes[0])
    return figure


def table_of_release(found: dict[float, dict[str, tuple[Array, Array]]]) -> Table:
    shown = [RELEASE_TIMES * n // 16 for n in (2, 4, 6, 8, 12, 16)]
    yield "Gamma l/W", "at tW/l =", *(f"{RELEASE_T[n]:g}" for n in shown)
    for damping, curves in found.items():
        for name, (values, errors) in curves.items():
            bars = [f" ± {errors[n]:.3f}" if errors[n] else "" for n in shown]
            cells = [f"{values[n]:.3f}{bar}" for n, bar in zip(shown, bars, strict=True)]
            yield f"{damping:g}", name, *cells


# -- pressure -------------------------------------------------------------------------------------


def pressure(restitution: float) -> Array:
    """Return 2R P/(m W_v^2), its standard error and W_v/W at each filling; W_v = W at e = 1."""
    rows = []
    for seed, filling in enumerate(FILLINGS):
        room = 2 * GAS_SIZE * (1 - filling) / filling
        chain = gas(GAS_SIZE, room, SHARE * GAS_SIZE / room).replace(restitution=restitution)
        times: dict[str, Any] = {"duration": GAS_TIMES[restitution] / chain.damping, "threads": 1}
        how: dict[str, Any] = {"observe": ["walls", "widths"], "seed": seed, "progress": False}
        found = simulate(chain, **times, **how)
        widths = found.velocity_width.values
        square = 1.0 if restitution == 1 else float((widths**2).mean())
        # Both walls together scatter less than two independent ones: the errors are upper bounds.
        force, error = found.wall_force.values.mean(), np.hypot(*found.wall_force_error.values) / 2
        rows.append([2 * force / square, 2 * error / square, math.sqrt(square)])
    return np.array(rows)


def tonks(filling: Array) -> Array:
    """Return 2R P/T of the paper's pressure, rho T/(1 - 2 R rho)."""
    return filling / (1 - filling)


def draw_pressure(found: dict[float, Array]) -> Figure:
    figure, axes = panels(2, 1, height=1.9, sharex=True, height_ratios=(2, 1))
    filling, line = np.array(FILLINGS), np.linspace(0.03, 0.965, 200)
    axes[0].plot(line, tonks(line), color=COLOURS[0], label=r"$\rho T/(1 - 2R\rho)$")
    axes[0].plot(line, line, "--", color=COLOURS[1], label=r"ideal gas, $\rho T$")
    axes[1].axhline(1, color=COLOURS[0])
    for number, (e, rows) in zip((4, 2), found.items(), strict=True):
        label = "rods, $e = 1$" if e == 1 else f"$e = {e}$, with $mW_v^2$ for $T$"
        values, errors, _ = rows.T
        look: dict[str, Any] = {"number": number, "linestyle": "none", "zorder": 3}
        draw_points(axes[0], filling, values, errors, label=label, **look)
        draw_points(axes[1], filling, values / tonks(filling), errors / tonks(filling), **look)
    axes[0].set(yscale="log", ylabel=r"pressure $P$ [$T/2R$]")
    axes[0].legend(loc="upper left")
    axes[1].set(xlim=(0, 1), xlabel=r"density $\rho$ [$1/2R$]", ylabel="rods / line")
    return figure


def table_of_pressure(found: dict[float, Array]) -> Table:
    yield "2R rho", "e", "2R P/mW_v^2", "over the line", "W_v/W"
    for e, rows in found.items():
        for filling, (value, error, width) in zip(FILLINGS, rows, strict=True):
            law = filling / (1 - filling)
            over = f"{value / law:.4f} ± {error / law:.4f}"
            yield f"{filling:g}", f"{e:g}", f"{value:.4f}", over, f"{width:.3f}"


def main() -> None:
    folder = options(__doc__, folder=Path).folder
    waves = {wave: sound(*wave) for wave in WAVES}
    print_table(table_of_sound(waves))
    save_picture(folder / "gas_sound.png", draw_sound, waves)
    shares = {damping: release(damping) for damping in RELEASES}
    print_table(table_of_release(shares))
    save_picture(folder / "gas_release.png", draw_release, shares)
    pressures = {restitution: pressure(restitution) for restitution in GAS_TIMES}
    print_table(table_of_pressure(pressures))
    save_picture(folder / "gas_pressure.png", draw_pressure, pressures)


if __name__ == "__main__":
    warnings.filterwarnings("ignore", "equal elastic rods|damping=0")  # that is what is shown
    main()
