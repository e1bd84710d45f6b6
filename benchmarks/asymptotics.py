"""Long chains at e = 0: how the centre's velocities, force and correlation length grow with L.

    python benchmarks/asymptotics.py FOLDER

Prints the tables of docs/reproduction.md: simulations at the default time step, and the correlated
theory as far as it can be solved. Results are kept in FOLDER, which ``neighbours.py`` shares. Takes
ten minutes on one core if it is empty.
"""

import sys
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np
import xarray as xr
from neighbours import length_of, measured, solved, spread_of

from crazybilliards.comparison import fit_border_power_law
from crazybilliards.model import Chain
from crazybilliards.model.chain import middle_tenth

SIZES = (30, 100, 300, 1000, 3000)
Quantities = dict[str, tuple[float, float]]  # value and standard error, 0 in theory


def quantities(result: xr.Dataset, chain: Chain) -> Quantities:
    """Return roots of temperatures in the centre over W, the force there over k s, and xi."""
    rods, width = chain.size, chain.free_velocity_width
    half = rods // 2
    simulated = "velocity_width_error" in result

    def root(name: str, power: int) -> tuple[float, float]:
        values = result[name].values
        middle = middle_tenth(values.size)  # of L rods, or of L - 1 contacts
        squares = values[middle] ** power
        value = float(np.sqrt(squares.mean()))
        if not simulated:
            return value / width, 0.0
        # Neighbouring rods err together.
        errors = power * result[f"{name}_error"].values[middle] * values[middle] ** (power - 1)
        return value / width, float(errors.mean() / (2 * value)) / width

    displaced = result.mean_displacement.values / chain.thermal_length
    force = float(displaced[::-1][:half].sum() - displaced[:half].sum()) / 2
    force_error = 0.0
    if simulated:
        errors = result.mean_displacement_error.values / chain.thermal_length
        force_error = float(errors[:half].sum()) / np.sqrt(2)
    return {
        "W_v": root("velocity_width", 2),
        "relative": root("relative_temperature", 1),
        "common": root("neighbour_covariance", 1),
        "force": (force, force_error),
        "xi": (length_of(result), spread_of(result) if simulated else 0.0),
    }


def tabulate(name: str, found: Mapping[int, Quantities]) -> None:
    """Print the quantities of every length, and their slopes between lengths."""
    names = list(next(iter(found.values())))
    print(f"\n{name}\n| L | {' | '.join(names)} |\n|{(len(names) + 1) * '---|'}")

    def printed(value: float, error: float) -> str:
        return f"{value:.4g} ± {error:.2g}" if error else f"{value:.4g}"

    for size, each in found.items():
        print(f"| {size} | " + " | ".join(printed(*each[key]) for key in names) + " |")
    for small, large in pairwise(found):
        factor = np.log(large / small)
        slopes = []
        for key in names:
            (first, first_error), (second, second_error) = found[small][key], found[large][key]
            error = np.hypot(first_error / first, second_error / second) / factor
            slopes.append(printed(round(np.log(second / first) / factor, 3), error))
        print(f"| {small} to {large} | " + " | ".join(slopes) + " |")


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    simulations: dict[int, Quantities] = {}
    theories: dict[int, Quantities] = {}
    for size in SIZES:
        chain = Chain(size=size, restitution=0)
        try:
            theory = solved(chain, folder)
        except ValueError as error:  # the theory refuses so long a chain
            print(f"theory, L = {size}: {error}", flush=True)
        else:
            theories[size] = quantities(theory, chain)
            profile = fit_border_power_law(theory)
            print(
                f"theory, L = {size}: nu = {profile.exponent:.3f} ± {profile.exponent_error:.3f}, "
                f"c = {profile.origin:.2f}",
                flush=True,
            )
        simulations[size] = quantities(measured(chain, folder), chain)
    tabulate("theory", theories)
    tabulate("simulation", simulations)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
