"""Chains that differ in one parameter: each is simulated and its theories are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
import xarray as xr

from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_integer, check_real, shown
from crazybilliards.model.progress import waiting_for
from crazybilliards.particles import simulate
from crazybilliards.particles.schedule import make_schedule

SIMULATION = "simulation"

# The number of runs does not depend on the number of threads; two use two cores.
_REPLICAS = 2


def varied_chains(
    chain: Chain, name: str, values: Sequence[float], duration: float
) -> dict[str, Chain]:
    """Return the chain at every value of a parameter; all are checked before any work."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise ValueError(f"{name}s must be a list of numbers, got {shown(values)}")
    checked = [check_real(name, value) for value in values]
    if not checked:
        raise ValueError(f"{name}s must hold at least one number")
    if len(set(checked)) != len(checked):
        raise ValueError(f"{name}s must differ from one another, got {list(values)}")
    chains = {f"{name}_{value:g}": chain.replace(**{name: value}) for value in checked}
    if len(chains) != len(checked):
        raise ValueError(f"{name}s must differ in their first six digits, got {list(values)}")
    for each in chains.values():
        require_chain(each, "the comparison with theories")
        make_schedule(each, duration=duration, replicas=_REPLICAS)
    return chains


def simulate_beside(
    chains: Mapping[str, Chain],
    theories: Callable[[Chain, xr.Dataset], Mapping[str, xr.Dataset]],
    *,
    duration: float,
    seed: int,
    threads: int | None,
    progress: bool,
    finished: Callable[[str, Mapping[str, xr.Dataset]], None] | None = None,
) -> xr.DataTree:
    """Simulate every chain with its own random numbers, and compute its theories.

    ``finished`` is called with the name of each chain and with its theories, as soon as they are
    there.

    Returns
    -------
    xarray.DataTree
        ``tree["NAME/simulation"]`` and ``tree["NAME/THEORY"]``. ``attrs["status"]`` is
        ``interrupted`` if Ctrl-C ended it early (the tree then holds the finished results and the
        interrupted run), ``diverged`` if a simulation diverged.
    """
    seeds = np.random.SeedSequence(check_integer("seed", seed, least=0))
    results: dict[str, xr.Dataset] = {}
    status = "completed"
    try:
        own_seeds = seeds.generate_state(len(chains))
        for number, (name, chain) in enumerate(chains.items()):
            what = f"{name.replace('_', ' ')}, {number + 1} of {len(chains)}"
            run = simulate(
                chain,
                duration=duration,
                seed=int(own_seeds[number]),
                replicas=_REPLICAS,
                threads=threads,
                progress=progress and what,
            )
            results[f"{name}/{SIMULATION}"] = run
            if run.attrs["status"] != "completed":
                status = run.attrs["status"]
            with waiting_for(f"theories of {what}", progress):
                beside = theories(chain, run)
            results |= {f"{name}/{key}": theory for key, theory in beside.items()}
            if finished is not None:
                finished(name, beside)
            if status == "interrupted":
                break
    except KeyboardInterrupt:
        if not results:
            raise
        status = "interrupted"
    tree = xr.DataTree.from_dict(results)
    tree.attrs |= {"status": status, "source": "comparison"}
    return tree
