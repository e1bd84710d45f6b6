"""How far the kinetic equation in time is from simulations: the error of the kinetic energy.

    python benchmarks/accuracy/relaxation_error.py FOLDER [--held-out]

Prints docs/tables/kinetic_equation_in_time.csv, or kinetic_equation_in_time_held_out.csv. An
ensemble of chains is simulated from exact equilibrium states of the elastic chain, released with a
restitution other than 1: as they are, or with y multiplied by 0.4. Simulations are kept in FOLDER.
Takes about half an hour on one core, and a quarter with ``--held-out``: chains whose errors were
looked at once, after the rule of ``model_error`` was final.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr

from crazybilliards.kinetic import compressed, equilibrium_states, relax_phase_space
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate

DURATION, EVERY = 15.0, 0.5
FACTORS = (1.0, 0.4)  # of y, at the release
ROD_COUNT = 40_000  # in all replicas of an ensemble
MEASURED = (  # size, restitution, damping; 100 rods at e = 0.8 are too concentrated for the mesh
    *((size, e, 1.0) for size in (10, 30) for e in (0.8, 0.9, 0.95)),
    (100, 0.9, 1.0),
    (100, 0.95, 1.0),
    (10, 1.05, 4.0),
    (30, 1.05, 4.0),
)
HELD_OUT = ((20, 0.85, 1.0), (20, 0.92, 1.0), (50, 0.9, 1.0), (60, 0.93, 0.6), (20, 1.04, 4.0))


def simulated(chain: Chain, factor: float, folder: Path) -> xr.Dataset:
    """Return the ensemble, simulated now or before."""
    name = f"L{chain.size}_e{chain.restitution:g}_gamma{chain.damping:g}_by{factor:g}.nc"
    if (folder / name).exists():
        return load(folder / name)
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


def row(chain: Chain, factor: float, folder: Path) -> str:
    """Return a line of the table: the error of the kinetic energy, in per cent."""
    run = simulated(chain, factor, folder)
    start = compressed(chain.replace(restitution=1.0), factor)
    flow = relax_phase_space(chain, start, DURATION, every=EVERY, progress=False)
    error = 100 * (flow.kinetic_energy.values / run.kinetic_energy.values - 1)
    noise = 100 * run.kinetic_energy_error.values / run.kinetic_energy.values
    worst = int(np.argmax(np.abs(error)))
    return (
        f"{chain.restitution:g},{chain.size},{chain.damping:g},{factor:g},"
        f"{error[worst]:+.1f} ± {noise[worst]:.1f},{run.time.values[worst]:g},"
        f"{error[-5:].mean():+.1f},{100 * flow.attrs['model_error']:.1f}"
    )


def main(folder: Path, *, held_out: bool) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    print('e,L,gamma,y times,"largest error, %",at t [T],"at the end, %","stated, %"')
    for size, e, damping in HELD_OUT if held_out else MEASURED:
        for factor in FACTORS:
            chain = Chain(size=size, restitution=e, damping=damping)
            print(row(chain, factor, folder), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), held_out="--held-out" in sys.argv)
