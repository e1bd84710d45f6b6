"""The mean of several runs of one chain, with the errors of the mean."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from crazybilliards.model import chain_of
from crazybilliards.model.checks import is_list, shown
from crazybilliards.model.vocabulary import require
from crazybilliards.particles.start import digest, replica_starts

_NO_RUN = "takes results of simulate: other error bars do not fall with the number of results"


def combine(runs: Sequence[xr.Dataset] | xr.Dataset) -> xr.Dataset:
    """Return the mean of runs of one chain with other seeds, as one result.

    A run has the weight w of its number of snapshots, and errors add as independent ones:
    e^2 = sum w_i^2 e_i^2. Of a width, such as ``velocity_width``, the mean square is taken.

    Parameters
    ----------
    runs
        A list of results of ``simulate``, or what ``load_sweep`` returns of a sweep over ``seed``,
        whose cases all have the same weight and may be missing.

    Returns
    -------
    xarray.Dataset
        The variables with error bars, and what ``smooth`` needs of a density. Others, such as
        counts, are left out. ``density_block`` has deviations that give the error of the mean.

    Raises
    ------
    ValueError
        For runs of different chains, or of the same seed, which are no independent ones; if they
        differ in the method, the time step, the time between snapshots, the warm-up or the start,
        unless this is the last snapshot of another one of them; if they are not measured at the
        same particles, positions or times.
    """
    if isinstance(runs, xr.Dataset) and "seed" in runs.dims and "provenance" in runs:
        require(runs, (), "runs")
        for text in filter(None, runs.provenance.values.flat):
            if "snapshots" not in json.loads(text):
                raise ValueError(f"combine {_NO_RUN}")
        if runs.provenance.dims == ("seed",):
            return combine(_cases(runs))
        return _mean(runs, xr.ones_like(runs.seed, dtype=float)).assign(_status(runs))
    if isinstance(runs, xr.Dataset) or not is_list(runs) or len(runs) == 0:
        raise ValueError(
            "runs must be a list of results, or of a sweep over seed what load_sweep returns, got "
            f"{shown(runs)}"
        )
    runs = list[xr.Dataset](runs)
    provenances, origin = _check(runs)
    snapshots = np.array([float(each["snapshots"]) for each in provenances])
    parts = [run[_names(runs[0])] for run in runs]
    names = sorted({*map(str, parts[0].coords)} - {"mean_position"})
    for name in sorted(names, key=lambda each: each not in parts[0].dims):  # axes first
        if not all(np.array_equal(parts[0][name], part[name]) for part in parts):
            raise ValueError(f"runs must have the same {name}")
    joined = xr.concat(parts, "seed", coords="different", compat="equals", join="exact")
    found = _mean(joined, xr.DataArray(snapshots, dims="seed"))
    if all(run.sizes.get("block", 0) > 1 for run in runs):
        found["density_block"] = _blocks(runs, snapshots / snapshots.sum(), found.density)
    common = _common(provenances) | {name: origin.get(name) for name in ("start", "schedule")}
    for name in ("seed", "ended"):  # of a mean they are lists
        common[name] = [one for each in provenances for one in each[name]]
    common["snapshots"] = int(snapshots.sum())
    return found.assign_attrs(
        _common([run.attrs for run in runs]),
        status=next((s for run in runs if (s := run.attrs["status"]) != "completed"), "completed"),
        # NaN, not known, if one of them is.
        time_step_error=float(np.max([run.attrs.get("time_step_error", np.nan) for run in runs])),
        provenance=json.dumps(common, sort_keys=True),
    )


def _common(several: Sequence[dict[str, Any]]) -> dict[str, Any]:
    return {k: v for k, v in several[0].items() if all(v == each.get(k) for each in several)}


def _check(runs: Sequence[xr.Dataset]) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return what is known of the runs and of one without others before it; ValueErrors."""
    first, provenances = runs[0], list[dict[str, Any]]()
    for number, run in enumerate(runs):
        require(run, _names(first) if number else (), f"runs[{number}]")
        require(first, _names(run) if number else (), "runs[0]")
        if "seed" in run.dims:
            raise ValueError("runs must each be one result: combine every sweep first, then these")
        chain, provenance = chain_of(run), json.loads(run.attrs["provenance"])
        if run.attrs.get("source") != "simulation" or "snapshots" not in provenance:
            raise ValueError(f"combine {_NO_RUN}")
        if not _names(run):
            raise ValueError(
                "runs must have variables with error bars: nothing was measured in these"
            )
        if "smoothed" in run.attrs:
            raise ValueError("combine takes runs before their densities are smoothed")
        if chain != chain_of(first):
            raise ValueError(f"runs must be of one chain, got {chain_of(first)} and {chain}")
        if not isinstance(provenance["seed"], list):
            provenance |= {"seed": [provenance["seed"]], "ended": _ends(run)}
        provenance.setdefault("ended", [])  # means of version 0.5 have none
        for seed in provenance["seed"]:
            if any(seed in other["seed"] for other in provenances):
                raise ValueError(f"runs must have other seeds, got {shown(seed)} twice")
        provenances.append(provenance)
    ends = {end for each in provenances for end in each["ended"]}
    # A run that goes on from another one of them has no warm-up of its own.
    origin = min(provenances, key=lambda each: each.get("start") in ends)
    decisive = _decisive(origin)
    for each in provenances:
        free = ("start", "warm-up") if each.get("start") in ends else ()
        for name, value in _decisive(each).items():
            if value != decisive[name] and name not in free:
                raise ValueError(
                    f"runs must differ in the seed only, not in {name}: got "
                    f"{shown(decisive[name])} and {shown(value)}"
                )
    return provenances, origin


def _decisive(provenance: dict[str, Any]) -> dict[str, Any]:
    """Return what decides the means of a run, apart from its chain, by the names for a message."""
    known = provenance | provenance.get("schedule", {})
    step = known.get("time_step", 0)
    return {name: known.get(name) for name in ("method", "stepper", "merging")} | {
        "time step": step,
        "every": step * known.get("stride", 0),
        "warm-up": step * known.get("warmup_steps", 0),
        "start": known.get("start"),
    }


def _ends(run: xr.Dataset) -> list[str]:
    """Return the start, as in a provenance, of a run that continues this one, if it has states."""
    chain = chain_of(run)
    states = {"position", "velocity"} <= {*run} and "replica" in run.position.dims
    if not states or run.sizes.get("particle") != chain.size:
        return []
    last = run.isel(time=slice(-1, None)).squeeze("time") if "time" in run.dims else run
    if not np.isfinite(last.velocity).all():
        return []
    return [f"sha256 {digest(replica_starts(chain, last, last.sizes['replica'])).hex()}"]


def _cases(grid: xr.Dataset) -> list[xr.Dataset]:
    """Return the results in a sweep over seeds alone, with the attributes that they had."""
    cases = []
    for k in np.flatnonzero(grid.provenance != ""):
        case = grid.isel(seed=k, drop=True)
        own = {str(name): value.item() for name, value in case.data_vars.items() if not value.dims}
        case = case.drop_vars(own).assign_attrs(grid.attrs | own)
        cases.append(case.dropna("block", how="all") if "block" in case.dims else case)
    return cases


def _status(grid: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return what a mean over seeds has of the status of its cases, and of their largest error."""
    present = grid.provenance != ""
    status = xr.where(present.any("seed"), "completed", "")
    for worse in ("interrupted", "diverged"):
        status = xr.where((grid.status == worse).any("seed"), worse, status)
    error = grid.time_step_error.where(present, -np.inf).max("seed", skipna=False)
    return {"status": status, "time_step_error": error.where(np.isfinite(error))}


def _names(run: xr.Dataset) -> list[str]:
    """Return the variables with errors, these errors, and how many rods a density lacks."""
    found = [str(name) for name in run.data_vars if f"{name}_error" in run]
    return found + [f"{name}_error" for name in found] + ["outside"] * ("outside" in run)


def _mean(joined: xr.Dataset, weights: xr.DataArray) -> xr.Dataset:
    """Return the weighted means over ``seed``, and their errors where there are any."""
    found = joined.drop_dims("seed")

    def mean(values: xr.DataArray, power: int = 1) -> xr.DataArray:
        known = values.notnull()
        weight = weights.where(known)
        weight = (weight / weight.sum("seed")) ** power
        return (weight * values).sum("seed", skipna=True).where(known.any("seed"))

    for name in _names(joined):
        if name.endswith("_error"):
            continue
        values, error = joined[name], joined.get(f"{name}_error", xr.DataArray(0.0))
        if name.endswith("_width"):
            square: Any = mean(values**2)
            if name == "displacement_width" and "mean_displacement" in joined:
                centre = joined.mean_displacement  # which differs between the runs
                square = square + mean(centre**2) - mean(centre) ** 2
            value: Any = np.sqrt(square)
            error = error * values / value.where(value > 0, 1.0)
        else:
            value = mean(values)
        found[name] = value.assign_attrs(values.attrs)
        if f"{name}_error" in joined:
            variance = mean((error**2).where(error.notnull(), np.inf).where(values.notnull()), 2)
            error = variance.where(np.isfinite(variance)) ** 0.5
            found[f"{name}_error"] = error.assign_attrs(joined[f"{name}_error"].attrs)
    for axis, place in joined.coords.items():
        if "seed" in place.dims and axis != "seed":  # others than mean_position are all the same
            moved = mean(place) if axis == "mean_position" else place.max("seed")
            found = found.assign_coords({axis: moved.assign_attrs(place.attrs)})
    return found


def _blocks(
    runs: Sequence[xr.Dataset], weights: np.ndarray[Any, Any], density: xr.DataArray
) -> xr.DataArray:
    """Return blocks about the common density whose scatter gives the error of the mean."""
    numbers = np.array([run.sizes["block"] for run in runs])
    total = numbers.sum()
    scales = weights * np.sqrt(total * (total - 1) / (numbers * (numbers - 1)))
    parts = [
        density + scale * (run.density_block - run.density_block.mean("block"))
        for run, scale in zip(runs, scales, strict=True)
    ]
    joined = xr.concat(parts, "block").transpose("block", ...)
    return joined.assign_attrs(runs[0].density_block.attrs)
