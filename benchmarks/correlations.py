"""The kinetic equation with pair correlations and without against simulations.

    python benchmarks/correlations.py FOLDER

Prints the table of docs/correlations.md. Simulations, at a quarter of the default time step and
kept in FOLDER, take about half an hour on one core, the theory ten minutes.
"""

import sys
import time
from pathlib import Path

import numpy as np
import xarray as xr

from crazybilliards.comparison.studies.restitutions import width_deviation
from crazybilliards.kinetic import correlated_phase_space, phase_space
from crazybilliards.model import Chain, load, save
from crazybilliards.particles import simulate
from crazybilliards.particles.scales import default_time_step

RESTITUTIONS = (0.95, 0.9, 0.75, 0.5, 0.0)
DURATIONS = {10: 40_000.0, 30: 40_000.0, 100: 20_000.0, 300: 8_000.0}
CHAINS = [Chain(size=size, restitution=e) for size in DURATIONS for e in RESTITUTIONS] + [
    Chain(size=100, restitution=0.75, damping=damping) for damping in (0.5, 3.0)
]
FINER = 4  # than the default time step
EVERY = 0.5


def simulated(chain: Chain, folder: Path) -> xr.Dataset:
    """Return a simulation with snapshots, done now or before."""
    path = folder / f"L{chain.size}_e{chain.restitution:g}_gamma{chain.damping:g}.nc"
    if not path.exists():
        run = simulate(
            chain,
            duration=DURATIONS[chain.size],
            time_step=default_time_step(chain) / FINER,
            every=EVERY,
            seed=7,
            observe=("widths", "snapshots"),
            threads=1,
            progress=False,
        )
        save(reduced(run), path)
    return load(path)


def reduced(run: xr.Dataset) -> xr.Dataset:
    """Return the widths and, in place of the snapshots, the relative temperature they give."""
    v = run.velocity.values.reshape(-1, run.sizes["particle"])
    mean_square = (v**2).mean(axis=0)
    mean_square = (mean_square[1:] + mean_square[:-1]) / 2
    relative = 1 - (v[:, 1:] * v[:, :-1]).mean(axis=0) / mean_square
    kept = run.drop_vars(["position", "velocity"]).drop_dims("time", errors="ignore")
    return kept.assign(relative=("between", relative))


def even(values: np.ndarray) -> np.ndarray:
    return (values + values[::-1]) / 2


def row(chain: Chain, run: xr.Dataset) -> str:
    """Return a line of the table."""
    begin = time.perf_counter()
    theory = correlated_phase_space(chain)
    seconds = time.perf_counter() - begin
    before, after = (width_deviation(run, each) for each in (phase_space(chain), theory))
    shared, relative = theory.neighbour_covariance.values, theory.relative_temperature.values
    width = theory.displacement_width.values / even(run.displacement_width.values) - 1
    middle, measured = chain.size // 2 - 1, even(run.relative.values)
    found = relative / (relative + shared)
    return (
        f"| {chain.size} | {chain.restitution:g} | {chain.damping:g} "
        f"| {100 * before.centre:+.1f} -> {100 * after.centre:+.1f} "
        f"| {100 * before.border:+.1f} -> {100 * after.border:+.1f} "
        f"| {100 * before.largest:.1f} -> {100 * after.largest:.1f} "
        f"| {100 * after.error:.1f}, {100 * after.border_error:.1f} "
        f"| {found[middle]:.3f}, {measured[middle]:.3f} | {found[0]:.3f}, {measured[0]:.3f} "
        f"| {100 * width[chain.size // 10]:+.1f}, {100 * width[chain.size // 2]:+.1f} "
        f"| {seconds:.0f} |"
    )


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    print(
        "| L | e | gamma | W_v, centre, % | W_v, border, % | W_v, largest, % | error of a rod, "
        "of the border, % | Theta/T, centre | Theta/T, border | W_x, tenth and centre, % | s |"
    )
    print("|" + 11 * "---|")
    for chain in CHAINS:
        print(row(chain, simulated(chain, folder)), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
