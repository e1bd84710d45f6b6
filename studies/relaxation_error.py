"""How far the kinetic equation in time is from simulations: the error of the kinetic energy.

    python -m studies.relaxation_error FOLDER [--held-out]

Prints kinetic/measured/relaxation.csv, from which the equation reads the error that it states, or
docs/tables/kinetic_equation_in_time_held_out.csv: chains whose errors were looked at once, after
the rule of ``kinetic_energy_model_error`` was final. An ensemble of chains is simulated from exact
equilibrium states of the elastic chain, released with a restitution other than 1: as they are, or
with y multiplied by 0.4. Simulations are kept in FOLDER. Takes about half an hour on one core, and
a quarter with ``--held-out``.
"""

import itertools
import sys
from pathlib import Path

import numpy as np
import xarray as xr

from crazybilliards.kinetic import compressed, equilibrium_states, relax_phase_space
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate
from studies.common import Table, damped, options, print_table

DURATION, EVERY = 40.0, 0.5  # three times m/gamma of the weakest damping, until it is stationary
FACTORS = (1.0, 0.4)  # of y, at the release
ROD_COUNT = 40_000  # in all replicas of an ensemble
MEASURED = (  # size, restitution, Gamma; 100 rods at e = 0.8 are too concentrated for the mesh
    *((size, e, G) for size in (10, 30) for e in (0.8, 0.9, 0.95) for G in (0.29, 0.49)),
    *((100, e, G) for e in (0.9, 0.95) for G in (0.29, 0.49)),
    *((size, 1.05, G) for size in (10, 30) for G in (1.95, 4.0)),
    *((size, 1.0, G) for size in (10, 30, 100) for G in (0.29, 0.49)),
    *((size, 1.0, G) for size in (10, 30) for G in (1.95, 4.0)),
)
HELD_OUT = ((20, 0.85, 0.4), (15, 0.92, 0.32), (50, 0.9, 0.45), (60, 0.93, 0.3), (20, 1.04, 2.5))


def simulated(chain: Chain, factor: float, folder: Path) -> xr.Dataset:
    """Return the ensemble, simulated now or before."""
    name = f"L{chain.size}_e{chain.restitution:g}_gamma{chain.damping:.4g}_by{factor:g}.nc"
    if (folder / name).exists():
        kept = load(folder / name)
        assert isinstance(kept, xr.Dataset)
        return kept
    elastic = chain.replace(restitution=1.0)
    states = equilibrium_states(elastic, ROD_COUNT // chain.size, seed=1)
    y = factor * elastic.reduced(states.position.values)
    run = simulate(
        chain,
        start=states.assign(position=(states.position.dims, elastic.physical(y))),
        replicas=ROD_COUNT // chain.size,
        average="ensemble",
        duration=DURATION,
        every=EVERY,
        observe=("energy", "widths"),
        seed=2,
        threads=1,
        progress=False,
    )
    if run.attrs["status"] != "completed":  # its errors would be larger, and nobody would see it
        raise SystemExit(f"{run.attrs['status']}: the unfinished result is not kept; start again")
    save(run, folder / name)
    return run


def errors(chain: Chain, factor: float, folder: Path) -> tuple[float, float, float, float]:
    """Return the largest error, its standard error, its time, and the stated error."""
    if chain.restitution == 1:  # exact
        return 0.0, 0.0, 0.0, 0.0
    run = simulated(chain, factor, folder)
    start = compressed(chain.replace(restitution=1.0), factor)
    flow = relax_phase_space(chain, start, DURATION, every=EVERY, progress=False)
    error = flow.kinetic_energy.values / run.kinetic_energy.values - 1
    worst = int(np.argmax(np.abs(error)))
    noise = float(run.kinetic_energy_error[worst] / run.kinetic_energy[worst])
    return (
        float(error[worst]),
        noise,
        float(run.time[worst]),
        flow.attrs["kinetic_energy_model_error"],
    )


def table(folder: Path, held_out: bool) -> Table:
    if held_out:
        yield "e", "L", "Gamma", "y times", "largest error, %", "at t [t_0]", "stated, %"
    else:
        yield "theory", "quantity", "L", "e", "Gamma", "y times", "error", "standard error"
    for place, factor in itertools.product(HELD_OUT if held_out else MEASURED, FACTORS):
        size, e, damping = place
        try:
            error, noise, time, stated = errors(damped(*place), factor, folder)
        except ValueError as problem:  # rods that cool are narrower than the mesh resolves
            print(f"{size} {e} {damping} {factor}: {problem}", file=sys.stderr)
            continue
        if held_out:
            found = f"{100 * error:+.1f} ± {100 * noise:.1f}", time, f"{100 * stated:.1f}"
            yield e, size, damping, factor, *found
        else:
            rounded = f"{abs(error):.4f}", f"{noise:.4f}"
            yield "relax_phase_space", "kinetic_energy", *place, factor, *rounded


if __name__ == "__main__":
    asked = options(__doc__, folder=Path, held_out=False)
    print_table(table(asked.folder, asked.held_out))
