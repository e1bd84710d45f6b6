"""The result of a stationary kinetic equation, with or without correlations, in the vocabulary.

Density and label over x are those of the rods, which :mod:`crazybilliards.kinetic.rods` makes of
the points. The other profiles are those of the points at x = y + 2 R (N - L/2), as of a fluid.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.accuracy import Accuracy
from crazybilliards.kinetic.kinetic_equation.continuation import State, free_units
from crazybilliards.kinetic.kinetic_equation.order_statistics import mirrored
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.kinetic.kinetic_equation.velocity_space import VelocitySpace
from crazybilliards.kinetic.rods.places import LabelledPoints, RodPlaces
from crazybilliards.kinetic.rods.profiles import over_positions
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, OF_RODS, result


def points_of(state: State) -> LabelledPoints:
    """Return the points of a distribution, with places in R."""
    size, length = state.chain.size, free_units(state.chain).length
    profiles = mirrored(moments(state.space, state.f))
    label, density = profiles.label, np.maximum(profiles.density, 0.0)
    below, beyond = (size * (0.5 + sign * label) for sign in (1, -1))
    return LabelledPoints(size, length * profiles.y, size / length * density, below, beyond)


def in_vocabulary(
    state: State,
    rods: RodPlaces | None,
    variables: Mapping[str, tuple[str | tuple[str, ...], Array]],
    coordinates: dict[str, Array],
    *,
    method: Mapping[str, Any],
    residual: float,
    mesh_error: float,
    expected: Accuracy,
) -> xr.Dataset:
    """Return f, the profiles over x, and further ``variables`` with their ``coordinates``.

    ``rods`` None: they are not resolved, and read off the density of a fluid. ``residual`` and
    ``mesh_error`` are errors of the solution, ``expected`` those of the theory.
    """
    chain, (length, velocity) = state.chain, free_units(state.chain)
    y, v, f = state.space.sampled(state.f)
    fields = _profiles_over_x(state, rods)
    dataset = result(
        chain,
        {
            "phase_space_density": (("y", "velocity"), chain.size / (length * velocity) * f),
            **{name: ("x", values) for name, values in fields.items() if name != "x"},
            **variables,
        },
        coordinates={"x": fields["x"], "y": length * y, "velocity": velocity * v} | coordinates,
        source="theory",
        method={**method, "cells": state.space.cells},
        residual=residual,
    )
    dataset.attrs |= {"mesh_error": mesh_error, "cells": state.space.cells, **expected.named()}
    return dataset.assign_attrs(density_of=OF_FLUID if rods is None else OF_RODS)


def _profiles_over_x(state: State, rods: RodPlaces | None) -> dict[str, Array]:
    """Return the positions x, and density and velocity moments over them."""
    chain, (length, velocity) = state.chain, free_units(state.chain)
    profiles = mirrored(moments(state.space, state.f))
    L, R = chain.size, chain.radius
    x = positions(chain, length, state.space)
    if rods is not None:
        farthest = float(np.abs(rods.places).max() - chain.reduced_anchors[-1])
        x = max(x, position_grid(chain, farthest), key=len)
    places = length * profiles.y + 2 * R * L * profiles.label

    def over_x(values: Array) -> Array:
        return np.asarray(PchipInterpolator(places, values, extrapolate=False)(x))

    points = L / length * np.maximum(profiles.density, 0.0)
    density, label = density_and_label(
        chain, x, length * profiles.y, points, L / 2 + L * profiles.label
    )
    displacement = x - (2 * R + chain.lattice_gap) * (label - L / 2)
    if rods is not None:
        density, label = over_positions(chain, x, rods)
    alive = np.maximum(profiles.density, profiles.density.max() * 1e-6)
    heat = chain.mass * velocity**3 * L / length
    return {
        "x": x,
        "density": density,
        "label": label,
        "displacement": displacement,
        "velocity_variance": velocity**2 * _continued_flat(over_x(profiles.variance)),
        "flow_velocity": velocity * np.nan_to_num(over_x(profiles.flux / alive)),
        "heat_flux": heat * np.nan_to_num(over_x(profiles.heat_flux)),
    }


def positions(chain: Chain, length: float, space: VelocitySpace) -> Array:
    """Return the grid of positions for all points of a mesh in units of ``length`` [R]."""
    reach = length * space.box.length - float(chain.reduced_anchors[-1])
    return position_grid(chain, max(reach, length))


def density_and_label(
    chain: Chain, x: Array, y: Array, points: Array, label: Array
) -> tuple[Array, Array]:
    """Return the density of the rods [1/R] and their label N at positions ``x`` [R].

    ``points`` is the density of the points [1/R] at ascending ``y`` [R], not negative. ``label`` is
    the number of points below each y, ascending. There are no rods beyond the first and last y.
    """
    places = y + 2 * chain.radius * (label - chain.size / 2)
    inside = (places[0] <= x) & (x <= places[-1])
    reduced = np.where(inside, PchipInterpolator(places, points, extrapolate=False)(x), 0.0)
    number = PchipInterpolator(places, label, extrapolate=False)(x)
    number = np.where(inside, number, np.where(x < places[0], 0.0, chain.size))
    return reduced / (1 + 2 * chain.radius * reduced), number


def _continued_flat(values: Array) -> Array:
    """Replace NaN beyond the last known value by it, so that a variance stays positive."""
    known = np.flatnonzero(np.isfinite(values))
    filled = values.copy()
    filled[: known[0]], filled[known[-1] + 1 :] = values[known[0]], values[known[-1]]
    return np.maximum(filled, np.finfo(float).tiny)
