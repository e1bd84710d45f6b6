"""How far the stationary theories are from simulations, and at e = 1 from the exact equilibrium.

    python -m studies.stationary_errors FOLDER [--chains drawn]

Prints kinetic/measured/stationary.csv, from which the theories read the errors that they state, or
docs/tables/stationary_held_out.csv: chains drawn at random before any of them was looked at. Every
chain is simulated at a time step of little error, with three radii, because only its density
depends on the radius. For W_x in ``correlated_phase_space`` there is a run of its own at one
radius, which is long enough for it. The rows of a chain are kept in FOLDER when they are done. On
two cores the first table takes about an hour and a half, and the second one ten minutes.
"""

import itertools
import json
import math
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr

import crazybilliards as cb
from crazybilliards.comparison.sweeps import process_pool
from crazybilliards.kinetic import accuracy
from crazybilliards.kinetic.rods.places import at_temperature, elastic_rods
from crazybilliards.kinetic.rods.profiles import over_positions
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.model.storage import write_atomically
from crazybilliards.particles.scales import (
    centre_width,
    correlation_time,
    default_time_step,
    time_step_error,
)
from studies.common import Table, damped, options, print_table

LENGTHS = (0.7, 2.1, 7.0)  # s/R; s: thermal length
OTHER_LENGTHS = (0.9, 3.0, 10.0)  # of the chains drawn at random
# Relative accuracy of W_v in the centre of each of the three runs, by size.
ACCURACY = {10: 0.004, 30: 0.004, 100: 0.006, 300: 0.012, 1000: 0.03}
WIDTHS = {300: 0.012}  # relative error of W_x; others: twice the accuracy
HELD_OUT = 40
OF_DISPLACEMENTS = "correlated_phase_space", "displacement_width"

Row = tuple[str, int, float, float, float, float | Literal[""], str, float, float]
Place = tuple[int, float, float, float]  # L, e, Gamma = gamma/sqrt(k m), g L/s


def places() -> Iterator[Place]:
    """Give the measured chains; the long ones come last."""
    without = (0.0, 0.3, 0.5, 0.65, 0.75, 0.83, 0.9, 0.95, 0.98, 1.0)
    dampings = (0.15, 0.49, 1.5)
    for size in (10, 30, 100, 300):
        yield from itertools.product([size], without, dampings, [0.0])
        dissipative = (*without[2:8], 1.0)
        yield from itertools.product([size], dissipative, dampings, (4.0, 8.0, 14.0, 24.0, 42.0))
    for size in (10, 30, 100):
        yield from itertools.product([size], (1.0, 1.05), (1.95, 8.0), [0.0])
    yield from itertools.product([1000], (0.0, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0), [0.49], [0.0])


def held_out() -> Iterator[Place]:
    """Draw chains in the ranges of the table, half of them with a gap."""
    draw = np.random.default_rng(20261126)
    for number in range(HELD_OUT):
        size = round(math.exp(draw.uniform(math.log(10), math.log(300))))
        damping = math.exp(draw.uniform(math.log(0.15), math.log(1.5)))
        lattice = math.exp(draw.uniform(math.log(0.5), math.log(42))) if number % 2 else 0.0
        yield size, draw.uniform(0.5 if lattice else 0.0, 0.98), damping, lattice


def chain_at(place: Place, length: float) -> cb.Chain:
    """Return the chain at a place whose thermal length is so many radii."""
    size, e, damping, lattice = place
    chain = damped(size, e, damping)
    s = chain.thermal_length
    return chain.replace(gap=lattice * s / size, radius=s / length)


def accuracy_of(size: int) -> float:
    return ACCURACY[min(each for each in ACCURACY if each >= size)]


def simulated(chain: cb.Chain, accuracy: float, seed: int, *more: str) -> xr.Dataset:
    """Return what a theory is compared with: widths, and what else is to be observed.

    The stated error of the step is at most a quarter of the accuracy. The run is repeated, each
    time longer, until the standard error of W_v in the centre is as small as the accuracy.
    """
    if chain.restitution == 1:
        return cb.equilibrium(chain)
    step, width = default_time_step(chain), centre_width(chain) * chain.free_velocity_width
    while time_step_error(chain, step, width) > accuracy / 4:
        step *= 0.98
    how: dict[str, Any] = {"time_step": step, "observe": ("widths", *more), "seed": seed}
    duration = 320 * correlation_time(chain)
    while True:
        run = cb.simulate(chain, duration=duration, threads=1, progress=False, **how)
        middle = run.isel(particle=middle_tenth(chain.size))
        error = float((middle.velocity_width_error / middle.velocity_width).mean())
        if error < accuracy:
            return run
        duration *= max(1.25, (error / accuracy) ** 2)


def simulated_widths(chain: cb.Chain, accuracy: float, limit: float) -> xr.Dataset:
    """Return the widths, W_v in the centre with the relative error ``accuracy``.

    If the error of W_x is above ``limit``, another run is as much more accurate.
    """
    run = simulated(chain, accuracy, 0)
    if chain.restitution == 1:
        return run
    relative = run.displacement_width_error / run.displacement_width
    error = math.sqrt(float((relative**2).mean()))
    return run if error < 1.1 * limit else simulated(chain, accuracy * limit / error, 1)


def of_radius(theory: xr.Dataset, run: xr.Dataset) -> xr.Dataset:
    """Return the density of a theory for rods of the radius of ``run``; their places in y stay."""
    chain = cb.chain_of(theory)
    temperature = chain.mass * float((theory.velocity_width**2).mean())
    places = chain.reduced_anchors + theory.mean_displacement.values
    shapes = elastic_rods(at_temperature(chain, temperature))
    spacing = run.x.values[1] - run.x.values[0]
    fine = spacing * np.arange(-run.x.size, run.x.size + 1.0)  # twice as far as the simulation
    rods = shapes.moved(places, theory.displacement_width.values)
    density, label = over_positions(cb.chain_of(run), fine, rods)
    return xr.Dataset({"density": ("x", density), "label": ("x", label)}, {"x": fine}, run.attrs)


def pooled(runs: list[xr.Dataset], name: str, sign: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a profile over the rods and its standard error: the mean of runs and of mirrored rods.

    ``sign`` is that of the mirrored profile.
    """
    exact = f"{name}_error" not in runs[0]
    values = np.mean([run[name].values for run in runs], axis=0)
    errors = [0 * values if exact else run[f"{name}_error"].values for run in runs]
    error = np.sqrt(np.sum(np.square(errors), axis=0)) / len(runs)
    return (values + sign * values[::-1]) / 2, np.hypot(error, error[::-1]) / 2


def largest(off: np.ndarray, error: np.ndarray) -> tuple[float, float]:
    worst = int(np.argmax(np.abs(off)))
    return abs(float(off[worst])), float(error[worst])


def density_errors(theory: xr.Dataset, run: xr.Dataset) -> tuple[float, float]:
    """Return the largest difference of the smoothed densities as a part of close packing."""
    theirs, ours = (cb.smooth(each) for each in (theory, run))
    unit = cb.chain_of(theory).close_packed_density
    spacing = float(ours.x[1] - ours.x[0])
    theirs, ours = (
        each.assign_coords(x=np.rint(each.x / spacing).astype(int)) for each in (theirs, ours)
    )
    a, b = xr.align(theirs.density, ours.density, join="outer", fill_value=0.0)
    off, density = (a - b).values / unit, b.values / unit
    # Both halves of the chain are samples of the same density.
    uneven = ((density - density[::-1]) / 2)[density > 1e-3]
    error = np.full(off.size, math.sqrt(float(np.mean(uneven**2))))
    return largest((off + off[::-1]) / 2, error)


def rows(
    place: Place, theory: str, found: xr.Dataset, runs: list[xr.Dataset], lengths: Sequence[float]
) -> list[Row]:
    """Return the errors of a theory, one row a quantity."""
    chain, errors = cb.chain_of(found), {}
    border = np.minimum(np.arange(chain.size), np.arange(chain.size)[::-1])
    for name, sign in (("velocity_width", 1), ("displacement_width", 1), ("mean_displacement", -1)):
        if name not in found:
            continue
        value, error = pooled(runs, name, sign)
        unit = chain.thermal_length if sign < 0 else value
        off, error = (found[name].values - value) / unit, error / unit
        if name != "velocity_width":
            errors[name] = largest(off, error)
            continue
        errors[name] = largest(off[border >= 2], error[border >= 2])
        errors["border"] = largest(off[border == 0], error[border == 0])
    common = (theory, *place)
    table: list[Row] = [(*common, "", name, *pair) for name, pair in errors.items()]
    for length, run in zip(lengths, runs, strict=True):
        table.append((*common, length, "density", *density_errors(of_radius(found, run), run)))
    return table


def measured(place: Place, lengths: Sequence[float]) -> list[Row]:
    """Return the errors of all theories that take the chain at this place."""
    own = measured_displacements(place)
    runs = [
        simulated(chain_at(place, length), accuracy_of(place[0]), seed, "density")
        for seed, length in enumerate(lengths)
    ]
    table = []
    for theory in ("phase_space", "correlated_phase_space"):
        chain = chain_at(place, lengths[0])
        if not cb.theories(chain).takes.sel(theory=theory):
            continue
        for tolerance in (2e-3, 1e-2):  # the finest mesh misses the usual one for some long chains
            try:
                found = getattr(cb, theory)(chain, tolerance=tolerance)
            except ValueError as error:
                print(f"{theory} {place}: {error}", file=sys.stderr)
            else:
                table += rows(place, theory, found, runs, lengths)
                break
    # The theory is the first of a row, the quantity the seventh.
    return [row for row in table if not own or (row[0], row[6]) != OF_DISPLACEMENTS] + own


def measured_displacements(place: Place) -> list[Row]:
    """Return the error of W_x in the theory with pair correlations, if it takes the chain."""
    (theory, name), chain = OF_DISPLACEMENTS, chain_at(place, LENGTHS[0])
    if place[-1] or not cb.theories(chain).takes.sel(theory=theory):
        return []
    found = cb.correlated_phase_space(chain)
    one = accuracy_of(chain.size)
    run = simulated_widths(chain, one / math.sqrt(3), WIDTHS.get(chain.size, 2 * one))
    value, error = pooled([run], name, 1)
    return [(theory, *place, "", name, *largest(found[name].values / value - 1, error / value))]


def stated(theory: str, place: Place, length: float, quantity: str) -> float:
    """Return the error that the theory states for a chain that was drawn at random."""
    return float(getattr(accuracy.expected(theory, chain_at(place, length)), quantity))


def rows_of(folder: Path, lengths: Sequence[float], place: Place) -> list[Row]:
    """Return all rows of a place, computed now or before."""
    file = folder / f"{'_'.join(f'{each:g}' for each in place)}.json"
    if not file.exists():
        write_atomically(file, json.dumps(measured(place, lengths)).encode())
    found: list[Row] = json.loads(file.read_text())
    return found


def table(folder: Path, drawn: bool) -> Table:
    lengths = OTHER_LENGTHS if drawn else LENGTHS
    with process_pool() as workers:
        chains = list(held_out() if drawn else places())
        found = list(itertools.chain(*workers.map(partial(rows_of, folder, lengths), chains)))
    heads = "theory", "quantity", "g L/s", "L", "e", "Gamma", "s/R", "error", "standard error"
    yield *heads, *(["stated", "beyond it, standard errors"] if drawn else [])
    for theory, size, e, damping, lattice, length, quantity, error, own in found:
        coordinates = (f"{each:.4g}" for each in (lattice, size, e, damping))
        row = [theory, quantity, *coordinates, length, f"{error:.4f}", f"{own:.4f}"]
        if drawn:
            place = size, e, damping, lattice
            limit = stated(theory, place, length or lengths[0], quantity)
            row += [f"{limit:.4f}", f"{max(error - limit, 0) / own if own else 0:.1f}"]
        yield row


if __name__ == "__main__":
    asked = options(__doc__, folder=Path, chains="all")
    print_table(table(asked.folder, asked.chains == "drawn"))
