"""One case: a job, a chain and the settings of the job, with a file whose name follows from them.

The name is a hash of the job and of the parameters that differ from their defaults. It therefore
stays the same when the package gets a new parameter. The random numbers of a case follow from the
same parameters, ``seed`` among them, so the cases of a grid are independent of each other.

The file holds all parameters and the fingerprint of the source code that computed it. A file of
others does not count as the case's result.
"""

import hashlib
import inspect
import json
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from crazybilliards.comparison.stationary_theories import THEORIES
from crazybilliards.kinetic.accuracy import UnmeasuredWarning
from crazybilliards.model import Chain, DivergedError, DivergedWarning, load
from crazybilliards.model.checks import check_arguments, check_choice
from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.storage import load_attributes, netcdf
from crazybilliards.particles import ShortRunWarning, simulate
from crazybilliards.particles.simulation import make_run

JOBS: dict[str, Callable[..., xr.Dataset]] = {"simulate": simulate}
JOBS |= {name: theory.solve for name, theory in THEORIES.items()}
# Arguments that do not change the numbers, and arguments that are not plain values.
_NO_SETTINGS = {"chain", "start", "threads", "checkpoint", "checkpoint_interval", "progress"}
# Computed together with that code, so that an edit during an interactive session changes nothing.
_SOURCES = {
    job: room_fingerprint("model", "kinetic" if job in THEORIES else "particles") for job in JOBS
}


@dataclass(frozen=True)
class Case:
    """One checked job for one chain; equal cases have one file.

    Parameters
    ----------
    job
        ``"simulate"``, or the name of a theory, ``"steady_state"`` for example.
    chain
        The chain.
    settings
        Arguments of the job, plain values only; the others have their defaults.

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
        defaults = default_settings(check_choice("job", self.job, sorted(JOBS)))
        check_arguments(self.job, self.settings, sorted(defaults))
        object.__setattr__(self, "settings", defaults | _plain_all(self.settings))
        _ = self.too_short

    @cached_property
    def too_short(self) -> str:
        """In what a simulation is too short for the memory of the chain, or nothing; checks all."""
        if self.job == "simulate":
            return make_run(self.chain, start=None, **self.settings).too_short
        THEORIES[self.job].check(self.chain, **self.settings)
        return ""

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

    @property
    def source(self) -> str:
        """Fingerprint of the source code that its result depends on."""
        return _SOURCES[self.job]

    @cached_property
    def canonical(self) -> str:
        """All parameters as text, the same for equal cases."""
        return json.dumps(self.arguments, sort_keys=True)

    @cached_property
    def _digest(self) -> str:
        """Hash of the job and of the changed parameters: its name, and its random numbers."""
        text = json.dumps({"job": self.job, **self.changed}, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def __hash__(self) -> int:
        return hash(self.canonical)

    def file(self, folder: Path) -> Path:
        """Return the name of its file in ``folder``."""
        return folder / f"{self._digest[:20]}.nc"

    def is_in(self, folder: Path, *, keep_old: bool = False) -> bool:
        """Return whether ``folder`` holds its result; ``keep_old``: also of other source code."""
        try:
            attributes = load_attributes(self.file(folder))
        except (FileNotFoundError, ValueError):
            return False
        same = keep_old or attributes.get("source_fingerprint") == self.source
        return same and stored_parameters(attributes) == self.arguments

    def load(self, folder: Path) -> xr.Dataset:
        """Read its result from ``folder``; raises as :func:`crazybilliards.model.load`."""
        result = load(self.file(folder))
        if stored_parameters(result.attrs) != self.arguments:
            raise ValueError(f"{self.file(folder)}: not the case that its name says")
        assert isinstance(result, xr.Dataset)
        return result


def compute(case: Case, source: str, threads: int = 1) -> bytes:
    """Compute a case and return its result as a NetCDF file.

    ``source`` is the fingerprint of the sender's source code. A worker with another one refuses.
    """
    if source != case.source:
        raise ValueError("the worker runs other source code of crazybilliards")
    how = dict(case.settings)
    if case.job == "simulate":
        how |= {"seed": int(case._digest[20:35], 16), "threads": threads, "progress": False}
    # Linear algebra in threads sums in another order, and it would make other workers wait.
    with threadpool_limits(1), warnings.catch_warnings():
        # Said by the result, of the whole sweep, and by the status.
        for told in (UnmeasuredWarning, ShortRunWarning, DivergedWarning):
            warnings.simplefilter("ignore", told)
        try:
            result = JOBS[case.job](case.chain, **how)
        except DivergedError as error:
            result = error.result
    if result.attrs["status"] == "interrupted":
        raise KeyboardInterrupt
    result.attrs |= {"case": case.canonical, "source_fingerprint": source}
    return netcdf(result)


def stored_parameters(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Return the parameters of the case that a file holds, by its attributes; {} if it holds none.

    Parameters that did not exist when it was written are at their defaults.
    """
    try:
        stored = dict(json.loads(attributes["case"]))
        return _defaults(stored["job"]) | stored
    except (KeyError, TypeError, ValueError):
        return {}


@cache
def default_settings(job: str) -> dict[str, Any]:
    """Return the arguments of a job that are settings, with their defaults."""
    arguments = inspect.signature(JOBS[job]).parameters.values()
    return _plain_all({a.name: a.default for a in arguments if a.name not in _NO_SETTINGS})


@cache
def _defaults(job: str) -> dict[str, Any]:
    return {"job": job, **_plain_all(Chain().parameters()), **default_settings(job)}


def _plain_all(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: plain(name, value) for name, value in values.items()}


def plain(name: str, value: Any) -> Any:
    """Return a value in a form for JSON, the same for 5, 5.0 and numpy's 5."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple | range):
        return [plain(name, item) for item in value]
    if isinstance(value, float):
        return int(value) if value.is_integer() and abs(value) < 1e15 else value
    if value is None or isinstance(value, str | int):
        return value
    raise ValueError(f"{name} must be a plain value, got {value!r}")
