"""What is drawn of a result: one quantity over one abscissa, and the names of both axes."""

from __future__ import annotations

import re
from typing import NamedTuple

import xarray as xr

from crazybilliards.model.vocabulary import chain_of, require, unit_of

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


def find_curve(label: str, dataset: xr.Dataset, quantity: str, along: str) -> Curve:
    """Return a quantity of a result as a curve; ``along`` is the abscissa of the particles.

    Raise a ValueError if the result, which the message calls ``label``, lacks the quantity, or has
    it over several dimensions.
    """
    if quantity == "velocity_density":
        dataset = _of_any_rod(dataset)
    require(dataset, (quantity,))
    values = dataset[quantity]
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
    if dimension == "velocity_bin":  # the outer bins are empty
        values = values.where(values > 0)
    error = dataset.get(f"{quantity}_error")
    return Curve(dataset[abscissa], values, error, dataset.attrs.get("source") == "simulation")


def axis_label(variable: xr.DataArray) -> str:
    """Return the name and the unit of a variable, with indices and powers set as in print."""
    name = _LABELS.get(str(variable.name), variable.attrs["long_name"])
    return _set(name) + (f" [{unit_label(variable)}]" if unit_of(variable) != "1" else "")


def unit_label(variable: xr.DataArray) -> str:
    """Return the unit of a variable in the mathtext of matplotlib."""
    unit = unit_of(variable)
    return f"${unit}$" if "t_0" in unit else _set(unit)


def _set(text: str) -> str:
    """Return ``v_i+1`` and ``R^2`` in the mathtext of matplotlib; a text that has some as it is."""
    return text if "$" in text else _RAISED.sub(r"$\1{\2}$", text)


def _of_any_rod(dataset: xr.Dataset) -> xr.Dataset:
    """Return the result with the velocity density of a rod that is picked at random.

    It is the mean over the rods of a result that has all of them.
    """
    require(dataset, ("velocity_density",))
    density = dataset.velocity_density
    if density.sizes.get("particle", 0) != chain_of(dataset).size:
        return dataset
    mean = density.mean("particle").assign_attrs(density.attrs)
    names = [name for name in dataset.data_vars if str(name).startswith("velocity_density")]
    return dataset.drop_vars(names).assign(velocity_density=mean)
