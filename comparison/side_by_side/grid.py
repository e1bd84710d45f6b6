"""One chain at several values of a parameter: simulated, with its theories beside it."""

import os
from collections.abc import Mapping
from contextlib import ExitStack
from tempfile import TemporaryDirectory

import xarray as xr
from loky import cpu_count
from numpy.typing import ArrayLike

from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.stationary_theories import theory_of
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases
from crazybilliards.comparison.sweeps.grid import grid_values
from crazybilliards.kinetic import equilibrium, force_balance, rod_by_rod
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import WALLS_AND_MASSES, Chain, chain_of
from crazybilliards.model.checks import check_chain, check_integer, check_path, shown
from crazybilliards.model.kernels import announced
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.model.vocabulary import require
from crazybilliards.model.warn import warn_user
from crazybilliards.particles.simulation import make_run
from crazybilliards.particles.stepping import compile_kernels

SIMULATION = "simulation"
# The theories of a comparison, in the order of the pictures.
ELASTIC = ("equilibrium", "force_balance", "force_balance_arctanh", "rod_by_rod")
GAS = "steady_state"


def compare(
    chain: Chain,
    over: Mapping[str, ArrayLike],
    *,
    folder: str | os.PathLike[str] | None = None,
    duration: float = 100_000.0,
    seed: Seed = 0,
    processes: int | None = None,
    threads: int | None = None,
    progress: bool = True,
) -> xr.DataTree:
    """Simulate a chain at several values of a parameter, and solve its theories.

    Parameters
    ----------
    chain
        The chain.
    over
        A parameter of the chain and the values that replace it, a list or an array:
        ``{"amplitude": [1, 3, 10, 30]}``. Errors of rounding, as of ``numpy.arange``, are taken
        away.
    folder
        Folder for the simulations and the steady states of the gas, one file each, written as soon
        as it is done. The same call takes them from there. None: one that is removed at the end.
    duration
        Simulated time of each of two replicas [t_0]; 100 000 takes 2 s for 100 rods at e = 1, and
        25 s at e = 0.9.
    seed
        As in ``simulate``. Every chain has its own random numbers.
    processes
        Processes to compute in. None: this process.
    threads
        Threads to simulate in, in this process; None: one per core.
    progress
        Show a progress bar, if standard error is a terminal, otherwise a line every half minute.

    Returns
    -------
    xarray.DataTree
        ``tree["amplitude_3/simulation"]`` and its theories beside it by the names of their
        functions, results in the common vocabulary, not smoothed. If all chains have e = 1:
        ``equilibrium``, ``force_balance`` (closed by labels, without an input), ``rod_by_rod`` and,
        with springs, ``force_balance_arctanh`` (an arctanh fitted to the simulated displacements,
        as in the paper). Otherwise, also with inelastic walls, all chains have ``steady_state``;
        where it has no solution a warning gives the reason. ``attrs["status"]`` is ``interrupted``
        if Ctrl-C ended it early, with the results so far, and ``diverged`` if a simulation
        diverged.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    RuntimeError
        If a simulation fails, for example because its process dies.
    """
    chains = _chains(chain, over)
    settings = {"duration": duration, "replicas": 2, "seed": seed_of(seed)}
    elastic = all(theory_of(chain).name == "equilibrium" for chain in chains.values())
    cases = {}
    for name, chain in chains.items():
        walls = {"observe": ("widths", "density", "walls")} if chain.box else {}
        cases[name] = {SIMULATION: Case("simulate", chain, settings | walls)}
        try:
            if not elastic:
                cases[name][GAS] = Case(GAS, chain, {})
        except ValueError as error:
            _warn_of_no_gas(chain, str(error))
    results, status = _computed(cases, folder, processes, threads, progress)
    if elastic:
        return elastic_tree({name: group[SIMULATION] for name, group in results.items()}, status)
    return _tree(results, status)


def elastic_tree(runs: Mapping[str, xr.Dataset], status: str = "completed") -> xr.DataTree:
    """Compute the theories of simulated elastic chains, which are given by their names."""
    return _tree(
        {name: {SIMULATION: run} | _elastic_theories(run) for name, run in runs.items()}, status
    )


def _chains(chain: Chain, over: Mapping[str, ArrayLike]) -> dict[str, Chain]:
    """Return the chains by their names, such as ``amplitude_3``."""
    check_chain(chain)
    if not isinstance(over, Mapping) or len(over) != 1:
        raise ValueError(
            "over must be one parameter of the chain and its values, such as "
            f"{{'amplitude': [1, 3]}}, got {shown(over)}"
        )
    [(name, values)] = over.items()
    values, chains = grid_values("over", name, values), {}
    for value in values:
        changed = chain.replace(**{name: value})
        require_chain(changed, "the comparison with theories", knows=WALLS_AND_MASSES)
        number = changed.parameters()[name]
        chains[f"{name}_{number if isinstance(number, str) else f'{number:g}'}"] = changed
    if len(chains) != len(values):
        raise ValueError(
            f"over: the values of {name} must differ in their first six digits, got {values}"
        )
    return chains


def _computed(
    cases: Mapping[str, Mapping[str, Case]],
    folder: str | os.PathLike[str] | None,
    processes: int | None,
    threads: int | None,
    progress: bool,
) -> tuple[dict[str, dict[str, xr.Dataset]], str]:
    """Compute the cases; return their results by name and key, and the status of all of them."""
    threads = check_integer("threads", cpu_count() if threads is None else threads, least=1)
    status, failed = "completed", {}
    with ExitStack() as stack:
        place = stack.enter_context(TemporaryDirectory()) if folder is None else folder
        place = check_path("folder", place)
        pool = None if processes is None else stack.enter_context(process_pool(processes))
        with announced(progress):
            simulated = [group[SIMULATION] for group in cases.values()]
            compile_kernels(make_run(case.chain, **case.settings).exact for case in simulated)
        try:
            every = [case for group in cases.values() for case in group.values()]
            failed = run_cases(every, place, pool, threads=threads, progress=progress)
        except KeyboardInterrupt:
            status = "interrupted"
        # After Ctrl-C some may be missing, or outdated.
        done = {c for c in every if c not in failed and (status == "completed" or c.is_in(place))}
        results = {
            name: {key: case.load(place) for key, case in group.items() if case in done}
            for name, group in cases.items()
        }
    for case, reason in failed.items():
        if case.job != GAS:
            raise RuntimeError(reason)
        _warn_of_no_gas(case.chain, reason.removeprefix("ValueError: "))
    results = {name: group for name, group in results.items() if SIMULATION in group}
    if not results:
        raise KeyboardInterrupt
    for name, group in results.items():
        require(group[SIMULATION], (), name)  # warns if the chain diverged
        if status == "completed":
            status = group[SIMULATION].attrs["status"]
    return results, status


def _warn_of_no_gas(chain: Chain, reason: str) -> None:
    warn_user(f"e = {chain.restitution:g} has no theory: {reason}")


def _tree(results: dict[str, dict[str, xr.Dataset]], status: str) -> xr.DataTree:
    tree = xr.DataTree.from_dict(results, nested=True)
    tree.attrs |= {"status": status, "source": "comparison"}
    return tree


def _elastic_theories(run: xr.Dataset) -> dict[str, xr.Dataset]:
    """Return the theories by their names; the arctanh is fitted to the run."""
    chain = chain_of(run)
    balance = force_balance(chain)
    theories = {
        "equilibrium": equilibrium(chain),
        "force_balance": balance,
        "rod_by_rod": rod_by_rod(balance),
    }
    if chain.stiffness == 0:  # displacements then have no effect
        return theories
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
    told = ("scale", "scale_error", "steepness", "steepness_error", "misfit")
    arctanh.attrs |= {name: getattr(fit, name) for name in told}
    return theories | {"force_balance_arctanh": arctanh}
