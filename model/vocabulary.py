"""The names, dimensions and units of every result of this package.

Simulations and theories return an :class:`xarray.Dataset` built by :func:`result`, so any two of
them can be compared. A measured ``NAME`` comes with ``NAME_error``, one standard error.
"""

import json
import platform
import re
from collections.abc import Collection, Mapping
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.model.chain import Chain
from crazybilliards.model.checks import meant, shown
from crazybilliards.model.warn import warn_if_diverged

# name: (meaning, unit). R length, M mass, t_0 = sqrt(M/k) time.
VOCABULARY = {
    "density": ("particle density rho", "1/R"),
    "density_block": ("particle density rho, block by block", "1/R"),
    "outside": ("rods per snapshot outside the grid x", "1"),
    "mean_displacement": ("mean displacement <x_i - x0_i>", "R"),
    "displacement_width": ("displacement width W_x", "R"),
    "velocity_width": ("velocity width W_v", "R/t_0"),
    "mean_velocity": ("mean velocity <v_i>", "R/t_0"),
    "velocity_density": ("probability density of v_i", "t_0/R"),
    "velocity_outside": ("share of velocities beyond the bins", "1"),
    "velocity_skewness": ("skewness of v_i", "1"),
    "velocity_kurtosis": ("excess kurtosis of v_i", "1"),
    "kinetic_energy": ("kinetic energy sum m v^2/2", "M R^2/t_0^2"),
    "spring_energy": ("energy of the springs sum U(x_i - x0_i)", "M R^2/t_0^2"),
    "total_energy": ("kinetic energy and that of the springs", "M R^2/t_0^2"),
    "collision_rate": ("collisions with the right neighbour per time", "1/t_0"),
    "avalanche_count": ("waves started by the particle that triggered N_c collisions", "1"),
    "avalanche_size": ("collisions triggered N_c", "1"),
    "triggered_count": ("hits of the right neighbour that triggered N_c further collisions", "1"),
    "triggered_collisions": ("collisions triggered after the first N_c", "1"),
    "autocorrelation_time": ("autocorrelation time of the displacement", "t_0"),
    "displacement": ("mean displacement <dx>(x)", "R"),
    "label": ("number of rods to the left N", "1"),
    "flow_velocity": ("flow velocity V", "R/t_0"),
    "velocity_variance": ("velocity variance W^2", "R^2/t_0^2"),
    "heat_flux": ("heat flux (m/2) int (v - V)^3 f dv", "M R^2/t_0^3"),
    "neighbour_covariance": ("covariance of neighbours' velocities <v_i v_i+1>", "R^2/t_0^2"),
    "relative_temperature": ("relative temperature <(v_i - v_i+1)^2>/2", "R^2/t_0^2"),
    "contact_force": ("mean force between neighbours", "M R/t_0^2"),
    "wall_force": ("mean force of the rods on a wall, the pressure", "M R/t_0^2"),
    "wall_collision_rate": ("collisions with a wall per time", "1/t_0"),
    "contact_temperature": ("relative temperature before a collision", "R^2/t_0^2"),
    "rebound_temperature": ("relative temperature after a collision", "R^2/t_0^2"),
    "contact_loss": ("power that collisions take at a contact", "M R^2/t_0^3"),
    "impact_speed_density": ("probability density of the speed w at which rods meet", "t_0/R"),
    "velocity_covariance": ("covariance of velocities <v_i v_i+r>", "R^2/t_0^2"),
    "gap_covariance": ("covariance of gaps <g_i g_i+r> - <g_i><g_i+r>", "R^2"),
    "mean_gap": ("mean free room between neighbours <g_i>", "R"),
    "mode_velocity_variance": ("mean square velocity of a mode <|v_q|^2>", "R^2/t_0^2"),
    "velocity_autocorrelation": ("velocity autocorrelation <v_i(0) v_i(t)>", "R^2/t_0^2"),
    "displacement_autocorrelation": ("displacement autocorrelation <d_i(0) d_i(t)>", "R^2"),
    "mean_squared_displacement": ("mean squared displacement <(x_i(t) - x_i(0))^2>", "R^2"),
    "velocity_spectrum": ("spectrum of the velocity v_i", "R^2/t_0"),
    "wave_velocity_autocorrelation": ("velocity autocorrelation of a wave", "R^2/t_0^2"),
    "wave_displacement_autocorrelation": ("displacement autocorrelation of a wave", "R^2"),
    "wave_mean_squared_displacement": ("mean squared displacement of a wave", "R^2"),
    "wave_velocity_spectrum": ("spectrum of the velocity of a wave", "R^2/t_0"),
    "centre_velocity_autocorrelation": ("velocity autocorrelation of the centre", "R^2/t_0^2"),
    "centre_displacement_autocorrelation": ("displacement autocorrelation of the centre", "R^2"),
    "centre_mean_squared_displacement": ("mean squared displacement of the centre", "R^2"),
    "centre_velocity_spectrum": ("spectrum of the velocity of the centre", "R^2/t_0"),
    "rods": ("number of rods", "1"),
    "centre": ("mean position of all rods", "R"),
    "cloud_width": ("standard deviation of y over the rods", "R"),
    "covariance": ("covariance of y and v over the rods", "R^2/t_0"),
    "unsteadiness": ("rms rate of change, in units of the free case", "1"),
    "position": ("rod centres x_i", "R"),
    "velocity": ("velocity v", "R/t_0"),
    "velocity_bin": ("velocity v in the middle of a bin", "R/t_0"),
    "impact_speed": ("speed w at which rods meet, in the middle of a bin", "R/t_0"),
    "time": ("time t", "t_0"),
    "x": ("position x", "R"),
    "particle": ("particle i", "1"),
    "contact": ("contact of particle i with i + 1", "1"),
    "wall": ("wall, 1 on the left and 2 on the right", "1"),
    "normalized_contact": ("normalized particle i_n half way between i and i + 1", "1"),
    "mode": ("mode q", "1"),
    "wave": ("wave cos(pi q (i - 1/2)/L) along the chain q", "1"),
    "lag": ("time between two snapshots t", "t_0"),
    "frequency": ("angular frequency w", "1/t_0"),
    "separation": ("separation r of two particles or contacts", "1"),
    "mean_position": ("mean position <x_i>", "R"),
    "normalized_particle": ("normalized particle i_n", "1"),
}

# Numbers about a whole result are its attributes, plain numbers in these units.
ATTRIBUTES = {
    "end_time": ("time reached, warm-up included", "t_0"),
    "seconds": ("computing time", "s"),
    "residual": ("how far the equations are from satisfied", "1"),
    "time_step_error": ("relative error of W_v due to the time step", "1"),
    "relaxation_time": ("time in which the chain forgets its start", "t_0"),
    "velocity_width_model_error": ("relative error of W_v of the theory itself", "1"),
    "border_model_error": ("relative error of W_v at the border of the theory itself", "1"),
    "displacement_width_model_error": ("relative error of W_x of the theory itself", "1"),
    "kinetic_energy_model_error": ("relative error of the energy of the theory itself", "1"),
    "mean_displacement_model_error": ("error of <dx> of the theory itself, over s", "1"),
    "wave_model_error": ("error of the slowest wave of density of the theory, of its height", "1"),
    "label_model_error": ("error of the label of the theory itself, over the number of rods", "1"),
    "density_model_error": ("error of the density of the theory itself, of close packing", "1"),
    "wall_force_model_error": ("relative error of the force on walls of the theory itself", "1"),
    "iterations": ("iterations until the equations were satisfied", "1"),
}

# What the density of a theory is: its attribute `density_of`.
OF_FLUID, OF_RODS = "fluid", "rods"

_RODS_TOLERANCE = 1e-6
_AXES = frozenset({"x", "time"})


def result(
    chain: Chain,
    variables: Mapping[str, tuple[tuple[str, ...] | str, ArrayLike]],
    *,
    source: str,
    method: Mapping[str, Any],
    coordinates: Mapping[str, ArrayLike] | None = None,
    status: str = "completed",
    end_time: float | None = None,
    residual: float | None = None,
    particles: ArrayLike | None = None,
    vocabulary: Mapping[str, tuple[str, str]] | None = None,
) -> xr.Dataset:
    """Build a result of a chain in the common vocabulary: coordinates, units, status, provenance.

    Parameters
    ----------
    variables
        ``{name: (dims, values)}``; each name, or NAME of NAME_error, stands in a vocabulary.
    source
        ``"simulation"`` or ``"theory"``.
    method
        How it was computed, for the provenance: anything JSON can hold.
    coordinates
        Values along the dimensions, except of the particles and contacts, which get their numbers.
    status, end_time
        ``completed``, ``diverged`` or ``interrupted``, and the time reached.
    residual
        How well a theory's equations are satisfied, as its function defines.
    particles
        The particles, from 1, and contacts by their left particles, of the variables; None: all.
    vocabulary
        Meanings and units of names that are not in ``VOCABULARY``, such as an observer's own.

    It is a ValueError if the label does not grow by the number of the chain's rods, to 1e-6 of it.
    """
    if "label" in variables:
        _require_all_rods(chain, variables["label"][1])
    along: dict[str, Any] = {
        name: (name, np.asarray(values, dtype=float))
        for name, values in (coordinates or {}).items()
    }
    rods = np.arange(chain.size) if particles is None else np.asarray(particles) - 1
    ends = max(chain.size - 1, 1)
    if any("contact" in dims for dims, _ in variables.values()):
        left = rods[rods < chain.size - 1]
        along["contact"] = ("contact", left + 1)
        along["normalized_contact"] = ("contact", (2 * chain.rank[left] + 1) / ends)
    if any("particle" in dims for dims, _ in variables.values()):
        along["particle"] = ("particle", rods + 1)
        along["normalized_particle"] = ("particle", 2 * chain.rank[rods] / ends)
        if "mean_displacement" in variables:
            dimensions, mean = variables["mean_displacement"]
            along["mean_position"] = (dimensions, chain.anchors[rods] + np.asarray(mean))
    dataset = xr.Dataset(dict(variables), coords=along)
    meanings = {**(vocabulary or {}), **VOCABULARY}
    for name in map(str, dataset.variables):
        meaning, unit = meanings[name.removesuffix("_error")]
        error = "standard error of " * name.endswith("_error")
        dataset[name].attrs |= described(error + meaning, unit)
    if "separation" in dataset.coords and (reach := int(dataset.separation[-1])) < chain.size - 1:
        dataset["separation"].attrs["comment"] = (
            f"cut at {reach} of {chain.size - 1}; Covariances(separations=...) sets where"
        )
    numbers = {"end_time": end_time, "residual": residual}
    provenance = {"chain": chain.parameters(), **method, "versions": _versions()}
    return dataset.assign_attrs(
        source=source,
        status=status,
        **{name: float(value) for name, value in numbers.items() if value is not None},
        provenance=json.dumps(provenance, sort_keys=True),
    )


def described(meaning: str, unit: str) -> dict[str, str]:
    """Return the attributes of a variable. Libraries of units take R for the gas constant: R_0."""
    return {"long_name": meaning, "units": re.sub("[RM]", r"\g<0>_0", unit)}


def unit_of(variable: xr.DataArray) -> str:
    """Return the unit of a variable as in the vocabulary, R/t_0 for example."""
    unit = re.sub("T(_0)?", "t_0", str(variable.attrs["units"]))  # so up to version 0.5
    return re.sub("([RM])_0", r"\1", unit)


def _require_all_rods(chain: Chain, label: ArrayLike) -> None:
    """Raise a ValueError if the label, whose last axis is x, does not count all rods."""
    ends = np.asarray(label)[..., [0, -1]]
    rods = ends[..., 1] - ends[..., 0]
    worst = float(rods.flat[np.argmax(np.abs(rods - chain.size))])
    if not abs(worst - chain.size) <= _RODS_TOLERANCE * chain.size:
        raise ValueError(
            f"the solution holds {worst:.8g} of the chain's {chain.size} rods: the others lie "
            "beyond its grid of positions, or the equations were not solved"
        )


def chain_of(dataset: xr.Dataset) -> Chain:
    """Return the chain a result was computed for, read from its provenance."""
    check_result(dataset)
    try:
        return Chain(**json.loads(dataset.attrs["provenance"])["chain"])
    except (KeyError, TypeError, json.JSONDecodeError) as error:
        raise ValueError("not a crazybilliards result: its provenance names no chain") from error


def check_result(result: object, kinds: Any = xr.Dataset) -> None:
    """Raise a ValueError unless this is a result, of these kinds of xarray."""
    if not isinstance(result, kinds):
        raise ValueError(f"not a crazybilliards result: {shown(result)}")


def require(dataset: xr.Dataset, names: Collection[str], who: str = "the result") -> None:
    """Raise a ValueError naming the first of ``names`` that the result lacks, or has without axes.

    xarray counts from 0 along an axis that has no coordinate, and these would be no positions.
    Warn of a chain that diverged, unless all ``names`` are over time.
    """
    check_result(dataset)
    for name in names:
        if name not in dataset:
            known = list(map(str, dataset.data_vars))
            has = ", ".join(known) or "nothing"
            raise ValueError(f"{who} has no {name!r}; it has {has}{meant(name, known)}")
        for axis in _AXES.intersection(map(str, dataset[name].dims)).difference(dataset.coords):
            raise ValueError(f"the {name} of the result has no coordinate {axis!r}")
    over_time = len(names) > 0 and all("time" in dataset[name].dims for name in names)
    warn_if_diverged(dataset, who, over_time)


def refuse_unread(given: xr.Dataset, who: str, read: Collection[str]) -> None:
    """Raise a ValueError naming a variable that ``who`` does not read; results may hold others."""
    is_result = given.attrs.get("source") in ("simulation", "theory")
    for name in map(str, given.data_vars):
        if not (is_result or name in read):
            raise ValueError(
                f"{who} does not read {name!r}, it reads {', '.join(read)}; drop_vars({name!r}) "
                f"leaves it out{meant(name, read)}"
            )


def require_all_particles(dataset: xr.Dataset, size: int, who: str) -> None:
    """Raise a ValueError unless a result has all particles of a chain, in their order."""
    given = dataset.sizes.get("particle")
    if given != size:
        raise ValueError(
            f"{who}: the result has {given} particles, the chain {size}; give all particles"
        )
    numbers = np.arange(size) + 1
    if not np.array_equal(dataset.coords.get("particle", numbers), numbers):
        raise ValueError(f"{who}: the particles of the result must ascend from 1 to {size}")


@cache
def _versions() -> dict[str, str]:
    packages = ("crazybilliards", "numpy", "numba", "scipy", "xarray")
    return {"python": platform.python_version()} | {name: version(name) for name in packages}
