"""Is W_v in the centre a power of L as dt -> 0? Chains at e = 0, in the limit of a vanishing step.

    python -m studies.width_in_the_limit FOLDER

One limit for every length. The tables give W_v with the cost of its limit, its slopes, and fits
along the chain.
"""

from __future__ import annotations

import json
import math

import xarray as xr

from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from studies.common import Results, Table, carry_out

ACCURACY = dict.fromkeys((10, 30, 100, 300, 1000, 3000), 0.005) | {10_000: 0.01}
FITTED = range(30, 3001)  # rods of the fits along the chain
APART = 2  # places in the list of lengths between the ends of a slope


def cases() -> dict[str, Case]:
    return {
        f"L={size}": Case(
            "simulate_limit",
            Chain(size=size, restitution=0.0),
            {"accuracy": accuracy, "observe": ["widths"], "seed": 0},
        )
        for size, accuracy in ACCURACY.items()
    }


def central(limit: xr.Dataset) -> tuple[float, float]:
    return limit.central_velocity_width.item(), limit.central_velocity_width_error.item()


def of_limit(size: int, limit: xr.Dataset) -> list[str]:
    step = json.loads(limit.attrs["provenance"])["schedule"]["time_step"]
    width, error = central(limit)
    return [
        f"{size}",
        f"{width:.6f} ± {error:.6f}",
        f"{error / width:.2%}",
        f"{limit.attrs['time_step_error']:.2%}",
        f"{step:.2g}",
        f"{size * limit.attrs['end_time'] / step:.1e}",
    ]


def slope(one: xr.Dataset, other: xr.Dataset) -> list[str]:
    sizes = [chain_of(limit).size for limit in (one, other)]
    (first, first_error), (last, last_error) = central(one), central(other)
    span = math.log(sizes[1] / sizes[0])
    error = math.hypot(first_error / first, last_error / last) / span
    return [f"{sizes[0]} → {sizes[1]}", f"{math.log(last / first) / span:.4f} ± {error:.4f}"]


def tables(results: Results) -> dict[str, Table]:
    limits = list(results.values())
    by_size = {chain_of(limit).size: limit for limit in limits}
    fits = {size: fit_border_power_law(by_size[size]) for size in by_size if size in FITTED}
    exponents = [
        [f"{size}", f"{fit.exponent:.4f} ± {fit.exponent_error:.4f}", f"{fit.origin:.2f}"]
        for size, fit in fits.items()
    ]
    heads = ["L", "$W_v$, centre", "error", "bias", "steps", "rod-steps"]
    return {
        "central_width": [heads, *(of_limit(*each) for each in by_size.items())],
        "central_slopes_of_limits": [["L", "slope"], *map(slope, limits, limits[APART:])],
        "profile_exponent_of_limits": [["L", r"$\nu$", "$c$"], *exponents],
    }


if __name__ == "__main__":
    carry_out(__doc__, cases(), tables)
