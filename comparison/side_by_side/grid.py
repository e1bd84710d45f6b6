"""One chain at several values of a parameter: simulated, and solved by its theories.

If all chains have e = 1, the theories are the exact equilibrium; the force balance closed by
labels, without an input; the density of its rods; and the force balance with an arctanh fitted to
the simulated displacements, as in the paper, if there are springs. Otherwise they are the kinetic
equations, without a fit.

The simulations and the kinetic equations are cases of a sweep: each is written to a folder as soon
as it is computed, and the same call takes it from there.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray as xr
from loky import cpu_count
from numpy.typing import ArrayLike

from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases
from crazybilliards.kinetic import equilibrium, force_balance, rod_by_rod
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.warn import warn_user
from crazybilliards.model.checks import as_written, check_integer, check_path, is_list, shown
from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.model.process import announced
from crazybilliards.model.progress import waiting_for
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.particles.simulation import make_run
from crazybilliards.particles.stepping import compile_kernels

Folder = str | os.PathLike[str]

SIMULATION = "simulation"
ELASTIC = {
    "exact": "exact",
    "labels": "force balance, without fit",
    "arctanh": "force balance, arctanh fit",
    "rods": "force balance, rod by rod",
}
# The kinetic equations by their names in the results, and the jobs that solve them.
KINETIC = {"kinetic_equation": "phase_space", "pair_correlations": "correlated_phase_space"}
# What every result is called in pictures.
TITLES = (
    {SIMULATION: SIMULATION} | ELASTIC | {key: THEORIES[job].title for key, job in KINETIC.items()}
)

_REPLICAS = 2


def compare(
    chain: Chain,
    over: Mapping[str, ArrayLike],
    *,
    folder: Folder | None = None,
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
        ``{"amplitude": [1, 3, 10, 30]}``. Errors of rounding are taken away, so that
        ``numpy.arange`` gives 0.3 and not 0.30000000000000004.
    folder
        Folder for the simulations and the kinetic equations, one file each, written as soon as it
        is done. The same call takes them from there, so nothing is lost when the program is killed.
        None: a folder that is removed at the end.
    duration
        Simulated time of each of two replicas [T]; 100 000 takes 2 s for 100 rods at e = 1, and
        25 s at e = 0.9.
    seed
        As in ``simulate``. Every chain has its own random numbers.
    processes
        Processes to compute in. They are started anew, so a script must call this under
        ``if __name__ == "__main__":``. None: this process.
    threads
        Threads to simulate in, in this process; None: one per core.
    progress
        Show a progress bar, if standard error is a terminal.

    Returns
    -------
    xarray.DataTree
        ``tree["amplitude_3/simulation"]`` and its theories beside it, results in the common
        vocabulary, not smoothed. If all chains have e = 1: ``.../exact``, ``.../labels``,
        ``.../rods`` and, with springs, ``.../arctanh``. Otherwise ``.../kinetic_equation``, and
        ``.../pair_correlations`` where ``correlated_phase_space`` takes the chain; ``theories``
        tells how good they are. A theory that has no steady state is left out, with a warning that
        gives the reason. ``attrs["status"]`` is ``interrupted`` if Ctrl-C ended it early, and
        ``diverged`` if a simulation diverged. The tree then holds the results so far.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    RuntimeError
        If a worker process dies. What was finished stays in ``folder``.
    """
    chains = _chains(chain, over)
    settings = {"duration": duration, "replicas": _REPLICAS, "seed": seed_of(seed)}
    walls = {"observe": ("widths", "density", "walls")}
    cases = {
        name: {SIMULATION: Case("simulate", each, settings | (walls if each.box else {}))}
        for name, each in chains.items()
    }
    if all(each.restitution == 1 for each in chains.values()):
        results, status = _computed(cases, folder, processes, threads, progress)
        with waiting_for("theories", progress):
            return elastic_tree(
                {name: found[SIMULATION] for name, found in results.items()}, status
            )
    for name, here in chains.items():
        for key, job in KINETIC.items():
            reason = THEORIES[job].refusal(here)
            if not reason:
                cases[name][key] = Case(job, here, {})
            elif job == "phase_space":  # which takes nearly every chain
                _warn_of_no_theory(here, job, reason)
    return _tree(*_computed(cases, folder, processes, threads, progress))


def elastic_tree(runs: Mapping[str, xr.Dataset], status: str = "completed") -> xr.DataTree:
    """Compute the theories of simulated elastic chains, which are given by their names."""
    return _tree(
        {name: {SIMULATION: run} | _elastic_theories(run) for name, run in runs.items()}, status
    )


def _chains(chain: Chain, over: Mapping[str, ArrayLike]) -> dict[str, Chain]:
    """Return the chains by their names, such as ``amplitude_3``."""
    if not isinstance(over, Mapping) or len(over) != 1:
        raise ValueError(
            "over must be one parameter of the chain and its values, such as "
            f"{{'amplitude': [1, 3]}}, got {shown(over)}"
        )
    [(name, values)] = over.items()
    if not is_list(values):
        raise ValueError(f"over: {name} must be a list, got {shown(values)}")
    if not len(values):
        raise ValueError(f"over: {name} must hold at least one value")
    chains = {}
    for value in values:
        each = chain.replace(**{name: as_written(value)})
        require_chain(each, "the comparison with theories", knows=WALLS_AND_MASSES)
        number = each.parameters()[name]
        chains[f"{name}_{number if isinstance(number, str) else f'{number:g}'}"] = each
    if len(chains) != len(values):
        raise ValueError(
            f"over: the values of {name} must differ in their first six digits, got {list(values)}"
        )
    return chains


def _computed(
    cases: Mapping[str, Mapping[str, Case]],
    folder: Folder | None,
    processes: int | None,
    threads: int | None,
    progress: bool,
) -> tuple[dict[str, dict[str, xr.Dataset]], str]:
    """Compute the cases; return their results by name and key, and the status of all of them."""
    threads = check_integer("threads", cpu_count() if threads is None else threads, least=1)
    every = [case for found in cases.values() for case in found.values()]
    with ExitStack() as stack:
        place = stack.enter_context(TemporaryDirectory()) if folder is None else folder
        place = check_path("folder", place)
        pool = None if processes is None else stack.enter_context(process_pool(processes))
        status, failed = "completed", {}
        with announced(progress):
            simulated = [found[SIMULATION] for found in cases.values()]
            compile_kernels(make_run(case.chain, **case.settings).exact for case in simulated)
        try:
            failed = run_cases(every, place, pool, threads=threads, progress=progress)
        except KeyboardInterrupt:
            status = "interrupted"
        results = {name: _read(found, place) for name, found in cases.items()}
    for case, reason in failed.items():
        if case.job not in THEORIES:
            raise ValueError(reason)
        _warn_of_no_theory(case.chain, case.job, reason.removeprefix("ValueError: "))
    results = {name: found for name, found in results.items() if SIMULATION in found}
    if not results:
        raise KeyboardInterrupt
    if status == "completed" and any(
        each[SIMULATION].attrs["status"] == "diverged" for each in results.values()
    ):
        status = "diverged"
    return results, status


def _warn_of_no_theory(chain: Chain, job: str, reason: str) -> None:
    warn_user(f"e = {chain.restitution:g} has no {THEORIES[job].title}: {reason}")


def _read(cases: Mapping[str, Case], folder: Path) -> dict[str, xr.Dataset]:
    """Return the results that are there: after Ctrl-C some may be missing, or outdated."""
    results = {}
    for key, case in cases.items():
        try:
            results[key] = case.load(folder)
        except (FileNotFoundError, ValueError):
            continue
    return results


def _tree(results: Mapping[str, Mapping[str, xr.Dataset]], status: str) -> xr.DataTree:
    tree = xr.DataTree.from_dict(
        {f"{name}/{key}": each for name, found in results.items() for key, each in found.items()}
    )
    tree.attrs |= {"status": status, "source": "comparison"}
    return tree


def _elastic_theories(run: xr.Dataset) -> dict[str, xr.Dataset]:
    """Return the theories by their names; the arctanh is fitted to the run."""
    chain = chain_of(run)
    balance = force_balance(chain)
    theories = {"exact": equilibrium(chain), "labels": balance, "rods": rod_by_rod(balance)}
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
    arctanh.attrs |= {
        name: getattr(fit, name)
        for name in ("scale", "scale_error", "steepness", "steepness_error", "misfit")
    }
    return theories | {"arctanh": arctanh}
