"""The kinetic equation with pair correlations in the common vocabulary."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from crazybilliards.kinetic.correlations.accuracy import expected_accuracy
from crazybilliards.kinetic.correlations.cells import Cells, at_distance, make_cells, of_cells
from crazybilliards.kinetic.correlations.closure import Closure, collective_variance
from crazybilliards.kinetic.correlations.collective_motion import as_seen_in_place
from crazybilliards.kinetic.correlations.collision_moments import moments_of_collisions
from crazybilliards.kinetic.correlations.pair_covariance import (
    Background,
    PairCovariance,
    dissipation,
)
from crazybilliards.kinetic.kinetic_equation.continuation import State, free_units
from crazybilliards.kinetic.kinetic_equation.order_statistics import mirrored, points
from crazybilliards.kinetic.kinetic_equation.profiles import profiles_over_x
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.model.vocabulary import result

Array = NDArray[np.float64]


class Correlated(NamedTuple):
    """One rod and pairs in agreement."""

    state: State
    closure: Closure
    background: Background
    pairs: PairCovariance
    residual: float
    iterations: int


def assemble(found: Correlated, mesh_error: float) -> xr.Dataset:
    """Return the solution as a result."""
    state = found.state
    chain, (length, velocity) = state.chain, free_units(state.chain)
    cells = make_cells(chain.size)
    rods: Array = np.arange(0.5, chain.size)
    of = points(chain.size, mirrored(moments(state.space, state.f)))
    collective = collective_variance(cells, found.pairs, rods)
    velocity_variance = of.velocity_variance + collective
    seen = as_seen_in_place(state, rods, collective)
    y, v, f = seen.space.sampled(seen.f)
    fields = profiles_over_x(seen)
    dataset = result(
        chain,
        {
            "phase_space_density": (("y", "velocity"), chain.size / (length * velocity) * f),
            **{name: ("x", values) for name, values in fields.items() if name != "x"},
            "velocity_width": ("particle", velocity * np.sqrt(velocity_variance)),
            "mean_displacement": ("particle", length * of.position),
            "displacement_width": (
                "particle",
                length * np.sqrt(of.position_variance + collective),
            ),
            **_of_pairs(found, cells, velocity_variance),
        },
        coordinates={
            "x": fields["x"],
            "y": length * y,
            "velocity": velocity * v,
            "mode": np.arange(cells.rods.size),
        },
        source="theory",
        method={"theory": "kinetic equation with pair correlations", "cells": state.space.cells},
        residual=found.residual,
    )
    accuracy = expected_accuracy(chain.restitution, chain.size)
    dataset.attrs |= {
        "iterations": found.iterations,
        "mesh_error": mesh_error,
        "cells": state.space.cells,
        "model_error": accuracy.inner,
        "border_error": accuracy.border,
    }
    return dataset


def _of_pairs(
    found: Correlated, cells: Cells, velocity_variance: Array
) -> dict[str, tuple[str, Array]]:
    chain, (length, velocity) = found.state.chain, free_units(found.state.chain)
    around, contacts = found.background, np.arange(1.0, chain.size)
    lost = dissipation(around, moments_of_collisions(chain.restitution))
    # Half of the neighbours leave one another, and have their last collision's share as well.
    near = at_distance(found.pairs.velocity, cells.centres, cells.contacts, 1.0)
    shared, pressure, loss = (
        np.interp(contacts, cells.contacts, values)
        for values in ((around.shared + near) / 2, around.pressure, lost)
    )
    own = (velocity_variance[1:] + velocity_variance[:-1]) / 2
    along = {
        "neighbour_covariance": velocity**2 * shared,
        "relative_temperature": velocity**2 * (own - shared),
        "contact_force": chain.mass * velocity**2 / length * pressure,
        "contact_loss": chain.mass / 2 * velocity**3 / length * loss,
    }
    return {name: ("contact", values) for name, values in along.items()} | {
        "mode_velocity_variance": (
            "mode",
            velocity**2 * _mode_variances(found, cells, velocity_variance),
        )
    }


def _mode_variances(found: Correlated, cells: Cells, velocity_variance: Array) -> Array:
    """Return <|v_q|^2>, v_q = sum_i sqrt((2 or, for q = 0, 1)/L) cos(pi q (i - 1/2)/L) v_i."""
    size, M = found.state.chain.size, cells.rods.size
    q = np.arange(M)[:, None]
    waves = np.sqrt(np.where(q == 0, 1, 2) / size) * np.cos(np.pi * q * cells.centres / size)
    own = np.interp(cells.centres, np.arange(size) + 0.5, velocity_variance)
    local = cells.rods * (own - of_cells(found.background.shared))
    weighted = waves * cells.rods
    return np.asarray(
        (waves**2) @ local + np.einsum("qi,ij,qj->q", weighted, found.pairs.velocity, weighted)
    )
