"""The main comparison: the simulated elastic chain and three theories of it.

For each driving amplitude A there are four results: the simulation; the exact equilibrium; the
force balance closed by labels, without an input; and the force balance with an arctanh fitted to
the simulated displacements, as in the paper.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.distances import Deviation, deviation
from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.side_by_side.parameter_series import (
    SIMULATION,
    simulate_beside,
    varied_chains,
)
from crazybilliards.kinetic import equilibrium, force_balance
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.calls import warn_user
from crazybilliards.model.randomness import Randomness, seed_of

LEGEND = {
    "exact": "exact",
    "labels": "force balance, without fit",
    "arctanh": "force balance, arctanh fit",
}


def compare_elastic(
    chain: Chain,
    amplitudes: Sequence[float] = (1.0, 3.0, 10.0, 30.0),
    *,
    duration: float = 100_000.0,
    seed: int = 0,
    rng: Randomness | None = None,
    threads: int | None = None,
    progress: bool = True,
) -> xr.DataTree:
    """Simulate the elastic chain at several amplitudes and compute its theories.

    Parameters
    ----------
    chain
        The chain, with restitution 1; its amplitude is replaced by each of ``amplitudes``.
    duration
        Simulated time of each of two replicas [T]; 100 000 takes 2 s for 100 rods.
    seed, rng, threads, progress
        As in ``simulate``. Every amplitude has its own random numbers.

    Returns
    -------
    xarray.DataTree
        ``tree["amplitude_3/simulation"]``, ``.../exact``, ``.../labels``, ``.../arctanh``: results
        in the common vocabulary, not smoothed. ``attrs["status"]`` is ``interrupted`` if Ctrl-C
        ended it early. The tree then holds the finished results and the interrupted run.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    """
    if chain.restitution != 1:
        raise ValueError(f"the comparison is of elastic chains, got e={chain.restitution:g}")
    return simulate_beside(
        varied_chains(chain, "amplitude", amplitudes, duration),
        elastic_theories,
        duration=duration,
        seed=seed_of(seed, rng),
        threads=threads,
        progress=progress,
    )


def deviations(tree: xr.DataTree) -> dict[str, dict[str, Deviation]]:
    """Deviation of each theory's smoothed density from the simulation's, by group and theory."""
    return {
        name: {
            key: deviation(smooth(group[SIMULATION].to_dataset()), smooth(group[key].to_dataset()))
            for key in LEGEND
            if key in group
        }
        for name, group in tree.children.items()
    }


def largest_width_error(group: xr.DataTree) -> float:
    """Max over particles of |W_v - W| in standard errors; W is exact for every particle."""
    run = group[SIMULATION].to_dataset()
    width = chain_of(run).free_velocity_width
    return float(np.abs((run.velocity_width - width) / run.velocity_width_error).max())


def elastic_theories(chain: Chain, run: xr.Dataset) -> dict[str, xr.Dataset]:
    """Return the theories by the names in ``LEGEND``; the arctanh is fitted to the run."""
    theories = {"exact": equilibrium(chain), "labels": force_balance(chain)}
    try:
        fit = fit_arctanh(run)
        arctanh = force_balance(chain, displacement=fit)
    except ValueError as error:
        # This happens for rods that hardly touch. The simulation must not be lost.
        warn_user(f"A = {chain.amplitude:g} has no arctanh fit: {error}")
        return theories
    # The fit at the simulated mean positions, to be drawn beside the displacements.
    fitted = fit(chain.anchors + run.mean_displacement)
    arctanh["mean_displacement"] = run.mean_displacement.copy(data=fitted)
    arctanh.attrs |= {
        name: getattr(fit, name)
        for name in ("scale", "scale_error", "steepness", "steepness_error", "misfit")
    }
    return theories | {"arctanh": arctanh}
