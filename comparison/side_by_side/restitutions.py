"""Chains of several restitutions: simulation and kinetic equations, without a fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import xarray as xr

from crazybilliards.comparison.side_by_side.parameter_series import (
    SIMULATION,
    simulate_beside,
    varied_chains,
)
from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.comparison.widths import WidthDeviation, width_deviation
from crazybilliards.model import Chain
from crazybilliards.model.calls import warn_user
from crazybilliards.model.randomness import Randomness, seed_of

THEORY = "kinetic_equation"
# The theories by their names in the results.
LEGEND = {THEORY: THEORIES["phase_space"], "pair_correlations": THEORIES["correlated_phase_space"]}


def compare_restitutions(
    chain: Chain,
    restitutions: Sequence[float],
    *,
    duration: float = 5_000.0,
    seed: int = 0,
    rng: Randomness | None = None,
    threads: int | None = None,
    progress: bool = True,
    finished: Callable[[str, Mapping[str, xr.Dataset]], None] | None = None,
) -> xr.DataTree:
    """Simulate a chain at several restitutions and solve its kinetic equations.

    Parameters
    ----------
    chain
        The chain; its restitution is replaced by each of ``restitutions``.
    restitutions
        Different values of e. ``theories`` tells how good the kinetic equations are there.
    duration
        Simulated time of each of two replicas [T].
    seed, rng, threads, progress
        As in ``simulate``. Every restitution has its own random numbers.
    finished
        A function that is called with the name of each chain, such as ``restitution_0.95``, and
        with its theories by name, as soon as they are there.

    Returns
    -------
    xarray.DataTree
        ``tree["restitution_0.95/simulation"]``, ``.../kinetic_equation``, and
        ``.../pair_correlations`` where ``correlated_phase_space`` takes the chain. A theory that
        has no steady state is left out, with a warning that gives the reason.
        ``attrs["status"]`` is ``interrupted`` if Ctrl-C ended it early, and ``diverged`` if a
        simulation diverged. The tree then holds the results so far.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    """
    return simulate_beside(
        varied_chains(chain, "restitution", restitutions, duration),
        _kinetic_equations,
        duration=duration,
        seed=seed_of(seed, rng),
        threads=threads,
        progress=progress,
        finished=finished,
    )


def _kinetic_equations(chain: Chain, run: xr.Dataset) -> dict[str, xr.Dataset]:
    found = {}
    for key, theory in LEGEND.items():
        if key != THEORY and theory.refusal(chain):
            continue
        try:
            found[key] = theory.solve(chain)
        except ValueError as error:
            # For example, there is no steady state. The simulation must not be lost.
            warn_user(f"e = {chain.restitution:g} has no {theory.title}: {error}")
    return found


def width_deviations(tree: xr.DataTree) -> dict[str, dict[str, WidthDeviation]]:
    """Compare velocity widths of simulation and theories, by group and theory.

    Both ends of a chain have the same averages. Simulated widths are therefore averaged over a rod
    and its mirror image, which lowers their errors by up to the root of two.
    """
    if not all(SIMULATION in group for group in tree.children.values()):
        raise ValueError(
            f"tree must be what compare_restitutions returns, got {list(tree.children)}"
        )
    return {
        name: {
            key: width_deviation(group[SIMULATION].to_dataset(), group[key].to_dataset())
            for key in LEGEND
            if key in group and "velocity_width" in group[SIMULATION].data_vars
        }
        for name, group in tree.children.items()
    }
