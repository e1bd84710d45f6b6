"""Sweeps: a grid over any parameters, described by a TOML file, read back as one Dataset.

[grid]                            # every combination of these
size = [30, 100, 300]
restitution = [0.0, 0.5, 0.95]
seed = [1, 2]

[chain]                           # the same for all
damping = 2.0

[simulate]                        # the job, and its settings the same for all
duration = 1000
observe = ["widths"]
"""

from __future__ import annotations

import itertools
import json
import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import pandas as pd
import xarray as xr

from crazybilliards.comparison.sweeps.case import JOBS, Case
from crazybilliards.model import Chain, load

_MOST_CASES = 1_000_000
_CHAIN = [field.name for field in fields(Chain)]


@dataclass(frozen=True)
class Sweep:
    """A grid of cases.

    Parameters
    ----------
    grid
        ``{parameter: values}``, parameters of the chain or settings of the job, in any mixture.
    job
        As in :class:`Case`.
    chain, settings
        Parameters of the chain and settings of the job that are the same for all.
    """

    grid: Mapping[str, Sequence[Any]]
    job: str
    chain: Mapping[str, Any]
    settings: Mapping[str, Any]

    def cases(self) -> list[Case]:
        """Return every case of the grid, all of them checked.

        Raises
        ------
        ValueError
            For the first case that is wrong, for values that come twice, for an empty grid.
        """
        for name, values in self.grid.items():
            if not isinstance(values, list | tuple) or not values:
                raise ValueError(f"grid: {name} must be a list of values, got {values!r}")
            if name in self.chain or name in self.settings:
                raise ValueError(f"{name} is given twice: in the grid, and the same for all")
        number = math.prod(map(len, self.grid.values()))
        if number > _MOST_CASES:
            raise ValueError(f"the grid has {number} cases, more than {_MOST_CASES}")
        cases = [
            self._case(dict(zip(self.grid, values, strict=True)))
            for values in itertools.product(*self.grid.values())
        ]
        if len(set(cases)) < len(cases):
            raise ValueError("the grid holds a value twice")
        return cases

    def _case(self, point: dict[str, Any]) -> Case:
        here = {name: value for name, value in point.items() if name in _CHAIN}
        settings = {name: value for name, value in point.items() if name not in _CHAIN}
        chain = Chain().replace(**self.chain, **here)
        return Case(self.job, chain, {**self.settings, **settings})


def read_sweep(path: Path) -> Sweep:
    """Read a sweep from a TOML file with the tables grid, chain and that of the job.

    Raises
    ------
    ValueError
        If the file is not TOML, or a table is missing, unknown or not a table.
    """
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except IsADirectoryError as error:
        raise ValueError(f"{path}: a folder, not a TOML file") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError(f"{path}: not a TOML file: {error}") from error
    for name, table in tables.items():
        if name not in {"grid", "chain", *JOBS}:
            raise ValueError(f"{path}: has tables [grid], [chain] and a job's, got {name!r}")
        if not isinstance(table, dict):
            raise ValueError(f"{path}: {name} must be a table, got {table!r}")
    jobs = sorted(set(tables) & set(JOBS))
    if len(jobs) > 1:
        raise ValueError(f"{path}: one job a sweep, got {' and '.join(jobs)}")
    job = jobs[0] if jobs else "simulate"
    return Sweep(tables.get("grid", {}), job, tables.get("chain", {}), tables.get(job, {}))


def load_sweep(folder: Path) -> xr.Dataset:
    """Read all cases of a folder into one Dataset over the parameters in which they differ.

    Returns
    -------
    xarray.Dataset
        Every variable has a dimension for each parameter that takes more than one value, in front
        of its own. Where no case was computed, or one has fewer particles, numbers are NaN and
        ``status`` is empty. Coordinates that depend on the case, such as x or the mean position,
        are over those dimensions too; the dimension of x is then ``x_index``. ``status``,
        ``end_time`` and ``provenance`` are variables. Parameters that are the same for all stand
        in the attribute ``parameters``, as JSON.

    Raises
    ------
    ValueError
        If a file is damaged, or there are none, or they are not cases of a sweep.
    """
    runs: list[Any] = []
    points: list[dict[str, Any]] = []
    for path in sorted(Path(folder).glob("*.nc")):
        run = load(path)
        points.append(_point(path, run))
        runs.append(run)
    if not runs:
        raise ValueError(f"{folder}: holds no case of a sweep")
    if len({point["job"] for point in points}) > 1:
        raise ValueError(f"{folder}: holds cases of different jobs")
    table = pd.DataFrame([{k: _scalar(v) for k, v in point.items()} for point in points])
    names = [*_CHAIN, *(name for name in points[0] if name not in _CHAIN)]
    varied = [name for name in names if table[name].nunique(dropna=False) > 1]
    fixed = {name: value for name, value in points[0].items() if name not in varied}
    runs = _alike([_with_status(run) for run in runs])
    joined = xr.concat(
        runs,
        dim="case",
        join="outer",
        data_vars="all",
        coords="different",
        compat="equals",
        combine_attrs="drop_conflicts",
    )
    if varied:
        index = pd.MultiIndex.from_frame(table[varied])
        coordinates = xr.Coordinates.from_pandas_multiindex(index, "case")
        joined = joined.assign_coords(coordinates).unstack("case")
        joined = joined.transpose(*varied, ...)
        joined["status"] = joined["status"].fillna("")
        joined["provenance"] = joined["provenance"].fillna("")
    else:
        joined = joined.squeeze("case")
    return joined.assign_attrs(parameters=json.dumps(fixed, sort_keys=True))


def _point(path: Path, run: xr.Dataset | xr.DataTree) -> dict[str, Any]:
    """Return the parameters of a case, which its file names, or raise if it is none."""
    try:
        point = dict(json.loads(run.attrs["case"]))
    except (KeyError, TypeError, ValueError):
        point = {}
    complete = {"job", *_CHAIN} <= point.keys() and {"status", "provenance"} <= run.attrs.keys()
    if not complete or isinstance(run, xr.DataTree):
        raise ValueError(f"{path}: not a case of a sweep")
    return point


def _scalar(value: Any) -> Any:
    """Return what can stand along a dimension: a list as text."""
    return json.dumps(value) if isinstance(value, list) else value


def _with_status(run: xr.Dataset) -> xr.Dataset:
    """Turn what differs from case to case into variables."""
    names = ("status", "end_time", "provenance")  # a theory has no end_time
    return run.assign({name: ((), run.attrs[name]) for name in names if name in run.attrs})


def _alike(runs: list[xr.Dataset]) -> list[xr.Dataset]:
    """Make dimensions other than the particle fit, by numbering places where the runs differ."""
    for dimension in sorted({str(name) for run in runs for name in run.dims} - {"particle"}):
        values = [run[dimension] for run in runs if dimension in run.dims]
        if len(values) < len(runs) or not all(each.equals(values[0]) for each in values):
            runs = [_numbered(run, dimension) if dimension in run.dims else run for run in runs]
    return runs


def _numbered(run: xr.Dataset, dimension: str) -> xr.Dataset:
    places = range(run.sizes[dimension])
    if dimension not in run.coords:
        return run.assign_coords({dimension: places})
    values = run[dimension]
    index = f"{dimension}_index"
    run = run.drop_vars(dimension).rename({dimension: index})
    return run.assign_coords({index: places, dimension: (index, values.values, values.attrs)})
