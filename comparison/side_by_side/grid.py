"""One chain at several values of a parameter: simulated, and solved by its theories.

At e = 1 the amplitude varies. There are five results for each: the simulation; the exact
equilibrium; the force balance closed by labels, without an input; the density of its rods; and the
force balance with an arctanh fitted to the simulated displacements, as in the paper. At other e the
restitution varies, and the kinetic equations are solved, without a fit.

The simulations and the kinetic equations are cases of a sweep: each is written to a folder as soon
as it is computed, and the same call takes it from there.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import Executor
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.comparison.fits import fit_arctanh
from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.comparison.sweeps import Case, process_pool, run_cases
from crazybilliards.comparison.sweeps.engines import ThisProcess
from crazybilliards.comparison.sweeps.missing import warn_of_short_runs
from crazybilliards.kinetic import equilibrium, force_balance, rod_by_rod
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.calls import public, warn_user
from crazybilliards.model.checks import (
    as_written,
    check_integer,
    check_path,
    check_real,
    is_list,
    shown,
)
from crazybilliards.model.process import announced, cores
from crazybilliards.model.progress import waiting_for
from crazybilliards.model.randomness import Seed, seed_of
from crazybilliards.particles.simulation import compile_kernels

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


@public
def compare_elastic(
    chain: Chain,
    amplitudes: ArrayLike = (1.0, 3.0, 10.0, 30.0),
    *,
    folder: Folder | None = None,
    duration: float = 100_000.0,
    seed: Seed = 0,
    processes: int | None = None,
    threads: int | None = None,
    keep_old: bool = False,
    progress: bool = True,
) -> xr.DataTree:
    """Simulate the elastic chain at several amplitudes and compute its theories.

    Parameters
    ----------
    chain
        The chain, with restitution 1; its amplitude is replaced by each of ``amplitudes``,
        which are taken as ``restitutions`` of :func:`compare_restitutions`.
    folder
        Folder for the simulations, one file each, written as soon as it is done. The same call
        takes them from there, so nothing is lost when the program is killed. None: a folder that
        is removed at the end.
    duration
        Simulated time of each of two replicas [T]; 100 000 takes 2 s for 100 rods.
    seed
        As in ``simulate``. Every amplitude has its own random numbers.
    processes
        Processes to compute in. They are started anew, so a script must call this under
        ``if __name__ == "__main__":``. None: this process.
    threads
        Threads to simulate in, in this process; None: one per core.
    keep_old
        Take results in ``folder`` that other source code of the package computed.
    progress
        Show a progress bar, if standard error is a terminal.

    Returns
    -------
    xarray.DataTree
        ``tree["amplitude_3/simulation"]``, ``.../exact``, ``.../labels``, ``.../rods``,
        ``.../arctanh``: results in the common vocabulary, not smoothed. ``attrs["status"]`` is
        ``interrupted`` if Ctrl-C ended it early. The tree then holds what was finished.

    Raises
    ------
    ValueError
        For a wrong argument, before any work.
    RuntimeError
        If a worker process dies. What was finished stays in ``folder``.
    """
    if chain.restitution != 1:
        raise ValueError(
            f"the comparison is of elastic chains, restitution=1, got {chain.restitution:g}; "
            "compare_restitutions compares others"
        )
    cases = _simulations(chain, "amplitude", amplitudes, duration, seed_of(seed))
    results, status = _computed(cases, folder, processes, threads, keep_old, progress)
    with waiting_for("theories", progress):
        return elastic_tree({name: found[SIMULATION] for name, found in results.items()}, status)


@public
def compare_restitutions(
    chain: Chain,
    restitutions: ArrayLike,
    *,
    folder: Folder | None = None,
    duration: float = 5_000.0,
    seed: Seed = 0,
    processes: int | None = None,
    threads: int | None = None,
    keep_old: bool = False,
    progress: bool = True,
) -> xr.DataTree:
    """Simulate a chain at several restitutions and solve its kinetic equations.

    Parameters
    ----------
    chain
        The chain; its restitution is replaced by each of ``restitutions``.
    restitutions
        Different values of e, a list or an array; errors of rounding are taken away, so that
        ``numpy.arange`` gives 0.3 and not 0.30000000000000004. ``theories`` tells how good the
        kinetic equations are there.
    duration
        Simulated time of each of two replicas [T].
    folder, seed, processes, threads, keep_old, progress
        As in :func:`compare_elastic`. The folder holds the theories, too.

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
    cases = _simulations(chain, "restitution", restitutions, duration, seed_of(seed))
    for found in cases.values():
        here = found[SIMULATION].chain
        for key, job in KINETIC.items():
            reason = THEORIES[job].refusal(here)
            if not reason:
                found[key] = Case(job, here, {})
            elif job == "phase_space":  # which takes nearly every chain
                _warn_of_no_theory(here, job, reason)
    return _tree(*_computed(cases, folder, processes, threads, keep_old, progress))


def elastic_tree(runs: Mapping[str, xr.Dataset], status: str = "completed") -> xr.DataTree:
    """Compute the theories of simulated elastic chains, which are given by their names."""
    return _tree(
        {name: {SIMULATION: run} | _elastic_theories(run) for name, run in runs.items()}, status
    )


def _simulations(
    chain: Chain, name: str, values: ArrayLike, duration: float, seed: int
) -> dict[str, dict[str, Case]]:
    """Return the simulation at every value of a parameter; all are checked before any work."""
    if not is_list(values):
        raise ValueError(f"{name}s must be a list of numbers, got {shown(values)}")
    checked = [check_real(name, as_written(value)) for value in values]
    if not checked:
        raise ValueError(f"{name}s must hold at least one number")
    if len(set(checked)) != len(checked):
        raise ValueError(f"{name}s must differ from one another, got {list(values)}")
    chains = {f"{name}_{value:g}": chain.replace(**{name: value}) for value in checked}
    if len(chains) != len(checked):
        raise ValueError(f"{name}s must differ in their first six digits, got {list(values)}")
    for each in chains.values():
        require_chain(each, "the comparison with theories")
    settings = {"duration": duration, "replicas": _REPLICAS, "seed": seed}
    return {key: {SIMULATION: Case("simulate", each, settings)} for key, each in chains.items()}


def _computed(
    cases: Mapping[str, Mapping[str, Case]],
    folder: Folder | None,
    processes: int | None,
    threads: int | None,
    keep_old: bool,
    progress: bool,
) -> tuple[dict[str, dict[str, xr.Dataset]], str]:
    """Compute the cases; return their results by name and key, and the status of all of them."""
    threads = check_integer("threads", cores() if threads is None else threads, least=1)
    if processes is not None:
        check_integer("processes", processes, least=1)
    every = [case for found in cases.values() for case in found.values()]
    warn_of_short_runs([case.too_short for case in every if case.too_short], len(cases))
    failed: dict[Case, str] = {}
    status = "completed"
    with ExitStack() as stack:
        place = stack.enter_context(TemporaryDirectory()) if folder is None else folder
        place = check_path("folder", place)
        workers: AbstractContextManager[Executor] = ThisProcess(threads)
        if processes is not None:
            workers = process_pool(min(processes, len(every)))
        if not all(case.file(place).exists() for case in every):
            with announced(progress):
                compile_kernels()
        try:
            with workers as executor:
                failed = run_cases(every, place, executor, keep_old=keep_old, progress=progress)
        except KeyboardInterrupt:
            status = "interrupted"
        results = {name: _read(found, place, keep_old) for name, found in cases.items()}
    for case, reason in failed.items():
        if case.job not in THEORIES:
            raise ValueError(reason)
        _warn_of_no_theory(case.chain, case.job, reason.removeprefix("ValueError: "))
    results = {name: found for name, found in results.items() if SIMULATION in found}
    if not results:
        raise KeyboardInterrupt
    diverged = any(each[SIMULATION].attrs["status"] == "diverged" for each in results.values())
    return results, "diverged" if diverged and status == "completed" else status


def _warn_of_no_theory(chain: Chain, job: str, reason: str) -> None:
    warn_user(f"e = {chain.restitution:g} has no {THEORIES[job].title}: {reason}")


def _read(cases: Mapping[str, Case], folder: Path, keep_old: bool) -> dict[str, xr.Dataset]:
    """Return the results that are there: after Ctrl-C some may be missing, or outdated."""
    results = {}
    for key, case in cases.items():
        try:
            results[key] = case.load(folder, keep_old=keep_old)
        except (FileNotFoundError, ValueError):
            continue
        del results[key].attrs["seconds"]  # the same call gives the same tree
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
