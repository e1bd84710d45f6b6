"""Sweeps: a grid over any parameters, described by a TOML file, read back as one Dataset."""

import itertools
import json
import math
import os
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any

import pandas as pd
import xarray as xr

from crazybilliards.comparison.sweeps.case import (
    JOBS,
    Case,
    default_settings,
    plain,
    stored_parameters,
)
from crazybilliards.model import Chain, load
from crazybilliards.model.checks import as_written, check_arguments, check_path, is_list, shown
from crazybilliards.model.vocabulary import ATTRIBUTES, described, require
from crazybilliards.model.warn import warn_user

_CHAIN = [parameter.name for parameter in fields(Chain)]
_TEXTS = ("status", "provenance", "file")  # are always variables


@dataclass(frozen=True)
class Sweep:
    """A grid of cases. Each case is made and checked when it is needed.

    Parameters
    ----------
    grid
        ``{parameter: values}`` for parameters of the chain and settings of the job: a list, an
        array or a column of pandas. ``numpy.arange(0.1, 0.35, 0.1)`` gives 0.1, 0.2 and 0.3. The
        last parameter varies fastest.
    job
        As in :class:`Case`.
    chain, settings
        Parameters of the chain and settings of the job that are the same for all.

    Raises
    ------
    ValueError
        For an unknown name, or an empty list of values; for a value or a name given twice.
    """

    grid: Mapping[str, Any]
    job: str = "simulate"
    chain: Mapping[str, Any] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        grid = {name: grid_values("grid", name, values) for name, values in self.grid.items()}
        object.__setattr__(self, "grid", grid)
        if twice := grid.keys() & {*self.chain, *self.settings}:
            raise ValueError(f"{min(twice)} is given twice: in the grid, and the same for all")
        next(iter(self))  # checks all names

    def __len__(self) -> int:
        return math.prod(map(len, self.grid.values()))

    def __iter__(self) -> Iterator[Case]:
        settings = [*default_settings(self.job)] if self.job in JOBS else []
        check_arguments("[grid]", self.grid, [*_CHAIN, *settings])
        for values in itertools.product(*self.grid.values()):
            point = dict(zip(self.grid, values, strict=True))
            chain = {**self.chain, **{name: point.pop(name) for name in _CHAIN if name in point}}
            yield Case(self.job, Chain().replace(**chain), {**self.settings, **point})

    def cases(self) -> list[Case]:
        """Return all cases; raises a ValueError for the first one that is wrong."""
        return list(self)


def grid_values(owner: str, name: str, values: Any) -> list[Any]:
    """Return the values of a parameter as a person writes them, or raise a ValueError."""
    if not is_list(values) or isinstance(values, Mapping | set) or len(values) == 0:
        raise ValueError(f"{owner}: {name} must be a list of values, got {shown(values)}")
    written = [as_written(value) for value in values]
    if len({json.dumps(plain(name, value)) for value in written}) < len(written):
        raise ValueError(f"{owner}: {name} holds a value twice, got {shown(values)}")
    return written


def read_sweep(path: str | os.PathLike[str]) -> Sweep:
    """Read a sweep from a TOML file with the tables grid, chain and that of the job."""
    path = check_path("path", path)
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError(f"{path}: not a TOML file: {error}") from error
    check_arguments(f"{path}", tables, ["grid", "chain", *JOBS])
    grid, chain = tables.pop("grid", {}), tables.pop("chain", {})
    job, settings = tables.popitem() if tables else ("simulate", {})
    if tables:
        raise ValueError(f"{path}: one job a sweep, got {job} and {', '.join(tables)}")
    return Sweep(grid, job, chain, settings)


def load_sweep(folder: str | os.PathLike[str]) -> xr.Dataset:
    """Read all cases of a folder into one Dataset over the parameters in which they differ.

    A parameter that did not exist when a file was written has its default. Warnings say if
    different source code computed the cases, and if chains diverged.

    Returns
    -------
    xarray.Dataset
        Every variable has a dimension for each parameter with more than one value, in front of
        its own dimensions. Missing cases have NaN and an empty ``status``; shorter chains are
        padded with NaN. Coordinates that depend on the case, such as x or the mean position,
        have those dimensions too, and the dimension of x is then ``x_index``. The attributes of a
        case are variables without own dimensions: every number (``end_time``, ``residual``, ...;
        NaN where a case has none), ``status``, ``provenance`` and ``file``, the name of its file,
        and every other text that differs between the cases. The attribute ``parameters`` holds the
        common parameters as JSON.

    Raises
    ------
    ValueError
        If a file is damaged, if there are no files, if they are not cases of one job, if two files
        hold the same case, or if runs with different observers do not fit together.
    """
    paths = sorted(check_path("folder", folder).glob("[!.]*.nc"))  # hidden files are no results
    if not paths:
        raise ValueError(f"{folder}: holds no case of a sweep")
    results = []
    for path in paths:
        result = load(path)
        if not stored_parameters(result.attrs) or isinstance(result, xr.DataTree):
            raise ValueError(f"{path}: not a case of a sweep")
        results.append(result.assign_attrs(file=path.name))
    points = [stored_parameters(result.attrs) for result in results]
    if len({point["job"] for point in points}) > 1:
        raise ValueError(f"{folder}: holds cases of different jobs")
    if len({json.dumps(point, sort_keys=True) for point in points}) < len(points):
        raise ValueError(f"{folder}: two files hold the same case; remove one")
    if unknown := {name for point in points for name in point.keys() ^ points[0].keys()}:
        raise ValueError(f"{folder}: not all cases have the parameter {min(unknown)}")
    if len({result.attrs.get("source_fingerprint") for result in results}) > 1:
        warn_user(f"{folder}: different source code computed these cases")
    table = _varied(points)
    names = [str(name) for name in table]
    joined = xr.concat(
        _alike(results),
        "case",
        data_vars="all",
        coords="different",
        compat="equals",
        join="outer",
        combine_attrs="drop_conflicts",
    )
    joined = _with_attributes(joined, pd.DataFrame([result.attrs for result in results]), names)
    if names:
        index = xr.Coordinates.from_pandas_multiindex(pd.MultiIndex.from_frame(table), "case")
        joined = joined.assign_coords(index).unstack("case").transpose(*names, ...)
        for name, variable in joined.data_vars.items():
            if variable.dtype == object:  # the texts of missing cases
                joined[name] = variable.fillna("")
    else:
        joined = joined.squeeze("case")
    require(joined, (), str(folder))
    fixed = {name: value for name, value in points[0].items() if name not in names}
    return joined.assign_attrs(parameters=json.dumps(fixed, sort_keys=True))


def _varied(points: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return a column for each parameter that differs between the cases, those of a chain first."""
    table = pd.DataFrame(
        # A list, which cannot be a coordinate, becomes text.
        {k: json.dumps(v) if isinstance(v, list) else as_written(v) for k, v in point.items()}
        for point in points
    )
    names = [*_CHAIN, *(name for name in table if name not in _CHAIN)]
    return table[[name for name in names if table[name].nunique(dropna=False) > 1]]


def _with_attributes(
    joined: xr.Dataset, attributes: pd.DataFrame, names: Sequence[str]
) -> xr.Dataset:
    """Turn the attributes of single cases into variables along ``case``.

    ``case`` repeats the parameters, which are coordinates.
    """
    joined.attrs.pop("case", None)
    for label, column in attributes.drop(columns=["case", *names], errors="ignore").items():
        name = str(label)
        if pd.api.types.is_numeric_dtype(column):
            meaning, unit = ATTRIBUTES.get(name, (name.replace("_", " "), "1"))
            joined[name] = ("case", column.to_numpy(float), described(meaning, unit))
        elif name in _TEXTS or column.map(str).nunique() > 1:
            joined[name] = ("case", column.fillna("").map(str).to_numpy(object))
        else:
            continue
        joined.attrs.pop(name, None)
    return joined


def _alike(results: Sequence[xr.Dataset]) -> Sequence[xr.Dataset]:
    """Make other dimensions than the particle fit; differing coordinates become numbers."""
    dimensions = {str(name) for result in results for name in result.dims}
    for dimension in sorted(dimensions - {"particle"}):
        values = [result[dimension] for result in results if dimension in result.dims]
        if len(values) < len(results) or not all(value.equals(values[0]) for value in values):
            results = [_numbered(result, dimension) for result in results]
    return results


def _numbered(result: xr.Dataset, dimension: str) -> xr.Dataset:
    if dimension not in result.dims:
        return result
    places = range(result.sizes[dimension])
    if dimension not in result.coords:
        return result.assign_coords({dimension: places})
    index = f"{dimension}_index"
    result = result.drop_indexes(dimension).rename_dims({dimension: index})
    return result.assign_coords({index: places})
