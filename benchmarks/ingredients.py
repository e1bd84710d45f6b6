"""The picture of every ingredient of the correlated theory, which neighbours.py draws."""

from pathlib import Path

import numpy as np
import xarray as xr

from crazybilliards.comparison.drawing import COLOURS, SYMBOLS
from crazybilliards.comparison.layout import house_style, legend_above, panels
from crazybilliards.model import Chain

_MODES = 3  # panel of the spectrum


def values_of(
    run: xr.Dataset, chain: Chain
) -> dict[str, tuple[xr.DataArray, np.ndarray, np.ndarray]]:
    """Return coordinate, values and errors, in free units, of what is drawn of a result.

    The last is the square root of ``contact_temperature``, for which the theory has F sqrt(Theta).
    """
    square = chain.free_velocity_width**2
    found = run.assign(
        temperature=run.velocity_width**2,
        before=np.sqrt(np.pi) / 2 / (1 - chain.restitution) * run.contact_loss / run.contact_force,
    )
    if "contact_temperature" in run:
        found["temperature_error"] = 2 * run.velocity_width * run.velocity_width_error
        found["before_error"] = run.contact_temperature_error / 2 / found.before
    # The error drawn of Theta/T is that of Theta alone.
    own = found.temperature.values
    drawn = {
        "$T/W^2$": ("temperature", square),
        r"$\Theta/T$": ("relative_temperature", (own[1:] + own[:-1]) / 2),
        r"$h_c = \langle v_i v_{i+1}\rangle/W^2$": ("neighbour_covariance", square),
        r"$\langle|v_q|^2\rangle/W^2$": ("mode_velocity_variance", square),
        r"force $P\ [k s]$": ("contact_force", chain.stiffness * chain.thermal_length),
        r"before a collision: $\sqrt{\Theta_c}/W$": ("before", chain.free_velocity_width),
    }
    places = {
        "particle": (found.particle - 0.5) / chain.size,
        "contact": found.contact / chain.size,
        "mode": found.mode,
    }
    return {
        label: (
            places[str(found[name].dims[0])],
            found[name].values / unit,
            found.get(f"{name}_error", 0 * found[name]).values / unit,
        )
        for label, (name, unit) in drawn.items()
    }


def draw_ingredients(results: list[tuple[Chain, xr.Dataset, xr.Dataset]], figure: Path) -> None:
    """Draw six panels of chains, their simulations and their theories."""
    with house_style():
        drawing, axes = panels(2, 3, height=2.3)
        for number, (chain, run, theory) in enumerate(results):
            runs, lines = values_of(run, chain), values_of(theory, chain)
            for ax, (name, found) in zip(axes, runs.items(), strict=True):
                last = len(found[0]) - 1
                shown = np.linspace(0, last, 30).astype(int)
                if ax is axes[_MODES]:  # mode 0 is exact, and beyond a logarithmic axis
                    shown = np.unique(np.geomspace(1, last, 24).astype(int))
                ax.errorbar(
                    *(each[shown] for each in found),
                    linestyle="none",
                    marker=SYMBOLS[number],
                    markerfacecolor="none",
                    color=COLOURS[number],
                    label=f"$L = {chain.size}$, $e = {chain.restitution:g}$",
                )
                place, values, _ = lines[name]
                first = int(ax is axes[_MODES])
                ax.plot(place[first:], values[first:], color=COLOURS[number])
                ax.set(xlabel="label $l/L$", ylabel=name)
        for ax in axes:
            ax.set_ylim(bottom=0)
        axes[_MODES].set(xlabel="mode $q$", xlim=(0.8, None), ylim=(0.02, 1))
        axes[_MODES].set(xscale="log", yscale="log")
        legend_above(drawing, axes[0], "symbols: simulation, lines: theory")
        drawing.savefig(figure)
