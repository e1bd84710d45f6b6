"""One case: a job, a chain and the settings of the job, with a file whose name follows from them.

The name is a hash of the job and of the parameters that differ from their defaults. It therefore
stays the same when the package gets a new parameter. The random numbers of a case follow from the
same parameters, ``seed`` among them, so the cases of a grid are independent of each other.

The file holds all parameters, defaults included, and the fingerprint of the source code that
computed it. A file of other parameters or of other source code does not count as the case's result.
"""

from __future__ import annotations

import hashlib
import json
import sys
import time
import warnings
from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass, field
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from threadpoolctl import ThreadpoolController

from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.kinetic.accuracy import UnmeasuredWarning
from crazybilliards.model import Chain, load
from crazybilliards.model.checks import check_arguments, check_choice
from crazybilliards.model.progress import silent
from crazybilliards.model.storage import load_attributes, small_netcdf
from crazybilliards.particles import ShortRunWarning


class OutdatedError(ValueError):
    """A file was computed by other source code than the current code."""


@dataclass(frozen=True, eq=False)
class Case:
    """One checked job for one chain; equal cases have equal keys.

    Parameters
    ----------
    job
        ``"simulate"``, ``"simulate_limit"`` or the name of a theory in
        :mod:`crazybilliards.comparison.stationary_theories`.
    chain
        The chain.
    settings
        Arguments of the job, plain values only; the others have their defaults.

    Attributes
    ----------
    work
        Number of particle steps, to put short cases first and to estimate the total time.

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
    work: float = field(init=False)

    def __post_init__(self) -> None:
        job = JOBS[check_choice("job", self.job, sorted(JOBS))]
        check_arguments(self.job, self.settings, sorted(job.settings))
        settings = {name: plain(name, value) for name, value in self.settings.items()}
        object.__setattr__(self, "settings", {**_default_settings(self.job), **settings})
        object.__setattr__(self, "work", job.work(self.chain, **self.settings))

    @property
    def arguments(self) -> dict[str, Any]:
        """Everything that determines the result, in a form for JSON."""
        return {"job": self.job, **_plain_all(self.chain.parameters()), **self.settings}

    @property
    def changed(self) -> dict[str, Any]:
        """The parameters that differ from their defaults."""
        defaults = _defaults(self.job)
        return {name: value for name, value in self.arguments.items() if value != defaults[name]}

    @property
    def title(self) -> str:
        """The job and what is not the default, but for the random numbers and the observers."""
        changed = [
            f"{name} {value}"
            for name, value in self.changed.items()
            if name not in ("job", "seed", "observe")
        ]
        return f"{self.job}: {', '.join(changed) or 'defaults'}"

    @cached_property
    def canonical(self) -> str:
        """All parameters as text, the same for equal cases."""
        return json.dumps(self.arguments, sort_keys=True)

    @cached_property
    def _digest(self) -> str:
        """Hash of the job and of the changed parameters."""
        text = json.dumps({"job": self.job, **self.changed}, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def key(self) -> str:
        """Name of the case, 20 hexadecimal digits: a hash of its job and changed parameters."""
        return self._digest[:20]

    @property
    def own_seed(self) -> int:
        """The seed of its random numbers, which follows from the same parameters as its key."""
        return int(self._digest[20:35], 16)

    def __hash__(self) -> int:
        return hash(self.canonical)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.canonical == other.canonical

    @property
    def too_short(self) -> str:
        """In what a simulation is too short for the memory of the chain, or nothing."""
        return JOBS[self.job].too_short(self.chain, **self.settings)

    @property
    def source(self) -> str:
        """Fingerprint of the source code that its result depends on."""
        return JOBS[self.job].source

    def file(self, folder: Path) -> Path:
        """Return the name of its file in ``folder``."""
        return folder / f"{self.key}.nc"

    def check_file(self, folder: Path, *, keep_old: bool = False) -> None:
        """Raise unless ``folder`` holds its result.

        ``keep_old`` accepts a result that other source code of the package computed.

        Raises
        ------
        FileNotFoundError
            If there is no file.
        OutdatedError
            If other source code of the package computed the file; it is a ValueError.
        ValueError
            If the file is damaged or holds another case.
        """
        path = self.file(folder)
        self._check(path, load_attributes(path), keep_old)

    def _check(self, path: Path, attributes: Mapping[Any, Any], keep_old: bool) -> None:
        if stored_parameters(attributes) != self.arguments:
            raise ValueError(f"{path}: not the case that its name says")
        if not keep_old and attributes.get("source_fingerprint") != self.source:
            raise OutdatedError(
                f"{path}: computed by other source code of crazybilliards; compute it anew, or "
                "take it as it is with keep_old=True"
            )

    def load(self, folder: Path, *, keep_old: bool = False) -> xr.Dataset:
        """Read its result from ``folder``; arguments and errors are those of :meth:`check_file`."""
        path = self.file(folder)
        result = load(path)
        self._check(path, result.attrs, keep_old)
        assert isinstance(result, xr.Dataset)
        return result


def compute(case: Case, source: str, threads: int = 1) -> bytes:
    """Compute a case in a worker, and return its result as a NetCDF file.

    ``source`` is the fingerprint of the sender's source code. A worker with other source code
    refuses, because its result would count as one of the sender's code. A simulation uses
    ``threads``, on which no number depends.
    """
    if case.source != source:
        raise ValueError(
            f"the worker runs other source code of crazybilliards (version {_version()})"
        )
    begin = time.perf_counter()
    own: dict[str, int] = {"seed": case.own_seed} if "seed" in case.settings else {}
    own |= {"threads": threads} if case.job.startswith("simulate") else {}
    # Linear algebra in threads sums in another order, and it would make other workers wait.
    with _libraries().limit(limits=1), warnings.catch_warnings(), silent():
        # The result states that its error is unknown; a line per process would not say of which.
        warnings.simplefilter("ignore", UnmeasuredWarning)
        warnings.simplefilter("ignore", ShortRunWarning)  # said of the whole sweep
        result = JOBS[case.job].function(case.chain, **{**case.settings, **own})
    if result.attrs["status"] == "interrupted":
        raise KeyboardInterrupt
    result.attrs |= {
        "case": case.canonical,
        "source_fingerprint": source,
        "package_version": _version(),
        "seconds": time.perf_counter() - begin,
    }
    # On a dask worker xarray would use a lock of the whole cluster; these bytes need no lock.
    alone = sys.modules["dask"].config.set(scheduler="sync") if "dask" in sys.modules else None
    with alone or nullcontext():
        return small_netcdf(result)


@cache
def _libraries() -> ThreadpoolController:
    """Find the linear-algebra libraries; the jobs, which are imported, have loaded all of them."""
    return ThreadpoolController()


@cache
def _version() -> str:
    return version("crazybilliards")


def stored_parameters(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Return the parameters of the case that a file holds, by its attributes; {} if it holds none.

    Parameters that the file lacks, because they did not exist when it was written, are at their
    defaults.
    """
    try:
        stored = dict(json.loads(attributes["case"]))
        defaults = _defaults(stored["job"])
    except (KeyError, TypeError, ValueError):
        return {}
    return defaults | stored if "size" in stored else {}  # every version has stored the size


@cache
def _defaults(job: str) -> dict[str, Any]:
    """Return the default parameters of a case."""
    return {"job": job, **_plain_all(Chain().parameters()), **_default_settings(job)}


@cache
def _default_settings(job: str) -> dict[str, Any]:
    return _plain_all(JOBS[job].settings)


def _plain_all(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: plain(name, value) for name, value in values.items()}


def plain(name: str, value: Any) -> Any:
    """Return a value in a form for JSON, the same for 5, 5.0 and numpy's 5."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple | range):
        return [plain(name, each) for each in value]
    if isinstance(value, float):
        return int(value) if value.is_integer() and abs(value) < 1e15 else value
    if value is None or isinstance(value, str | int):
        return value
    raise ValueError(f"{name} must be a plain value, got {value!r}")
