"""Do the error bars of a limit dt -> 0 mean what they say? A table for the documentation.

    python -m studies.limit_calibration [--restitution 0 0.5 1] [--damping 1 4 10]
           [--size 5] [--gap 0] [--accuracy 0.1 0.03 0.01] [--seeds 200]

Limits of one chain that differ in their seeds only. For every quantity: the share of values that
lie within one of their own errors from the truth, which should be 0.68, and the root mean square of
their deviations in these errors, which should be 1. The truth is the exact equilibrium where it is
known (e = 1), elsewhere the mean over all seeds, so that the bias of the time step is not seen
there. Profiles are averaged over rods, nodes and bins; densities where they are at least a tenth of
their maximum. Last come the median duration of the base in relaxation times, the median of the
stated error of W_v in the centre over the accuracy, and the seconds of one limit.
"""

import itertools
import json
import time

import numpy as np
import xarray as xr

from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain
from crazybilliards.particles import simulate_limit
from crazybilliards.particles.scales import relaxation_time
from studies.common import options

OBSERVE = ("widths", "density", "velocities", "energy", "covariances", "modes")


def exact_values(chain: Chain) -> dict[str, np.ndarray]:
    if chain.restitution != 1:
        return {}
    exact, free = equilibrium(chain), np.array(chain.free_velocity_width)
    known = {name: exact[name].values for name in ("mean_displacement", "displacement_width")}
    return known | {
        "velocity_width": free,
        "central_velocity_width": free,
        "kinetic_energy": np.array(chain.temperature / 2 * chain.size),
        "relative_temperature": np.array(chain.free_velocity_width**2),
        "neighbour_covariance": np.array(0.0),
    }


def deviates(chain: Chain, limits: list[xr.Dataset]) -> dict[str, np.ndarray]:
    """Return the deviations of every quantity in its own errors, one row a seed."""
    known, found = exact_values(chain), {}
    for name in limits[0].data_vars:
        if f"{name}_error" not in limits[0]:
            continue
        values, errors = (
            np.array([each[key].values for each in limits]) for key in (name, f"{name}_error")
        )
        truth = known.get(name, values.mean(axis=0))
        if truth.shape and values[0].shape != truth.shape:
            continue
        looked_at = np.isfinite(errors) & (np.abs(errors).max(axis=0) > 0)
        if "density" in name:
            looked_at &= truth > 0.1 * truth.max()
        with np.errstate(divide="ignore", invalid="ignore"):
            found[name] = np.where(looked_at, (values - truth) / errors, np.nan)
    return found


def main() -> None:
    asked = options(
        __doc__,
        restitution=[0.0, 0.5, 1.0],
        damping=[1.0, 4.0, 10.0],
        size=[5],
        gap=[0.0],
        accuracy=[0.1, 0.03, 0.01],
        seeds=200,
    )
    axes = asked.restitution, asked.size, asked.gap, asked.damping, asked.accuracy
    for e, size, gap, damping, accuracy in itertools.product(*axes):
        chain = Chain(size=size, restitution=e, damping=damping, gap=gap)
        begin = time.process_time()
        limits = [
            simulate_limit(
                chain, accuracy=accuracy, observe=OBSERVE, seed=seed, threads=1, progress=False
            )
            for seed in range(asked.seeds)
        ]
        seconds = (time.process_time() - begin) / asked.seeds
        levels = [json.loads(each.attrs["provenance"])["levels"] for each in limits]
        duration = np.median([each[0]["duration"] for each in levels]) / relaxation_time(chain)
        stated = np.median(
            [each.central_velocity_width_error / each.central_velocity_width for each in limits]
        )
        print(
            f"e = {e:g}, L = {size}, g = {gap:g}, gamma = {damping:g}, accuracy {accuracy:g}: "
            f"{np.mean([len(each) for each in levels]):.2f} levels, base {duration:.0f} "
            f"relaxation times, error {stated / accuracy:.2f} of the accuracy, {seconds:.2f} s",
            flush=True,
        )
        for name, each in deviates(chain, limits).items():
            counted = each[np.isfinite(each)]
            if counted.size:
                print(
                    f"    {name:24s} {np.mean(np.abs(counted) <= 1):.2f} "
                    f"{np.sqrt(np.mean(counted**2)):.2f}   largest {np.abs(counted).max():.1f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
