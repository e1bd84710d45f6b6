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

import json
import math
import numbers
import os
import tomllib
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from crazybilliards.comparison.sweeps.case import Case, plain, stored_parameters
from crazybilliards.comparison.sweeps.index import CHAIN, scalar, varied
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain, load
from crazybilliards.model.calls import public, warn_user
from crazybilliards.model.checks import (
    as_written,
    check_arguments,
    check_choice,
    check_path,
    got,
    is_list,
    shown,
)
from crazybilliards.model.vocabulary import ATTRIBUTES, described

_MOST_CASES = 1_000_000
_TEXTS = ("status", "provenance", "file")  # are always variables


@public
@dataclass(frozen=True)
class Sweep:
    """A grid of cases. Each case is made and checked when it is needed.

    Parameters
    ----------
    grid
        ``{parameter: values}`` for parameters of the chain and settings of the job: a list, an
        array or a column of pandas. ``numpy.arange(0.1, 0.35, 0.1)`` gives 0.1, 0.2 and 0.3.
    job
        As in :class:`Case`.
    chain, settings
        Parameters of the chain and settings of the job that are the same for all.

    Raises
    ------
    ValueError
        For an unknown name, for repeated values, for an empty grid, for more than a million cases.
    """

    grid: Mapping[str, Any]
    job: str = "simulate"
    chain: Mapping[str, Any] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    # Of the first case: the common parameters alone may be no chain.
    _chain: Chain = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for name in ("grid", "chain", "settings"):
            if not isinstance(given := getattr(self, name), Mapping):
                raise ValueError(f"{name} must be a dict, as {{'size': ...}}, got {shown(given)}")
        settings = list(JOBS[check_choice("job", self.job, sorted(JOBS))].settings)
        check_arguments("[grid]", self.grid, [*CHAIN, *settings])
        check_arguments(f"[{self.job}]", self.settings, settings)
        grid = {name: _values(name, values) for name, values in self.grid.items()}
        object.__setattr__(self, "grid", grid)
        for name in grid:
            if name in self.chain or name in self.settings:
                raise ValueError(f"{name} is given twice: in the grid, and the same for all")
        if len(self) > _MOST_CASES:
            raise ValueError(f"the grid has {len(self)} cases, more than {_MOST_CASES}")
        first = dict(self.chain) | {name: grid[name][0] for name in grid if name in CHAIN}
        object.__setattr__(self, "_chain", Chain().replace(**first))

    def __len__(self) -> int:
        return math.prod(map(len, self.grid.values()))

    def __iter__(self) -> Iterator[Case]:
        return map(self.case, range(len(self)))

    def case(self, number: int) -> Case:
        """Return one case, counted from 0, or raise a ValueError if it is wrong.

        The last parameter of the grid varies fastest.
        """
        here: dict[str, Any] = {}
        settings = dict(self.settings)
        for name in reversed(list(self.grid)):
            values = self.grid[name]
            number, place = divmod(number, len(values))
            (here if name in CHAIN else settings)[name] = values[place]
        return Case(self.job, self._chain.replace(**here) if here else self._chain, settings)

    def cases(self) -> list[Case]:
        """Return all cases; raises a ValueError for the first one that is wrong."""
        return list(self)


def _values(name: str, given: Any) -> list[Any]:
    """Return the values of a parameter as a person writes them, or raise a ValueError."""
    ordered = is_list(given) and not isinstance(given, Mapping | Set)
    if not ordered or getattr(given, "ndim", 1) != 1 or len(given) == 0:
        raise ValueError(f"grid: {name} must be a list of values, got {shown(given)}")
    listed = np.asarray(given) if hasattr(given, "dtype") else given
    values = [as_written(each) for each in listed]
    found = [scalar(plain(name, each)) for each in values]
    if twice := [each for place, each in enumerate(found) if each in found[:place]]:
        raise ValueError(f"grid: {name} holds {shown(twice[0])} twice")
    return values


def read_sweep(path: str | os.PathLike[str]) -> Sweep:
    """Read a sweep from a TOML file with the tables grid, chain and that of the job.

    Raise a ValueError if the file is not TOML, or a table is unknown or not a table.
    """
    path = check_path("path", path)
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except IsADirectoryError as error:
        raise ValueError(f"{path}: a folder, not a TOML file") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError(f"{path}: not a TOML file: {error}") from error
    for name, table in tables.items():
        if name not in (known := ("grid", "chain", *JOBS)):
            raise ValueError(f"{path}: the tables can be any of {got(name, known)}")
        if not isinstance(table, dict):
            raise ValueError(f"{path}: {name} must be a table, got {table!r}")
    jobs = sorted(set(tables) & set(JOBS))
    if len(jobs) > 1:
        raise ValueError(f"{path}: one job a sweep, got {' and '.join(jobs)}")
    job = jobs[0] if jobs else "simulate"
    return Sweep(tables.get("grid", {}), job, tables.get("chain", {}), tables.get(job, {}))


@public
def load_sweep(folder: str | os.PathLike[str]) -> xr.Dataset:
    """Read all cases of a folder into one Dataset over the parameters in which they differ.

    A parameter that did not exist when a file was written has its default. A warning says if
    different source code computed the cases.

    Returns
    -------
    xarray.Dataset
        Every variable has a dimension for each parameter with more than one value, in front of
        its own dimensions. Missing cases have NaN and an empty ``status``; shorter chains are
        padded with NaN. Coordinates that depend on the case, such as x or the mean position,
        have those dimensions too, and the dimension of x is then ``x_index``. The attributes that
        belong to a case are variables without own dimensions: every number (``end_time``,
        ``time_step_error``, ``mesh_error``, ...; NaN where a case has none), ``status``,
        ``provenance`` and ``file``, the name of its file, and every other text that differs between
        the cases. The attribute ``parameters`` holds the common parameters as JSON.

    Raises
    ------
    ValueError
        If a file is damaged, if there are no files, if they are not cases of one job, if two files
        hold the same case, or if runs with different observers do not fit together.
    """
    place = check_path("folder", folder)
    paths = sorted(place.glob("*.nc"))
    if not paths:
        wanted = "load_sweep takes the folder that crazybilliards sweep --output names"
        if not place.is_dir():
            found = "a file, not a folder" if place.exists() else "there is no such folder"
            raise ValueError(f"{folder}: {found}; {wanted}")
        raise ValueError(f"{folder}: holds no case of a sweep; {wanted}")
    points, results = zip(*map(_read_case, paths), strict=True)
    _check_points(paths, points)
    if len({result.attrs.get("source_fingerprint") for result in results}) > 1:
        warn_user(f"{folder}: different source code computed these cases")
    table = varied(points)
    names = [str(name) for name in table]
    fixed = {name: value for name, value in points[0].items() if name not in names}
    results = _with_attributes(results, leave=names)
    texts = [str(name) for name in results[0].data_vars if results[0][name].dtype == object]
    joined = _joined(paths, results)
    if names:
        index = pd.MultiIndex.from_frame(table)
        coordinates = xr.Coordinates.from_pandas_multiindex(index, "case")
        joined = joined.assign_coords(coordinates).unstack("case")
        joined = joined.transpose(*names, ...)
        for name in texts:  # of missing cases
            joined[name] = joined[name].fillna("")
    else:
        joined = joined.squeeze("case")
    return joined.assign_attrs(parameters=json.dumps(fixed, sort_keys=True))


def _read_case(path: Path) -> tuple[dict[str, Any], xr.Dataset]:
    """Return the parameters of the case in a file and its result, or raise if there is none."""
    result = load(path)
    point = stored_parameters(result.attrs)
    complete = point and {"status", "provenance"} <= result.attrs.keys()
    if not complete or isinstance(result, xr.DataTree):
        raise ValueError(f"{path}: not a case of a sweep")
    return point, result.assign_attrs(file=path.name)


def _check_points(paths: Sequence[Path], points: Sequence[dict[str, Any]]) -> None:
    """Raise unless these are different cases of one job, with the same names of parameters."""
    if len({point["job"] for point in points}) > 1:
        raise ValueError(f"{paths[0].parent}: holds cases of different jobs")
    first: dict[str, Path] = {}
    for path, point in zip(paths, points, strict=True):
        unknown = point.keys() ^ points[0].keys()
        if unknown:
            raise ValueError(
                f"{paths[0]} and {path}: only one of them has {min(unknown)!r}, a parameter that "
                "this version of crazybilliards does not know"
            )
        canonical = json.dumps(point, sort_keys=True)
        if canonical in first:
            raise ValueError(f"{first[canonical]} and {path}: hold the same case; remove one")
        first[canonical] = path


def _joined(paths: Sequence[Path], results: Sequence[xr.Dataset]) -> xr.Dataset:
    """Join results along ``case``; a ValueError says which cases do not have the same variables."""
    how: dict[str, Any] = {"join": "outer", "compat": "equals", "combine_attrs": "drop_conflicts"}
    try:
        return xr.concat(_alike(results), "case", data_vars="all", coords="different", **how)
    except ValueError as error:
        for path, each in zip(paths, results, strict=True):
            if different := each.variables.keys() ^ results[0].variables.keys():
                names = ", ".join(sorted(map(str, different)))
                raise ValueError(
                    f"{paths[0]} and {path}: only one has {names}; observe= must be the same"
                ) from error
        raise


def _with_attributes(results: Sequence[xr.Dataset], leave: Sequence[str]) -> list[xr.Dataset]:
    """Turn the attributes of single cases into variables, except those named in ``leave``.

    ``case`` repeats the parameters, which are coordinates.
    """
    made = list(results)
    for name in sorted({name for each in results for name in each.attrs} - {"case", *leave}):
        values = [each.attrs.get(name) for each in results]
        given = [value for value in values if value is not None]
        number = all(isinstance(value, numbers.Real) for value in given)
        differs = len(given) < len(values) or len({str(value) for value in given}) > 1
        if not (number or differs or name in _TEXTS):
            continue
        meaning, unit = ATTRIBUTES.get(name, (name.replace("_", " "), "1"))
        about = described(meaning, unit) if number else {}
        for place, (dataset, value) in enumerate(zip(made, values, strict=True)):
            if number:
                each = np.array(math.nan if value is None else value, dtype=float)
            else:
                each = np.array("" if value is None else str(value), dtype=object)
            made[place] = dataset.assign({name: ((), each, about)})
            made[place].attrs.pop(name, None)
    return made


def _alike(results: Sequence[xr.Dataset]) -> Sequence[xr.Dataset]:
    """Make other dimensions than the particle fit; differing coordinates become numbers."""
    for dimension in sorted({str(name) for each in results for name in each.dims} - {"particle"}):
        values = [each[dimension] for each in results if dimension in each.dims]
        if len(values) < len(results) or not all(each.equals(values[0]) for each in values):
            results = [
                _numbered(each, dimension) if dimension in each.dims else each for each in results
            ]
    return results


def _numbered(result: xr.Dataset, dimension: str) -> xr.Dataset:
    places = range(result.sizes[dimension])
    if dimension not in result.coords:
        return result.assign_coords({dimension: places})
    values = result[dimension]
    index = f"{dimension}_index"
    result = result.drop_vars(dimension).rename({dimension: index})
    return result.assign_coords({index: places, dimension: (index, values.values, values.attrs)})
