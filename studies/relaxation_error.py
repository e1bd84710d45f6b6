"""How far the gas in time is from simulations: the error of the kinetic energy.

    python -m studies.relaxation_error FOLDER [--held-out]

Prints kinetic/measured/relaxation.csv, from which ``hydrodynamics`` reads the error that it states,
or docs/tables/relaxation_held_out.csv: chains whose errors were looked at once, after the equations
and the rule were final. Ensembles of chains with a restitution other than 1 are simulated from
exact equilibrium states of the elastic chain, with y stretched or moved. Simulations are kept in
FOLDER. Takes about a quarter of an hour on one core, and a third of it with ``--held-out``.
"""

import sys
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from crazybilliards.kinetic import compressed, displaced, equilibrium_states, hydrodynamics
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate
from studies.common import Table, damped, options, print_table

Interval = tuple[float, float]

DURATION, EVERY = 40.0, 0.5  # [t_0]
ROD_COUNT, FEWEST = 160_000, 300  # in all replicas of an ensemble, and replicas


class Place(NamedTuple):
    """A chain and its start."""

    L: int
    e: float
    Gamma: float  # gamma s/(m W)
    factor: float = 1.0  # of y
    shift: float = 0.0  # [s]
    gap: float = 0.0  # [s]
    spring: Literal["linear", "quadratic"] = "linear"

    def chain(self) -> Chain:
        chain = damped(Chain(size=self.L, restitution=self.e, spring=self.spring), self.Gamma)
        return chain.replace(gap=self.gap * chain.thermal_length)


MEASURED = (
    *(Place(60, 0.9, 0.4886), Place(100, 0.95, 0.4886, 0.85), Place(100, 0.9, 0.4886, 1.2)),
    *(Place(30, 0.95, 0.4886, 1.3), Place(20, 0.9, 0.3, 1.3), Place(20, 0.95, 0.5, shift=1.5)),
    *(Place(20, 0.98, 1.0, 0.8), Place(20, 1.02, 1.0, 1.3), Place(20, 0.9, 1.5, shift=1.0)),
    *(Place(50, 0.9, 0.5), Place(50, 0.95, 0.3, 0.8), Place(50, 0.98, 0.5, 1.3)),
    *(Place(50, 1.01, 1.0, shift=1.5), Place(50, 0.93, 1.0, 1.2)),
    *(Place(100, 0.95, 0.5, shift=2.0), Place(100, 0.98, 0.3, 1.2)),
    *(Place(100, 0.99, 0.5, shift=2.0), Place(100, 1.01, 1.5, 1.3), Place(100, 0.95, 1.5, 1.3)),
    *(Place(100, 0.97, 0.3), Place(100, 0.9, 1.0, 0.8), Place(40, 1.02, 0.5)),
    Place(100, 1.01, 0.75, 1.2),
    # With a gap
    *(Place(20, 1.0, 0.3, 1.3, gap=0.3), Place(100, 1.0, 0.5, 0.8, gap=0.1)),
    *(Place(50, 1.0, 1.0, 1.2, gap=1.0), Place(100, 1.0, 0.3, shift=2.0, gap=0.5)),
    *(Place(50, 0.95, 0.5, 1.2, gap=0.5), Place(20, 0.9, 0.3, 0.8, gap=1.0)),
    *(Place(100, 0.98, 0.3, 1.2, gap=0.2), Place(100, 0.98, 1.0, shift=1.5, gap=0.05)),
    *(Place(50, 0.8, 0.5, 1.2, gap=1.0), Place(100, 0.9, 0.3, 1.2, gap=0.2)),
    *(Place(30, 0.8, 1.0, shift=1.5, gap=0.5), Place(100, 0.95, 0.5, 0.8, gap=0.05)),
    *(Place(50, 1.02, 1.0, 1.2, gap=0.2), Place(20, 1.03, 1.0, shift=1.0, gap=0.5)),
    # On quadratic springs
    *(Place(20, 1.0, 0.3, 1.3, spring="quadratic"), Place(100, 1.0, 0.5, 0.8, spring="quadratic")),
    *(Place(50, 1.0, 0.5, shift=1.5, spring="quadratic"),),
    *(Place(50, 0.95, 0.5, 1.2, spring="quadratic"), Place(20, 0.9, 0.3, 0.8, spring="quadratic")),
    *(Place(100, 0.98, 0.5, shift=1.5, spring="quadratic"),),
    *(Place(100, 0.9, 0.5, 1.2, spring="quadratic"), Place(60, 0.9, 1.0, 0.8, spring="quadratic")),
)
HELD_OUT = (
    *(Place(25, 0.93, 0.4, 1.25), Place(40, 0.97, 0.3, shift=1.2), Place(70, 0.96, 0.8, 0.9)),
    *(Place(90, 0.98, 0.4, 0.8), Place(90, 0.92, 1.2, shift=1.8), Place(35, 1.02, 1.2, 1.3)),
    *(Place(60, 1.01, 0.9, 0.8), Place(30, 0.9, 0.6, 1.1)),
    *(Place(70, 0.97, 0.4, 1.1, gap=0.4), Place(40, 0.85, 0.5, 1.25, gap=0.15)),
    *(Place(25, 1.0, 0.4, shift=1.2, gap=0.7), Place(90, 1.0, 0.8, 0.85, gap=0.25)),
    *(Place(40, 0.94, 0.4, 1.25, spring="quadratic"), Place(80, 0.93, 0.6, spring="quadratic")),
)
RANGES = (  # spring, g/s, L (1 - e)
    *(("linear", (0, 0), each) for each in ((-1, 0), (0, 1), (1, 4), (4, 10))),
    *(("linear", (0, 1), each) for each in ((0, 0), (-1, 0))),
    *(("linear", gap, each) for gap in ((0, 0.2), (0.2, 1)) for each in ((0, 2.5), (2.5, 10))),
    *(("quadratic", (0, 0), each) for each in ((0, 0), (0, 4), (4, 10))),
)


def simulated(place: Place, folder: Path) -> xr.Dataset:
    """Return the ensemble, simulated now or before."""
    path = folder / ("_".join(str(value) for value in place) + ".nc")
    if path.exists():
        kept = load(path)
        assert isinstance(kept, xr.Dataset)
        return kept
    chain = place.chain()
    elastic = chain.replace(restitution=1.0)
    replicas = max(FEWEST, ROD_COUNT // place.L)
    states = equilibrium_states(elastic, replicas, seed=101)
    y = place.factor * elastic.reduced(states.position.values)
    y = y + place.shift * elastic.thermal_length
    run = simulate(
        chain,
        start=states.assign(position=(states.position.dims, elastic.physical(y))),
        replicas=replicas,
        average="ensemble",
        duration=DURATION,
        every=EVERY,
        observe=("energy", "widths"),
        seed=202,
        threads=1,
        progress=False,
    )
    if run.attrs["status"] != "completed":  # its errors would be larger, and nobody would see it
        raise SystemExit(f"{run.attrs['status']}: the unfinished result is not kept; start again")
    save(run, path)
    return run


def errors(place: Place, folder: Path) -> tuple[float, float, float, float]:
    """Return the largest error, its standard error, its time, and the stated error."""
    run, chain = simulated(place, folder), place.chain()
    start = compressed(chain, place.factor)
    if place.shift:
        start = displaced(chain, place.shift * chain.thermal_length)
    how: dict[str, Any] = {"every": EVERY, "progress": False}
    flow = hydrodynamics(chain, start, DURATION, velocity_variance="evolving", **how)
    error = flow.kinetic_energy.values / run.kinetic_energy.values - 1
    worst = int(np.argmax(np.abs(error)))
    noise = float(run.kinetic_energy_error[worst] / run.kinetic_energy[worst])
    stated = flow.attrs["kinetic_energy_model_error"]
    return float(error[worst]), noise, float(run.time[worst]), stated


def lies_in(place: Place, kind: str, gap: Interval, concentration: Interval) -> bool:
    """Return whether a range has this place; one from below 0 has all e > 1."""
    held = gap[0] < place.gap <= gap[1] if gap[1] else place.gap == 0
    if place.spring != kind or not held:
        return False
    least, most = concentration
    value = round(place.L * (1 - place.e), 9)
    return (
        value == 0 if least == most else value < 0 if least < 0 else max(least, 0) < value <= most
    )


def ranges(folder: Path) -> Table:
    """Give the largest error of each range of L (1 - e), with its standard error."""
    edges = "least g/s", "most g/s", "least L(1-e)", "most L(1-e)"
    yield "theory", "quantity", "n", *edges, "error", "standard error"
    found = {place: errors(place, folder)[:2] for place in MEASURED}
    for place, (error, noise) in found.items():
        print(*place, f"{100 * error:+.1f} ± {100 * noise:.1f} %", file=sys.stderr)
    for kind, gap, concentration in RANGES:
        within = [found[each] for each in MEASURED if lies_in(each, kind, gap, concentration)]
        error, noise = max(within, key=lambda pair: abs(pair[0]) + 2 * pair[1])
        n, measured = {"linear": 2, "quadratic": 3}[kind], (f"{abs(error):.4f}", f"{noise:.4f}")
        yield "hydrodynamics", "kinetic_energy", n, *gap, *concentration, *measured


def held_out(folder: Path) -> Table:
    heads = "L", "e", "Gamma", "y times", "shift, s", "g/s", "spring"
    yield *heads, "largest error, %", "at t [t_0]", "stated, %"
    for place in HELD_OUT:
        error, noise, time, stated = errors(place, folder)
        yield *place, f"{100 * error:+.1f} ± {100 * noise:.1f}", time, f"{100 * stated:.1f}"


if __name__ == "__main__":
    asked = options(__doc__, folder=Path, held_out=False)
    print_table(held_out(asked.folder) if asked.held_out else ranges(asked.folder))
