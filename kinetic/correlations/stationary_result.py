"""The kinetic equation with pair correlations in the common vocabulary."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from crazybilliards.kinetic.accuracy import expected
from crazybilliards.kinetic.correlations.closure import Closure, collective_variance
from crazybilliards.kinetic.correlations.pair_covariance import (
    Background,
    PairCovariance,
    Problem,
    dissipation,
)
from crazybilliards.kinetic.gas.cells import of_cells, of_rods
from crazybilliards.kinetic.kinetic_equation.continuation import State, free_units
from crazybilliards.kinetic.kinetic_equation.order_statistics import Rods, mirrored, points
from crazybilliards.kinetic.kinetic_equation.stationary_result import in_vocabulary
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.kinetic.rods.places import elastic_rods
from crazybilliards.model.arrays import Array

_NARROWEST = 1e-4  # of a Gaussian, in free units: far below any mesh


class Correlated(NamedTuple):
    """One rod and pairs in agreement."""

    problem: Problem
    state: State
    closure: Closure
    background: Background
    pairs: PairCovariance
    displaced: PairCovariance  # h', of whole cells
    residual: float
    iterations: int


def rods(found: Correlated) -> Rods:
    """Return the moments of the rods, in the free rod's thermal length and velocity width.

    A rod moves in its neighbourhood, and with it.
    """
    state, whole = found.state, found.problem.on_whole_cells().cells
    own = points(state.chain.size, mirrored(moments(state.space, state.f)))
    displaced = collective_variance(whole, found.displaced, np.arange(0.5, state.chain.size))
    velocity = own.velocity_variance + _collective(found)
    return Rods(own.position, own.position_variance + displaced, velocity)


def assemble(found: Correlated, of_rods: Rods, mesh_error: float) -> xr.Dataset:
    """Put the solution into the common vocabulary."""
    chain, (length, velocity) = found.state.chain, free_units(found.state.chain)
    means, widths = length * of_rods.position, length * np.sqrt(of_rods.position_variance)
    return in_vocabulary(
        as_seen_in_place(found.state, np.arange(0.5, chain.size), _collective(found)),
        elastic_rods(chain).moved(means, widths),
        {
            "velocity_width": ("particle", velocity * np.sqrt(of_rods.velocity_variance)),
            "mean_displacement": ("particle", means),
            "displacement_width": ("particle", widths),
            **_of_pairs(found, of_rods.velocity_variance),
        },
        coordinates={
            "mode": np.arange(float(found.problem.cells.rods.size)),
            "separation": np.arange(float(chain.size)),
        },
        method={"theory": "kinetic equation with pair correlations"},
        residual=found.residual,
        mesh_error=mesh_error,
        expected=expected("correlated_phase_space", chain),
    ).assign_attrs(iterations=found.iterations)


def as_seen_in_place(state: State, labels: Array, variance: Array) -> State:
    """Return the state with its collective motion, of the given variance at labels from 0 to L.

    The kinetic equation has f(y, v) of rods whose neighbourhood is where it is in the mean.
    Neighbourhoods are displaced by u and move with V, Gaussian, independent at equal times, with
    the variance h_uu each (see :mod:`.closure`). At a place one sees the convolution.
    """
    space, size = state.space, state.chain.size
    upper = size * (0.5 + moments(space, state.f).label)
    half = np.interp(upper, labels, variance)
    width = np.sqrt(np.maximum(np.concatenate([half[::-1], half]), _NARROWEST**2))
    y, v, f = space.sampled(state.f)
    y_weights = np.concatenate([space.y_weights[::-1], space.y_weights]) / 2
    moving = np.empty_like(f)
    for place in range(y.size):
        spread = _gaussian(v, space.v_weights, width[place])
        moving[place] = spread @ (space.v_weights * f[place])
    displaced = _gaussian(y, y_weights, width) @ (y_weights[:, None] * moving)
    upper_half = displaced[y.size // 2 :]
    return replace(state, f=space.project(lambda _y, _v: upper_half))


def _gaussian(x: Array, weights: Array, width: Array | float) -> Array:
    """Return the matrix of Gaussians about each x (columns), with integrals of 1 in quadrature."""
    peak = np.exp(-(((x[:, None] - x) / width) ** 2) / 2)
    return np.asarray(peak / (weights @ peak))


def _collective(found: Correlated) -> Array:
    """Return the variance of the motion of each rod's neighbourhood."""
    problem = found.problem
    return collective_variance(problem.cells, found.pairs, np.arange(0.5, problem.chain.size))


def _of_pairs(
    found: Correlated, velocity_variance: Array
) -> dict[str, tuple[str | tuple[str, ...], Array]]:
    chain, (length, velocity) = found.state.chain, free_units(found.state.chain)
    around, contacts = found.background, np.arange(1.0, chain.size)
    lost = dissipation(found.problem, around)
    shared, pressure, loss = (
        np.interp(contacts, found.problem.cells.contacts, values)
        for values in (around.shared, around.pressure, lost)
    )
    own = (velocity_variance[1:] + velocity_variance[:-1]) / 2
    along = {
        "neighbour_covariance": velocity**2 * shared,
        "relative_temperature": velocity**2 * (own - shared),
        "contact_force": chain.mass * velocity**2 / length * pressure,
        "contact_loss": chain.mass / 2 * velocity**3 / length * loss,
    }
    modes = _mode_variances(found, velocity_variance)
    covariance = _velocity_covariance(found, velocity_variance, shared)
    return {
        **{name: ("contact", values) for name, values in along.items()},
        "mode_velocity_variance": ("mode", velocity**2 * modes),
        "velocity_covariance": (("particle", "separation"), velocity**2 * covariance),
    }


def _velocity_covariance(found: Correlated, velocity_variance: Array, shared: Array) -> Array:
    """Return <v_i v_{i+r}> over i and r, in free units.

    The covariance of all rods is a local part, that of independent rods, plus h. Two different rods
    have h alone. A rod with itself has W_v^2, in which the local part is, and neighbours have
    ``shared``, which holds half of what their last collision left in h. The
    sums over waves, sum_ij c_q(i) c_q(j) <v_i v_j>, are therefore close to ``_mode_variances`` for
    long waves, and differ from it in short ones, where these two separations count.
    """
    covariance = of_rods(found.pairs.velocity, found.problem.cells)
    covariance[:, 0] = velocity_variance
    covariance[:-1, 1] = shared
    return covariance


def _mode_variances(found: Correlated, velocity_variance: Array) -> Array:
    """Return <|v_q|^2>, v_q = sum_i sqrt((2 or, for q = 0, 1)/L) cos(pi q (i - 1/2)/L) v_i."""
    cells, size = found.problem.cells, found.problem.chain.size
    M = cells.rods.size
    q = np.arange(M)[:, None]
    waves = np.sqrt(np.where(q == 0, 1, 2) / size) * np.cos(np.pi * q * cells.centres / size)
    own = np.interp(cells.centres, np.arange(size) + 0.5, velocity_variance)
    local = cells.rods * (own - of_cells(found.background.shared))
    weighted = waves * cells.rods
    return np.asarray(
        (waves**2) @ local + np.einsum("qi,ij,qj->q", weighted, found.pairs.velocity, weighted)
    )
