"""How far ``steady_state`` is from simulations of chains of all kinds.

    python -m studies.stationary_errors FOLDER [--held-out]

Prints kinetic/measured/steady_state.csv, from which the theory reads the errors that it states, or
docs/tables/stationary_held_out.csv: chains drawn at random before any chain was compared with the
theory. Every error is the largest of all rods plus two of its standard errors. Simulations have a
time step of little error; they are kept in FOLDER, so that another theory needs no other ones. On
two cores the first table takes about half an hour, and the second one five minutes.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr

import crazybilliards as cb
from crazybilliards.comparison.sweeps import process_pool
from crazybilliards.kinetic import accuracy
from crazybilliards.kinetic.accuracy import kind_and_place
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.particles.scales import centre_width, correlation_time, default_time_step
from crazybilliards.particles.timing import time_step_error
from studies.common import Table, damped, options, print_table

# Relative accuracy of W_v in the centre, by size.
ACCURACY = {10: 0.005, 30: 0.005, 100: 0.008, 300: 0.014, 1000: 0.03}
LENGTHS = 0.4, 0.7, 2.1, 7.0  # s/R, one after the other
NORMAL, WEAK, STRONG = 0.49, 0.15, 1.5  # Gamma = gamma s/(m W)
QUANTITIES = accuracy.Accuracy._fields


def on_springs(
    size: int,
    e: float,
    damping: float,
    length: float,
    *,
    gap: float = 0.0,
    room: float = 0.0,
    spring: Literal["linear", "quadratic"] = "linear",
) -> cb.Chain:
    """Return a chain with Gamma, s/R, and in units of s the gap and the room of a box."""
    chain = damped(cb.Chain(size=size, restitution=e, spring=spring), damping)
    s = chain.thermal_length
    chain = chain.replace(radius=s / length, gap=gap * s)
    return chain.replace(box=2 * chain.radius * size + room * s) if room else chain


def gas(size: int, e: float, damping: float, walls: float = 1.0) -> cb.Chain:
    """Return a gas in a box without springs; the room of a rod is R, and Gamma is in it."""
    chain = cb.Chain(size=size, stiffness=0, box=3.0 * size, restitution=e, wall_restitution=walls)
    width = chain.damping / (chain.mass * damping)
    return chain.replace(amplitude=width * math.sqrt(2 * chain.mass * chain.damping))


def driven(size: int, share: float, damping: float, length: float) -> cb.Chain:
    """Return a chain with e > 1 and this share of its critical size."""
    return on_springs(size, 1 + share * math.pi * damping / size, damping, length)


def measured() -> Iterator[cb.Chain]:
    """Give the chains of the table, all kinds mixed."""
    s = itertools.cycle(LENGTHS)
    product, dampings = itertools.product, (WEAK, NORMAL, STRONG)
    for L, e, G in product((2, 4, 10, 30, 100, 300), (0.1, 0.5, 0.75, 0.9, 0.98), dampings):
        yield on_springs(L, e, G, next(s))
    for e in (0.1, 0.5, 0.75, 0.9, 0.98):
        yield on_springs(1000, e, NORMAL, next(s))
    for L, G, share in product((10, 30, 100), (0.49, 1.0, 1.95), (0.3, 0.6, 0.8)):
        yield driven(L, share, G, next(s))
    for L, e, gap in product((20, 100, 300), (0.3, 0.5, 0.9), (0.15, 0.7, 4.0)):
        yield on_springs(L, e, NORMAL, next(s), gap=gap)
    for L, e, G, gap in product((20, 100), (0.3, 0.6, 0.9), (WEAK, STRONG), (0.15, 1.0)):
        yield on_springs(L, e, G, next(s), gap=gap)
    for L, e, room in product((10, 30, 100), (0.5, 0.75, 0.9), (0.5, 2.0, 3.5)):
        yield on_springs(L, e, NORMAL, next(s), room=room)
    for e, G, room in product((0.5, 0.75, 0.9), (WEAK, STRONG), (0.5, 3.5)):
        yield on_springs(30, e, G, next(s), room=room)
    for L, e, G in product((10, 30, 100), (0.3, 0.5, 0.7, 0.9), (0.03, 0.1, 0.5)):
        yield gas(L, e, G)
    for e, walls, L, G in product((0.5, 0.85, 1.0), (0.3, 0.6, 0.9), (10, 40), (0.05, 0.3)):
        yield gas(L, e, G, walls)
    for L, e in product((10, 30, 100, 300), (0.3, 0.5, 0.75, 0.9)):
        yield on_springs(L, e, NORMAL, next(s), spring="quadratic")
    for L, e, G in product((4, 10, 30), (0.3, 0.6, 0.9), (WEAK, STRONG)):
        yield on_springs(L, e, G, next(s), spring="quadratic")
    for L, e in product((100, 300), (0.3, 0.6, 0.9)):
        yield on_springs(L, e, WEAK, next(s), spring="quadratic")
    for L, G in product((2, 4, 10, 30, 100, 300), dampings):  # the paper's main case
        yield on_springs(L, 0.0, G, next(s))
    yield on_springs(1000, 0.0, NORMAL, next(s))
    for L, G, gap in product((20, 100), dampings, (0.15, 1.0, 4.0)):
        yield on_springs(L, 0.0, G, next(s), gap=gap)
    for L in (10, 30, 100, 300):
        yield on_springs(L, 0.0, NORMAL, next(s), spring="quadratic")
    yield from between_the_others()


def between_the_others() -> Iterator[cb.Chain]:
    """Give chains with other sizes, gaps, rooms and dampings: at the ends, and between."""
    s, product = itertools.cycle(LENGTHS), itertools.product
    for L, e in product((30, 100), (0.1, 0.5, 0.9)):
        yield on_springs(L, e, NORMAL, LENGTHS[0])
    for e, gap, room in zip((0.3, 0.5, 0.9) * 2, (0.05, 0.7) * 3, (0.5, 3.5) * 3, strict=True):
        yield on_springs(4, e, NORMAL, next(s), gap=gap)
        yield on_springs(4, e, NORMAL, next(s), room=room)
    for L, e in product((20, 100), (0.3, 0.5, 0.9)):
        yield on_springs(L, e, NORMAL, next(s), gap=0.05)
    for e, G, gap in product((0.3, 0.6, 0.9), (WEAK, STRONG), (0.4, 2.0)):
        yield on_springs(50, e, G, next(s), gap=gap)
    for e, room in product((0.5, 0.9), (0.72, 3.6)):
        yield on_springs(40, e, NORMAL, next(s), room=room)
    for e, G in product((0.6, 0.9), (WEAK, STRONG)):
        yield on_springs(50, e, G, next(s), room=1.5)
    for e, G in product((0.3, 0.5, 0.9), (0.03, 0.5)):
        yield gas(4, e, G)
    for L, e in product((4, 10, 30, 100), (0.3, 0.6, 0.9)):
        yield gas(L, e, 1.5)
    for L, G in product((10, 100), (0.03, 0.5)):
        yield gas(L, 0.98, G)
    for L, (e, walls) in product((10, 40), ((0.7, 0.5), (0.9, 0.9), (1.0, 0.5), (1.0, 0.9))):
        yield gas(L, e, 0.1, walls)
    for G in (WEAK, STRONG):
        yield on_springs(30, 0.5, G, next(s), spring="quadratic")


def held_out() -> Iterator[cb.Chain]:
    """Draw chains of all kinds in the ranges of the table."""
    draw = np.random.default_rng(76)

    def between(low: float, high: float) -> float:
        return float(np.exp(draw.uniform(np.log(low), np.log(high))))

    def size(most: int) -> int:
        return round(between(10, most))

    for _ in range(12):
        e = round(draw.uniform(0.1, 0.98), 3)
        yield on_springs(size(300), e, between(0.15, 1.5), between(0.4, 2))
    for _ in range(5):
        yield driven(size(100), draw.uniform(0.2, 0.8), between(0.5, 1.9), between(0.4, 2))
    for _ in range(10):
        L, e, G = round(between(20, 300)), round(draw.uniform(0.3, 0.9), 3), between(0.2, 1.5)
        yield on_springs(L, e, G, between(0.4, 2), gap=between(0.15, 4))
    for _ in range(8):
        L, e, G = size(100), round(draw.uniform(0.5, 0.9), 3), between(0.2, 1.5)
        yield on_springs(L, e, G, between(0.4, 2), room=draw.uniform(0.5, 3.5))
    for _ in range(8):
        yield gas(size(100), round(draw.uniform(0.3, 0.9), 3), between(0.03, 0.5))
    for _ in range(6):
        L, e, G = size(300), round(draw.uniform(0.3, 0.9), 3), between(0.2, 1.5)
        yield on_springs(L, e, G, between(0.4, 2), spring="quadratic")
    for _ in range(6):
        yield on_springs(size(300), 0.0, between(0.15, 1.5), between(0.4, 2))
    for _ in range(3):
        yield on_springs(size(100), 0.0, between(0.2, 1.5), between(0.4, 2), gap=between(0.15, 4))


def simulated(folder: Path, chain: cb.Chain) -> xr.Dataset:
    """Return a simulation of a chain, made now or before.

    The stated error of the step is at most a quarter of the accuracy. The run is repeated, each
    time longer, until the standard error of W_v in the centre is as small as the accuracy.
    """
    file = folder / f"{hashlib.sha1(repr(chain).encode()).hexdigest()[:12]}.nc"
    if file.exists():
        kept = cb.load(file)
        assert isinstance(kept, xr.Dataset)
        return kept
    wanted = ACCURACY[min(size for size in ACCURACY if size >= chain.size)]
    step, width = default_time_step(chain), centre_width(chain) * chain.free_velocity_width
    while time_step_error(chain, step, width) > wanted / 4:
        step *= 0.97
    if chain.wall_restitution < 1:  # rods at a wall that absorbs need shorter steps
        step /= 5
    observe = ("widths", "density", "walls") if chain.box else ("widths", "density")
    duration = 150 * correlation_time(chain)
    while True:
        run = cb.simulate(
            chain, duration=duration, time_step=step, observe=observe, threads=1, progress=False
        )
        middle = run.isel(particle=middle_tenth(chain.size))
        error = float((middle.velocity_width_error / middle.velocity_width).mean())
        if error < wanted:
            cb.save(run, file)
            return run
        duration *= max(1.3, 1.05 * (error / wanted) ** 2)


def mirrored(run: xr.Dataset, name: str, sign: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean over a rod and its mirror image, of this sign, and the standard error."""
    values, error = run[name].values, run[f"{name}_error"].values
    return (values + sign * values[::-1]) / 2, np.hypot(error, error[::-1]) / 2


def largest(off: np.ndarray, error: np.ndarray) -> tuple[float, float]:
    worst = int(np.argmax(np.abs(off)))
    return abs(float(off[worst])), float(error[worst])


def density_error(theory: xr.Dataset, run: xr.Dataset) -> tuple[float, float]:
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


def errors(run: xr.Dataset) -> dict[str, tuple[float, float]]:
    """Return the largest error of each quantity of the theory, and its standard error."""
    chain = cb.chain_of(run)
    theory, found = cb.steady_state(chain), {}
    unit = chain.thermal_length if chain.stiffness else 2 * chain.walls[1] / chain.size
    border = np.minimum(np.arange(chain.size), np.arange(chain.size)[::-1])
    for name, sign in (("velocity_width", 1), ("displacement_width", 1), ("mean_displacement", -1)):
        if name not in theory:
            continue
        value, error = mirrored(run, name, sign)
        scale = unit if sign < 0 else value
        off, error = (theory[name].values - value) / scale, error / scale
        if name == "velocity_width":
            found["border"] = largest(off[border == 0], error[border == 0])
            off, error = off[border >= 2], error[border >= 2]
        if off.size:
            found[name] = largest(off, error)
    found["density"] = density_error(theory, run)
    if chain.box:
        force = float(run.wall_force.mean())
        beyond_one = float(theory.wall_force.mean()) / force - 1
        own = float(run.wall_force_error.mean()) / force / math.sqrt(2)
        found["wall_force"] = abs(beyond_one), own
    return found


def row(folder: Path, chain: cb.Chain) -> list[object]:
    """Return a line of the table; without errors if the theory has no state there."""
    kind, place = kind_and_place(chain)
    try:
        found = errors(simulated(folder, chain))
    except ValueError as problem:
        print(f"{chain}: {problem}", file=sys.stderr)
        return []
    stated = (
        f"{off + 2 * own:.4f}" for off, own in (found.get(q, (math.nan, 0)) for q in QUANTITIES)
    )
    return [kind, *(f"{value:.4g}" for value in place.values()), *stated]


def beyond(folder: Path, chain: cb.Chain) -> list[object]:
    """Return a chain that was drawn at random, and each error beside the stated one."""
    kind, place = kind_and_place(chain)
    stated = accuracy.errors_of_steady_state(chain)._asdict()
    found = errors(simulated(folder, chain))
    cells = (
        f"{found[q][0]:.4f} ± {found[q][1]:.4f} of {stated[q]:.4f}" if q in found else ""
        for q in QUANTITIES
    )
    over = max(max(off - stated[q], 0) / own if own else 0.0 for q, (off, own) in found.items())
    return [kind, *(f"{value:.4g}" for value in place.values()), *cells, f"{over:.1f}"]


def table(folder: Path, drawn: bool) -> Table:
    last = ["beyond, standard errors"] if drawn else []
    yield "kind", "L", "e", "Gamma", "x", *QUANTITIES, *last
    with process_pool() as workers:
        chains = list(held_out() if drawn else measured())
        lines = workers.map(partial(beyond if drawn else row, folder), chains)
        yield from filter(None, lines)


if __name__ == "__main__":
    asked = options(__doc__, folder=Path, held_out=False)
    print_table(table(asked.folder, asked.held_out))
