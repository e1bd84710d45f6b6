"""How far the gas in time is from simulations: the error of the kinetic energy.

    python -m studies.relaxation_error FOLDER [--held-out]

Prints kinetic/measured/relaxation.csv, from which ``hydrodynamics`` reads the error that it states,
or docs/tables/relaxation_held_out.csv: chains whose errors were looked at once, after the equations
and the rule were final. Ensembles of chains with a restitution other than 1 are simulated from
exact equilibrium states of the elastic chain, with y stretched or moved. Simulations are kept in
FOLDER. Takes about seven minutes on one core, and three with ``--held-out``.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from crazybilliards.kinetic import compressed, displaced, equilibrium_states, hydrodynamics
from crazybilliards.model import load, save
from crazybilliards.particles import simulate
from studies.common import Table, damped, options, print_table

DURATION, EVERY = 40.0, 0.5  # [t_0]
ROD_COUNT, FEWEST = 160_000, 300  # in all replicas of an ensemble, and replicas
RANGES = ((-1, 0), (0, 1), (1, 4), (4, 10))  # of L (1 - e)

Place = tuple[int, float, float, float, float]  # L, e, Gamma, factor of y, shift [s]
MEASURED: tuple[Place, ...] = (
    *((60, 0.9, 0.4886, 1.0, 0.0), (100, 0.95, 0.4886, 0.85, 0.0), (100, 0.9, 0.4886, 1.2, 0.0)),
    *((30, 0.95, 0.4886, 1.3, 0.0), (20, 0.9, 0.3, 1.3, 0.0), (20, 0.95, 0.5, 1.0, 1.5)),
    *((20, 0.98, 1.0, 0.8, 0.0), (20, 1.02, 1.0, 1.3, 0.0), (20, 0.9, 1.5, 1.0, 1.0)),
    *((50, 0.9, 0.5, 1.0, 0.0), (50, 0.95, 0.3, 0.8, 0.0), (50, 0.98, 0.5, 1.3, 0.0)),
    *((50, 1.01, 1.0, 1.0, 1.5), (50, 0.93, 1.0, 1.2, 0.0), (100, 0.95, 0.5, 1.0, 2.0)),
    *((100, 0.98, 0.3, 1.2, 0.0), (100, 0.99, 0.5, 1.0, 2.0), (100, 1.01, 1.5, 1.3, 0.0)),
    *((100, 0.95, 1.5, 1.3, 0.0), (100, 0.97, 0.3, 1.0, 0.0), (100, 0.9, 1.0, 0.8, 0.0)),
    *((40, 1.02, 0.5, 1.0, 0.0), (100, 1.01, 0.75, 1.2, 0.0)),
)
HELD_OUT: tuple[Place, ...] = (
    *((25, 0.93, 0.4, 1.25, 0.0), (40, 0.97, 0.3, 1.0, 1.2), (70, 0.96, 0.8, 0.9, 0.0)),
    *((90, 0.98, 0.4, 0.8, 0.0), (90, 0.92, 1.2, 1.0, 1.8), (35, 1.02, 1.2, 1.3, 0.0)),
    *((60, 1.01, 0.9, 0.8, 0.0), (30, 0.9, 0.6, 1.1, 0.0)),
)


def simulated(place: Place, folder: Path) -> xr.Dataset:
    """Return the ensemble, simulated now or before."""
    path = folder / ("_".join(f"{value:g}" for value in place) + ".nc")
    if path.exists():
        kept = load(path)
        assert isinstance(kept, xr.Dataset)
        return kept
    size, _, _, factor, shift = place
    chain, elastic = damped(*place[:3]), damped(size, 1.0, place[2])
    replicas = max(FEWEST, ROD_COUNT // size)
    states = equilibrium_states(elastic, replicas, seed=101)
    y = factor * elastic.reduced(states.position.values) + shift * elastic.thermal_length
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
    run, chain = simulated(place, folder), damped(*place[:3])
    *_, factor, shift = place
    start = displaced(chain, shift * chain.thermal_length) if shift else compressed(chain, factor)
    how: dict[str, Any] = {"every": EVERY, "progress": False}
    flow = hydrodynamics(chain, start, DURATION, velocity_variance="evolving", **how)
    error = flow.kinetic_energy.values / run.kinetic_energy.values - 1
    worst = int(np.argmax(np.abs(error)))
    noise = float(run.kinetic_energy_error[worst] / run.kinetic_energy[worst])
    stated = flow.attrs["kinetic_energy_model_error"]
    return float(error[worst]), noise, float(run.time[worst]), stated


def ranges(folder: Path) -> Table:
    """Give the largest error of each range of L (1 - e), with its standard error."""
    yield "theory", "quantity", "least L(1-e)", "most L(1-e)", "error", "standard error"
    found = {place: errors(place, folder)[:2] for place in MEASURED}
    for place, (error, noise) in found.items():
        print(place, f"{100 * error:+.1f} ± {100 * noise:.1f} %", file=sys.stderr)
    for least, most in RANGES:
        within = [
            (abs(error), noise)
            for (size, e, *_), (error, noise) in found.items()
            if least < round(size * (1 - e), 9) <= most or (most == 0 and e > 1)
        ]
        error, noise = max(within, key=lambda pair: pair[0] + 2 * pair[1])
        yield "hydrodynamics", "kinetic_energy", least, most, f"{error:.4f}", f"{noise:.4f}"


def held_out(folder: Path) -> Table:
    yield "L", "e", "Gamma", "y times", "shift, s", "largest error, %", "at t [t_0]", "stated, %"
    for place in HELD_OUT:
        error, noise, time, stated = errors(place, folder)
        yield *place, f"{100 * error:+.1f} ± {100 * noise:.1f}", time, f"{100 * stated:.1f}"


if __name__ == "__main__":
    asked = options(__doc__, folder=Path, held_out=False)
    print_table(held_out(asked.folder) if asked.held_out else ranges(asked.folder))
