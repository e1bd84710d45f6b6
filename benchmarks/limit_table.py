"""Is W_v in the centre a power of L as dt -> 0? A table from a sweep of ``simulate_limit``.

    python benchmarks/limit_table.py FOLDER

For every size: W_v in the centre, its error and the part of it that is bias, the levels, and the
paper's sum of two power laws, whose exponent nu has the error of the fit. Then the slope of
ln W_v(centre) over ln L from each size to the next but one.
"""

import argparse
import json
import math
from pathlib import Path

import xarray as xr

from crazybilliards.comparison import fit_border_power_law
from crazybilliards.model import chain_of, load

LEAST_RODS, MOST_RODS = 30, 3000  # of the fits


def row(limit: xr.Dataset) -> str:
    size, provenance = chain_of(limit).size, json.loads(limit.attrs["provenance"])
    width, error = limit.central_velocity_width.item(), limit.central_velocity_width_error.item()
    steps = ", ".join(f"{level['time_step']:.2g}" for level in provenance["levels"])
    work = sum(level["rod_steps"] for level in provenance["levels"])
    fit = "- | -"
    if LEAST_RODS <= size <= MOST_RODS:
        found = fit_border_power_law(limit)
        fit = f"{found.exponent:.4f} ± {found.exponent_error:.4f} | {found.origin:.2f}"
    return (
        f"| {size} | {width:.6f} ± {error:.6f} | {error / width:.2%} | "
        f"{limit.attrs['time_step_error']:.2%} | {steps} | {work:.1e} | {fit} |"
    )


def slope(one: xr.Dataset, other: xr.Dataset) -> str:
    sizes = [chain_of(each).size for each in (one, other)]
    width, wider = (each.central_velocity_width.item() for each in (one, other))
    relative = [
        each.central_velocity_width_error.item() / each.central_velocity_width.item()
        for each in (one, other)
    ]
    span = math.log(sizes[1] / sizes[0])
    value, error = math.log(wider / width) / span, math.hypot(*relative) / span
    return f"| {sizes[0]} to {sizes[1]} | {value:.4f} ± {error:.4f} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    limits = [load(path) for path in parser.parse_args().folder.glob("*.nc")]
    complete = [each for each in limits if each.attrs["status"] == "completed"]
    complete.sort(key=lambda limit: chain_of(limit).size)
    print("| L | W_v, centre | error | of it bias | steps | rod-steps | nu | c |")
    print("|---" * 8 + "|")
    print("\n".join(map(row, complete)))
    print("\n| L | slope |\n|---|---|")
    print("\n".join(map(slope, complete, complete[2:])))


if __name__ == "__main__":
    main()
