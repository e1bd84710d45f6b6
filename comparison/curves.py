"""What is drawn of a result: one quantity over one abscissa, and the names of both axes."""

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from crazybilliards.comparison.coverage import require_same_smoothing
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.arrays import check_numbers
from crazybilliards.model.checks import shown
from crazybilliards.model.vocabulary import require, unit_of

_RAISED = re.compile(r"([_^])(-?[\d.]+|[a-z](?:\+\w)?)(?![a-z])")
# Variables by their symbols; others by their long names.
_LABELS = {
    "density": r"density $\rho$",
    "label": "rods to the left $N$",
    "displacement": r"displacement $\langle\Delta x\rangle$",
    "mean_displacement": r"displacement $\langle\Delta x\rangle$",
    "displacement_width": "displacement width $W_x$",
    "velocity_width": "velocity width $W_v$",
    "velocity_variance": "velocity variance $W^2$",
    "flow_velocity": "flow velocity $V$",
    "kinetic_energy": "kinetic energy $E$",
    "velocity_density": "probability density of $v$",
    "velocity_covariance": r"covariance $\langle v_iv_{i+r}\rangle$",
    "neighbour_covariance": r"covariance $\langle v_iv_{i+1}\rangle$",
    "relative_temperature": r"relative temperature $\langle(v_i-v_{i+1})^2\rangle/2$",
    "mode_velocity_variance": r"mode variance $\langle|v_q|^2\rangle$",
    "x": "position $x$",
    "position": "position $x$",
    "time": "time $t$",
    "velocity": "velocity $v$",
    "velocity_bin": "velocity $v$",
    "mode": "mode $q$",
    "wave": "wave $q$",
    "lag": "lag $t$",
    "frequency": r"angular frequency $\omega$",
    "separation": "separation $r$",
    "mean_position": r"mean position $\langle x_i\rangle$",
    "normalized_particle": "normalized particle $i_n$",
    "normalized_contact": "normalized particle $i_n$",
}


class Curve(NamedTuple):
    """Values over an abscissa, all of one dimension."""

    abscissa: xr.DataArray
    values: xr.DataArray
    error: xr.DataArray | None  # one standard error
    measured: bool


def find_curves(results: Mapping[str, Any], quantity: str, along: str) -> dict[str, Curve]:
    """Return a quantity of results, and of data of the reader's own, as curves by their labels.

    ``along`` is the abscissa of the particles; columns have that of the other curves. Raise a
    ValueError if one lacks the quantity, has it over several dimensions, or is of another kind.
    """
    curves: dict[str, Curve] = {}
    ours: dict[str, xr.Dataset] = {}  # not data of the reader's own
    abscissa = "x"
    for label in sorted(results, key=lambda label: not isinstance(results[label], xr.Dataset)):
        dataset = _as_dataset(label, results[label], quantity, abscissa)
        curves[label] = _find_curve(label, dataset, quantity, along)
        abscissa = str(curves[label].abscissa.name)
        if "source" in dataset.attrs:
            ours[label] = dataset
    if quantity == "density":
        require_same_smoothing(ours)
    of_all = [n for n, each in ours.items() if "particle" in each[quantity].dims]
    of_one = [n for n, each in ours.items() if "particle" in {*each.coords} - {*each.dims}]
    if of_all and of_one:
        raise ValueError(f"{quantity}: {of_one[0]} is of one rod, {of_all[0]} of all rods")
    return {label: curves[label] for label in results}


def _as_dataset(label: str, data: Any, quantity: str, abscissa: str) -> xr.Dataset:
    """Return a result as it is, and a DataArray or two columns as a Dataset."""
    if isinstance(data, xr.Dataset):
        return data
    if isinstance(data, xr.DataArray):
        return data.to_dataset(name=quantity)
    if isinstance(data, np.ndarray) and data.ndim == 2 and data.shape[1] == 2 < len(data):
        data = data.T  # the rows of a file, as np.loadtxt reads them
    try:
        x, values = (check_numbers(label, column) for column in data)
        return xr.Dataset({quantity: (abscissa, values)}, {abscissa: x})
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"{label}: overlay takes a result, a DataArray or two columns of numbers ({abscissa}, "
            f"{quantity}), got {shown(data)}"
        ) from error


def _find_curve(label: str, dataset: xr.Dataset, quantity: str, along: str) -> Curve:
    require(dataset, (quantity,), label)
    values, error = dataset[quantity], dataset.get(f"{quantity}_error")
    of_rods = quantity == "velocity_density" and "provenance" in dataset.attrs
    if of_rods and values.sizes.get("particle") == chain_of(dataset).size:  # that of any rod
        values, error = values.mean("particle").assign_attrs(values.attrs), None
    if values.ndim != 1:
        raise ValueError(
            f"{label}: {quantity} is over ({', '.join(map(str, values.dims))}); overlay draws what "
            "is over one dimension: choose the others by .isel(time=...) or .sel(particle=...)"
        )
    [dimension] = map(str, values.dims)
    # x_index is that of the densities of a sweep.
    others = {"x_index": "x", "contact": "normalized_contact", "particle": along}
    abscissa = others.get(dimension, dimension)
    require(dataset, (abscissa,))
    for name in (abscissa, quantity) if "source" not in dataset.attrs else ():
        if not np.isfinite(check_numbers(f"{label}: {name}", dataset[name])).any():
            raise ValueError(f"{label}: {name} has no number that could be drawn")
    if dimension == "velocity_bin":  # the outer bins are empty
        values = values.where(values > 0)
    measured = dataset.attrs.get("source", "simulation" if error is not None else "")
    return Curve(dataset[abscissa], values, error, measured == "simulation")


def shared_label(variables: Mapping[str, xr.DataArray]) -> str:
    """Return the label of an axis of several curves; ValueError if they need different ones."""
    names = {label: str(each.name) for label, each in variables.items()}
    units = {label: unit_of(each) for label, each in variables.items() if "units" in each.attrs}
    for different in (names, units):
        if len(set(different.values())) > 1:
            listed = "; ".join(f"{label}: {each}" for label, each in different.items())
            raise ValueError(f"curves of one picture need the same axes, got {listed}")
    return axis_label(variables[next(iter(units or names))])


def axis_label(variable: xr.DataArray) -> str:
    """Return the name and the unit of a variable, with indices and powers set as in print."""
    name = variable.attrs.get("long_name", str(variable.name))
    unit = unit_label(variable) if variable.attrs.get("units", "1") != "1" else ""
    return _set(_LABELS.get(str(variable.name), name)) + (f" [{unit}]" if unit else "")


def unit_label(variable: xr.DataArray) -> str:
    """Return the unit of a variable in the mathtext of matplotlib."""
    unit = unit_of(variable)
    return f"${unit}$" if "t_0" in unit else _set(unit)


def displacement_unit(chain: Chain) -> tuple[str, float]:
    """Symbol and value [R] of a unit of length: s, without springs half the points' room h."""
    return ("s", chain.thermal_length) if chain.stiffness else ("h", chain.walls[1])


def _set(text: str) -> str:
    """Return ``v_i+1`` and ``R^2`` in the mathtext of matplotlib; a text that has some as it is."""
    return text if "$" in text else _RAISED.sub(r"$\1{\2}$", text)
