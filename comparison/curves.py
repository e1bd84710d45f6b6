"""What is drawn of a result: one quantity over one abscissa, and the names of both axes."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
import xarray as xr

from crazybilliards.model.checks import shown
from crazybilliards.model.vocabulary import VOCABULARY, chain_of, described, require, unit_of

# Dimension: abscissa. A quantity over the particle has the one that is asked for.
_ABSCISSAE = {
    "x": "x",
    "x_index": "x",  # of a sweep
    "time": "time",
    "contact": "normalized_contact",
    "mode": "mode",
    "wave": "wave",
    "lag": "lag",
    "frequency": "frequency",
    "separation": "separation",
    "velocity": "velocity",
    "velocity_bin": "velocity_bin",
    "impact_speed": "impact_speed",
}
_OVER = ", ".join([*sorted(set(_ABSCISSAE) - {"x_index"}), "or particle"])
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
    it over another dimension or several.
    """
    if not isinstance(dataset, xr.Dataset):
        raise ValueError(f"{label}: not a crazybilliards result: {shown(dataset)}")
    if quantity == "velocity_density":
        dataset = _of_any_rod(dataset)
    require(dataset, (quantity,))
    values = dataset[quantity]
    abscissae = _ABSCISSAE | {"particle": along}
    if len(values.dims) != 1 or values.dims[0] not in abscissae:
        message = f"{label}: {quantity} is over ({', '.join(map(str, values.dims))})"
        over = [name for name in values.dims if name in abscissae]
        for name in ("time", "particle", "wave"):
            if len(over) > 1 and name in over:
                over.remove(name)
        if len(over) == 1:
            others = [str(name) for name in values.dims if name not in over]
            by_value = all(name in dataset.indexes and name not in abscissae for name in others)
            how = "sel" if by_value else "isel"
            ways = ", ".join(f"{name}=..." for name in others)
            raise ValueError(f"{message}; choose a {' and a '.join(others)}: .{how}({ways})")
        raise ValueError(f"{message}; overlay draws what is over {_OVER}")
    require(dataset, (abscissae[str(values.dims[0])],))
    if values.dims == ("velocity_bin",):  # the outer bins are empty
        visited = np.flatnonzero(values > 0)
        if visited.size:
            dataset = dataset.isel(velocity_bin=slice(visited[0], visited[-1] + 1))
    abscissa = dataset[abscissae[str(values.dims[0])]]
    error = dataset.get(f"{quantity}_error")
    return Curve(abscissa, dataset[quantity], error, dataset.attrs.get("source") == "simulation")


def is_of_one_rod(dataset: xr.Dataset, quantity: str) -> bool:
    """Return whether one particle was chosen of a quantity that all particles have."""
    particle = dataset[quantity].coords.get("particle") if quantity in dataset else None
    return particle is not None and particle.ndim == 0


def axis_label(variable: xr.DataArray) -> str:
    """Return the name and the unit of a variable, with indices and powers set as in print."""
    unit = unit_of(variable)
    name = _LABELS.get(str(variable.name), variable.attrs["long_name"])
    return _set(name) + (f" [{_set(unit)}]" if unit != "1" else "")


def _set(text: str) -> str:
    """Return ``v_i+1`` and ``R^2`` in the mathtext of matplotlib; a text that has some as it is."""
    return text if "$" in text else _RAISED.sub(r"$\1{\2}$", text)


def _of_any_rod(dataset: xr.Dataset) -> xr.Dataset:
    """Return the result with the velocity density of a rod that is picked at random.

    A simulation that has all rods has their mean, a kinetic equation int f dy/L.
    """
    about = described(*VOCABULARY["velocity_density"])
    if "velocity_density" in dataset:
        density = dataset.velocity_density
        if density.sizes.get("particle", 0) != chain_of(dataset).size:
            return dataset
        mean = density.mean("particle").assign_attrs(about)
        names = [name for name in dataset.data_vars if str(name).startswith("velocity_density")]
        return dataset.drop_vars(names).assign(velocity_density=mean)
    if "phase_space_density" not in dataset:
        return dataset
    marginal = dataset.phase_space_density.integrate("y")
    density = marginal / marginal.integrate("velocity")
    return dataset.assign(velocity_density=density.assign_attrs(about))
