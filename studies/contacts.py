r"""What happens at the contacts of a chain: simulation and the theory with pair correlations.

    python -m studies.contacts FOLDER [--duration 12000]

Prints what docs/correlations.md says of contacts, in units of the free rod. The first two
tables are correlations_ingredients.csv and neighbourhoods.csv in docs/tables.

1. At the contacts 1, 4, 10 and in the centre: the force P, the speed before a collision (the root
   of ``contact_temperature``, for which the theory has K F sqrt(Theta)), the covariance of the
   velocities of rods two apart, and the covariances of the distance at one contact with the
   relative temperature and with the distance at the next, relative to the means.
2. <v_i^2> of a rod, and the mean of the temperature T(y) over the places y where the rod is.
3. ``contact_temperature`` over ``relative_temperature`` in the centre of 20 rods.

FOLDER/ingredients.png shows what the theory is made of, for the last two chains of the first table.
The time step is a quarter of the default one. Takes 20 seconds.
"""

from functools import cache
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.kinetic import correlated_phase_space
from crazybilliards.kinetic.gas.contact_speeds import contact_speed
from crazybilliards.kinetic.correlations.stationary import in_agreement
from crazybilliards.model import Chain
from crazybilliards.particles import simulate
from crazybilliards.particles.observers import Covariances
from crazybilliards.particles.scales import default_time_step
from studies.common import Table, options, print_table, save_picture

CHAINS = (
    Chain(size=30, restitution=0.9),
    Chain(size=100, restitution=0.75),
    Chain(size=30, restitution=0.5),
)
SHORT = (Chain(size=20, restitution=0.75), Chain(size=20, restitution=0.3))
PLACES = Chain(size=30, restitution=0.75)
RODS = (1, 3, 8, 15)
CONTACTS = (1, 4, 10)  # and the one in the centre
FINER = 4  # than the default time step
TOLERANCE = 2e-3  # of the theory, its default
BLOCKS = 16  # of time, whose scatter gives the errors of what snapshots give
CELLS = 22  # of the drawn theory
MODES = 3  # panel of the spectrum
BIN = 0.2  # of T(y), in thermal lengths
Values = np.ndarray


@cache  # the picture shows the runs of the first table
def measured(chain: Chain, duration: float) -> xr.Dataset:
    return simulate(
        chain,
        duration=duration,
        time_step=default_time_step(chain) / FINER,
        every=0.5,
        seed=11,
        observe=("widths", Covariances(separations=2), "modes", "impacts", "snapshots"),
        threads=1,
        progress=False,
    )


def snapshots(run: xr.Dataset, chain: Chain) -> tuple[Values, Values]:
    """Return displacements, which are the reduced positions, and velocities: (times, rods)."""
    x, v = (run[name].values.reshape(-1, chain.size) for name in ("position", "velocity"))
    return (x - chain.anchors) / chain.thermal_length, v / chain.free_velocity_width


def next_contacts(run: xr.Dataset, chain: Chain) -> Values:
    """Return covariances of the distance at a contact with temperature and distance at the next.

    Shape (blocks, 2, contacts - 1), relative to the means of the whole run.
    """
    y, v = snapshots(run, chain)
    gap, theta = np.diff(y), np.diff(v) ** 2 / 2
    gap, theta = gap / gap.mean(axis=0) - 1, theta / theta.mean(axis=0) - 1
    both = (gap[:, :-1] * theta[:, 1:] + gap[:, 1:] * theta[:, :-1]) / 2, gap[:, :-1] * gap[:, 1:]
    blocks = [np.array_split(each, BLOCKS) for each in both]
    return np.array([[part.mean(axis=0) for part in of] for of in blocks]).swapaxes(0, 1)


def simulated(chain: Chain, duration: float) -> list[tuple[Values, Values]]:
    """Return values and errors along the chain of the five quantities."""
    run = measured(chain, duration)
    speed = chain.free_velocity_width
    root = np.sqrt(run.contact_temperature.values)
    two_apart = run.sel(separation=2).isel(particle=slice(0, -2))
    blocks = next_contacts(run, chain)
    values, errors = blocks.mean(axis=0), blocks.std(axis=0, ddof=1) / np.sqrt(BLOCKS)

    def of(found: xr.Dataset, name: str, unit: float) -> tuple[Values, Values]:
        return found[name].values / unit, found[f"{name}_error"].values / unit

    return [
        of(run, "contact_force", chain.stiffness * chain.thermal_length),
        (root / speed, run.contact_temperature_error.values / (2 * root) / speed),
        of(two_apart, "velocity_covariance", speed**2),
        *zip(values, errors, strict=True),
    ]


def theoretical(chain: Chain) -> list[Values]:
    """Return the same of the theory, whose cells are single rods for up to 130 rods."""
    found = in_agreement(chain, TOLERANCE)
    around, pairs = found.background, found.pairs
    return [
        around.pressure,
        contact_speed(chain.restitution)
        * np.exp(found.closure.log_clustering)
        * np.sqrt(around.temperature),
        np.diag(pairs.velocity, 2),
        (np.diag(pairs.gap_temperature, 1) + np.diag(pairs.gap_temperature, -1)) / 2,
        np.diag(pairs.gap, 1),
    ]


def at_contacts(duration: float) -> Table:
    names = "P", "speed before a collision", "<v_i v_(i+2)>", "h_gTheta", "h_gg"
    yield "L", "e", "quantity", *(f"contact {number}" for number in CONTACTS), "centre"
    for chain in CHAINS:
        rows = zip(names, simulated(chain, duration), theoretical(chain), strict=True)
        for name, (values, errors), theory in rows:
            even = (values + values[::-1]) / 2  # a place and its mirror image
            shown = [
                f"{even[at]:.3f} ± {errors[at] / np.sqrt(2):.1g} / {theory[at]:.3f}"
                for at in (*(contact - 1 for contact in CONTACTS), (even.size - 1) // 2)
            ]
            yield chain.size, f"{chain.restitution:g}", name, *shown


def at_places(duration: float) -> Table:
    yield "rod", "<v_i^2>", "mean of T(y) over the places of the rod"
    y, v = snapshots(measured(PLACES, duration), PLACES)
    place = np.floor(y / BIN).astype(int)
    place -= place.min()
    rods = np.bincount(place.ravel())
    squares = np.bincount(place.ravel(), weights=(v**2).ravel())
    there = squares / np.maximum(rods, 1)
    for rod in RODS:
        mirrored = [rod - 1, PLACES.size - rod]
        own, seen = v[:, mirrored] ** 2, there[place[:, mirrored]]
        blocks = [part.mean() for part in np.array_split(own, BLOCKS)]
        error = np.std(blocks, ddof=1) / np.sqrt(BLOCKS)
        yield rod, f"{own.mean():.3f} ± {error:.1g}", f"{seen.mean():.3f}"


def of_short_chains(duration: float) -> Table:
    yield "rods", "e", "contact temperature over relative temperature, centre"
    for chain in SHORT:
        centre = measured(chain, duration).sel(contact=slice(9, 11))
        ratio = (centre.contact_temperature / centre.relative_temperature).mean()
        # Neighbouring contacts err together.
        contact, relative = (
            float((centre[f"{name}_temperature_error"] / centre[f"{name}_temperature"]).mean())
            for name in ("contact", "relative")
        )
        error = float(ratio) * np.hypot(contact, relative)
        yield chain.size, f"{chain.restitution:g}", f"{float(ratio):.2f} ± {error:.2f}"


def ingredients(found: xr.Dataset, chain: Chain) -> dict[str, tuple[Values, Values, Values]]:
    """Return coordinates, values and errors of what is drawn, in free units, by labels of axes.

    The last is the root of ``contact_temperature``, for which the theory has K F sqrt(Theta).
    """
    square, own = chain.free_velocity_width**2, found.velocity_width.values**2
    root_of_pi = np.sqrt(np.pi)
    found = found.assign(
        temperature=found.velocity_width**2,
        before=root_of_pi / 2 / (1 - chain.restitution) * found.contact_loss / found.contact_force,
    )
    if "contact_temperature" in found:
        found["temperature_error"] = 2 * found.velocity_width * found.velocity_width_error
        found["before_error"] = found.contact_temperature_error / 2 / found.before
    units = {  # the error drawn of Theta/T is that of Theta alone
        "$T/W^2$": ("temperature", square),
        r"$\Theta/T$": ("relative_temperature", (own[1:] + own[:-1]) / 2),
        r"$h_c = \langle v_i v_{i+1}\rangle/W^2$": ("neighbour_covariance", square),
        r"$\langle|v_q|^2\rangle/W^2$": ("mode_velocity_variance", square),
        r"force $P\ [k s]$": ("contact_force", chain.stiffness * chain.thermal_length),
        r"before a collision: $\sqrt{\Theta_c}/W$": ("before", chain.free_velocity_width),
    }
    places = {"particle": (found.particle - 0.5) / chain.size}
    places |= {"contact": found.contact / chain.size, "mode": found.mode}
    drawn = {}
    for label, (name, unit) in units.items():
        errors = found.get(f"{name}_error", 0 * found[name])
        place = places[str(found[name].dims[0])].values
        drawn[label] = place, found[name].values / unit, errors.values / unit
    return drawn


def draw(duration: float) -> Figure:
    figure, axes = panels(2, 3, height=2.3)
    for number, chain in enumerate(CHAINS[1:]):
        runs = ingredients(measured(chain, duration), chain)
        lines = ingredients(correlated_phase_space(chain, cells=CELLS), chain)
        for ax, (name, found) in zip(axes, runs.items(), strict=True):
            first = int(ax is axes[MODES])  # mode 0 is exact, and beyond a logarithmic axis
            last = len(found[0]) - 1
            shown = np.geomspace(1, last, 24) if first else np.linspace(0, last, 30)
            place, values, errors = (each[np.unique(shown.astype(int))] for each in found)
            label = f"$L = {chain.size}$, $e = {chain.restitution:g}$"
            draw_points(ax, place, values, errors, number=number, label=label)
            place, values, _ = lines[name]
            ax.plot(place[first:], values[first:], color=COLOURS[number])
            ax.set(xlabel="label $l/L$", ylabel=name)
    for ax in axes:
        ax.set_ylim(bottom=0)
    axes[MODES].set(xlabel="mode $q$", xlim=(0.8, None), ylim=(0.02, 1))
    axes[MODES].set(xscale="log", yscale="log")
    legend_above(figure, axes[0], title="symbols: simulation, lines: theory")
    return figure


if __name__ == "__main__":
    asked = options(__doc__, folder=Path, duration=12_000.0)  # time units of each run
    for table in (at_contacts, at_places, of_short_chains):
        print_table(table(asked.duration))
    save_picture(asked.folder / "ingredients.png", draw, asked.duration)
