"""One case: a job, a chain and the job's settings, with a name that follows from them alone.

The name is a hash of the case's canonical parameters: every parameter, defaults included, numbers
written one way, and the version of the package. The parameters are stored in the file as well.
A case's random numbers follow from its parameters too, ``seed`` being one of them, so that the
cases of a grid are independent of one another.
"""

from __future__ import annotations

import hashlib
import inspect
import json
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from crazybilliards.kinetic import equilibrium, force_balance, phase_space
from crazybilliards.kinetic.kinetic_equation.stationary import check_phase_space
from crazybilliards.model import Chain, load
from crazybilliards.model.storage import load_attributes
from crazybilliards.particles import simulate
from crazybilliards.particles.simulation import make_run

JOBS: dict[str, Callable[..., xr.Dataset]] = {
    "simulate": simulate,
    "phase_space": phase_space,
    "equilibrium": equilibrium,
    "force_balance": force_balance,
}

# Settings that no number depends on, and those that are not plain values.
_LEFT_OUT = {
    "chain",
    "start",
    "threads",
    "checkpoint",
    "checkpoint_interval",
    "progress",
    "displacement",
    "velocity_variance",
}

_THEORY_WORK = 3e9  # particle steps that take as long as a theory, roughly


@dataclass(frozen=True, eq=False)
class Case:
    """One job for one chain, checked; equal cases have equal keys.

    Parameters
    ----------
    job
        ``"simulate"``, ``"phase_space"``, ``"equilibrium"`` or ``"force_balance"``.
    chain
        The chain.
    settings
        Arguments of the job, plain values only; those not given take their defaults.

    Raises
    ------
    ValueError
        For a wrong argument, as the job itself would raise it, but before any work.

    Examples
    --------
    >>> case = Case("simulate", Chain(size=3), {"duration": 100})
    >>> case.settings["method"], case == Case("simulate", Chain(size=3), {"duration": 100.0})
    ('event-driven', True)
    """

    job: str
    chain: Chain
    settings: Mapping[str, Any]

    def __post_init__(self) -> None:
        if self.job not in JOBS:
            raise ValueError(f"job must be one of {sorted(JOBS)}, got {self.job!r}")
        defaults = {
            name: parameter.default
            for name, parameter in inspect.signature(JOBS[self.job]).parameters.items()
            if name not in _LEFT_OUT
        }
        for name in self.settings:
            if name not in defaults:
                raise ValueError(f"{self.job} takes any of {sorted(defaults)}, got {name!r}")
        settings = {name: _plain(name, value) for name, value in self.settings.items()}
        object.__setattr__(self, "settings", {**_plain_all(defaults), **settings})
        if self.job == "simulate":
            make_run(self.chain, start=None, **self.settings)
        elif self.job == "phase_space":
            check_phase_space(self.chain, **self.settings)
        else:
            self.chain.require_steady_state()
            if self.chain.restitution != 1:
                raise ValueError(f"{self.job} takes restitution=1, got {self.chain.restitution:g}")

    @property
    def parameters(self) -> dict[str, Any]:
        """All that the result follows from, as JSON can hold it."""
        return {"job": self.job, **_plain_all(self.chain.parameters()), **self.settings}

    @property
    def canonical(self) -> str:
        """The parameters and the package's version as text, the same for equal cases."""
        return json.dumps(self.parameters | {"version": version("crazybilliards")}, sort_keys=True)

    @property
    def key(self) -> str:
        """Hash of the canonical parameters: 20 hexadecimal digits."""
        return hashlib.sha256(self.canonical.encode()).hexdigest()[:20]

    def __hash__(self) -> int:
        return hash(self.canonical)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.canonical == other.canonical

    @property
    def work(self) -> float:
        """Particle steps to do, to put long cases first and to foresee how long all take."""
        if self.job != "simulate":
            return _THEORY_WORK
        run = make_run(self.chain, start=None, **self.settings)
        return float(run.schedule.steps) * self.chain.size * run.replicas

    def file(self, folder: Path) -> Path:
        """Return the name of its file in ``folder``."""
        return folder / f"{self.key}.nc"

    def check_file(self, folder: Path) -> None:
        """Raise if its file in ``folder`` is missing, damaged or of another case."""
        if load_attributes(self.file(folder)).get("case") != self.canonical:
            raise ValueError(f"{self.file(folder)}: not the case that its name says")

    def load(self, folder: Path) -> xr.Dataset:
        """Read its result from ``folder``; raises as :meth:`check_file`."""
        self.check_file(folder)
        result = load(self.file(folder))
        assert isinstance(result, xr.Dataset)
        return result


def compute(case: Case, canonical: str) -> bytes:
    """Carry out a case and return its result as a NetCDF file; runs in a worker, one thread.

    ``canonical`` is what the sender takes the case to be: a worker with another version of the
    package would give the result of another case under the same name.
    """
    if case.canonical != canonical:
        raise ValueError(f"the worker runs another version, {version('crazybilliards')}")
    begin = time.perf_counter()
    settings = dict(case.settings)
    if case.job == "simulate":
        text = json.dumps(case.parameters, sort_keys=True)
        own_seed = int(hashlib.sha256(text.encode()).hexdigest()[:15], 16)
        settings |= {"seed": own_seed, "threads": 1, "progress": False}
    # Linear algebra in threads sums in another order, and workers beside it would only wait.
    with threadpool_limits(1):
        result = JOBS[case.job](case.chain, **settings)
    if result.attrs["status"] == "interrupted":
        raise KeyboardInterrupt
    result.attrs |= {"case": canonical, "seconds": time.perf_counter() - begin}
    # On a dask worker xarray would lock the file all over the cluster; these are bytes in memory.
    alone = sys.modules["dask"].config.set(scheduler="sync") if "dask" in sys.modules else None
    with alone or nullcontext():
        return bytes(result.to_netcdf(engine="h5netcdf"))


def _plain_all(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: _plain(name, value) for name, value in values.items()}


def _plain(name: str, value: Any) -> Any:
    """Return a value as JSON writes it, 5, 5.0 and numpy's 5 all the same way."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple | range):
        return [_plain(name, each) for each in value]
    if isinstance(value, float):
        return int(value) if value.is_integer() and abs(value) < 1e15 else value
    if value is None or isinstance(value, str | int):
        return value
    raise ValueError(f"{name} must be a plain value, got {value!r}")
