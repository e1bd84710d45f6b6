"""Long chains at e = 0: how the centre's velocities, force and correlation length grow with L.

    python benchmarks/asymptotics.py FOLDER

Prints the tables of docs/asymptotics.md: simulations at the default time step, and the correlated
theory as far as it can be solved. Results are kept in FOLDER, which ``neighbours.py`` shares. Takes
ten minutes on one core if it is empty.
"""

import sys
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np
import xarray as xr
from neighbours import length_of, measured, middle_of, solved

from crazybilliards.model import Chain

SIZES = (30, 100, 300, 1000, 3000)
Quantities = dict[str, float]


def quantities(result: xr.Dataset, chain: Chain) -> Quantities:
    """Return roots of temperatures in the centre over W, the force there over k s, and xi."""
    width = chain.free_velocity_width
    squares = result.velocity_width.values**2
    middle = middle_of(chain.size)
    displaced = result.mean_displacement.values
    force = np.sum(displaced[::-1][: chain.size // 2] - displaced[: chain.size // 2]) / 2
    return {
        "W_v": float(np.sqrt(squares[middle].mean())) / width,
        "relative": float(np.sqrt(result.relative_temperature.values[middle].mean())) / width,
        "common": float(np.sqrt(result.neighbour_covariance.values[middle].mean())) / width,
        "force": float(force) / chain.thermal_length,
        "xi": length_of(result, chain.size),
    }


def tabulate(name: str, found: Mapping[int, Quantities]) -> None:
    """Print the quantities of every length, and their slopes between lengths."""
    names = list(next(iter(found.values())))
    print(f"\n{name}\n| L | {' | '.join(names)} |\n|{(len(names) + 1) * '---|'}")
    for size, each in found.items():
        print(f"| {size} | " + " | ".join(f"{each[key]:.4g}" for key in names) + " |")
    sizes = list(found)
    for small, large in pairwise(sizes):
        slopes = [
            np.log(found[large][key] / found[small][key]) / np.log(large / small) for key in names
        ]
        print(f"| {small} to {large} | " + " | ".join(f"{each:+.3f}" for each in slopes) + " |")


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    simulations: dict[int, Quantities] = {}
    theories: dict[int, Quantities] = {}
    for size in SIZES:
        chain = Chain(size=size, restitution=0)
        try:
            theories[size] = quantities(solved(chain, folder), chain)
        except ValueError as error:
            print(f"theory, L = {size}: {error}", flush=True)
        simulations[size] = quantities(measured(chain, folder), chain)
    tabulate("theory", theories)
    tabulate("simulation", simulations)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
