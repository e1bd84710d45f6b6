"""The steady state of the gas in the common vocabulary."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from crazybilliards.kinetic.exact.places import (
    are_resolved,
    at_temperature,
    elastic_rods,
    exchangeable,
    over_positions,
)
from crazybilliards.kinetic.gas.agreement import Fluctuations, Steady
from crazybilliards.kinetic.gas.cells import at_distance, means, of_rods
from crazybilliards.kinetic.gas.mean_state import conductance
from crazybilliards.model import Array, Chain
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, OF_RODS, result

_MOST_COVARIANCES = 1000  # rods whose covariances, a square table, are returned

Variables = dict[str, tuple[str | tuple[str, ...], Array]]


class Rods(NamedTuple):
    """Moments of each rod in the units of the gas, shape (L,)."""

    place: Array
    width: Array  # W_x; NaN if it is not known
    velocity_variance: Array


def in_vocabulary(chain: Chain, found: Steady) -> xr.Dataset:
    """Return the result of ``steady_state``, but for the errors of the theory."""
    length, W = found.medium.length, chain.free_velocity_width
    rods, of = rods_of(chain, found), found.fluctuations
    variables: Variables = {
        "velocity_width": ("particle", W * np.sqrt(rods.velocity_variance)),
        "mean_displacement": ("particle", length * rods.place - chain.reduced_anchors),
    }
    if np.isfinite(rods.width).all():
        variables["displacement_width"] = ("particle", length * rods.width)
    if chain.box:
        variables["wall_force"] = ("wall", chain.mass * W**2 / length * found.mean.force[[0, -1]])
    coordinates, fields = _over_positions(chain, found, rods)
    variables |= fields
    if of is not None:
        variables |= _of_pairs(chain, found, of, rods)
        coordinates["mode"] = np.arange(float(found.cells.rods.size))
        if "velocity_covariance" in variables:
            coordinates["separation"] = np.arange(float(chain.size))
    return result(
        chain,
        variables,
        coordinates=coordinates,
        source="theory",
        method={"theory": "gas along labels" if of else "gas along labels, mean field"},
        residual=found.residual,
    ).assign_attrs(
        iterations=found.iterations, density_of=OF_RODS if are_resolved(chain) else OF_FLUID
    )


def rods_of(chain: Chain, found: Steady) -> Rods:
    """Return the moments of the rods."""
    medium, cells = found.medium, found.cells
    middles: Array = np.arange(0.5, chain.size)
    place, T = (
        np.interp(middles, cells.centres, field)
        for field in (found.mean.place, found.mean.temperature)
    )
    own = np.full(chain.size, np.nan)  # the width of a rod in its neighbourhood
    if are_resolved(chain) and found.labels is not None:
        law, score = exchangeable(chain.size), found.labels.score
        y = PchipInterpolator(score, found.labels.place)(np.clip(law.places, score[0], score[-1]))
        own = np.sqrt(law.mean(y**2) - law.mean(y) ** 2)
    elif are_resolved(chain):
        mean = float(T.mean())
        elastic = elastic_rods(at_temperature(chain, mean * chain.temperature))
        own = elastic.width() / medium.length * np.sqrt(T / mean)
    if found.fluctuations is None:
        share, K = 1 / chain.size, medium.stiffness
        of_centre = share * (1 - T) / K if medium.exponent == 2 and K else 0.0
        return Rods(place, np.sqrt(own**2 + of_centre), (1 - share) * T + share)
    collective = np.interp(middles, cells.contacts, found.closure.collective)
    of = found.fluctuations.displaced
    displaced = at_distance(of.displacement, of.cells.centres, middles, 0.0)
    return Rods(place, np.sqrt(np.maximum(own**2 + displaced, 0.0)), T + collective)


def _over_positions(chain: Chain, found: Steady, rods: Rods) -> tuple[dict[str, Array], Variables]:
    """Return the positions x, and what lies over them."""
    medium, W, R = found.medium, chain.free_velocity_width, chain.radius
    cells = found.labels.fine if found.labels else found.cells
    y = medium.length * (found.labels.place if found.labels else found.mean.place)
    label, end = cells.centres - chain.size / 2, chain.size / 2
    if label.size > 1:  # the ends of the chain, half a cell beyond the outermost centres
        half = (end - label[-1]) / (label[-1] - label[-2]) * (y[-1] - y[-2])
        label = np.pad(label, 1, constant_values=(-end, end))
        y = np.pad(y, 1, constant_values=(y[0] - half, y[-1] + half))
    places = y + 2 * R * label
    x = position_grid(chain, float(np.abs(places).max() - chain.anchors[-1]))
    shapes = None
    if are_resolved(chain):
        # The elastic chain's rods, moved and stretched to these moments, but not into walls.
        temperature = chain.temperature * float(rods.velocity_variance.mean())
        elastic = elastic_rods(at_temperature(chain, temperature))
        mean, width = medium.length * rods.place, medium.length * rods.width
        if chain.box:
            ends = elastic.places[:, [0, -1]].T
            room = np.abs(np.array(chain.walls)[:, None] - mean) / np.abs(ends - elastic.mean())
            width = np.minimum(width, room.min(axis=0) * elastic.width())
        shapes = elastic.moved(mean, width)
        farthest = float(np.abs(shapes.places).max() - chain.reduced_anchors[-1])
        x = max(x, position_grid(chain, farthest), key=len)
    number = np.interp(x, places, label + chain.size / 2)
    number[x < places[0]], number[x > places[-1]] = 0.0, chain.size
    T = np.interp(number, np.arange(0.5, chain.size), rods.velocity_variance)
    fluid = np.gradient(np.interp(x, places, label), x)
    density, count = over_positions(chain, x, shapes) if shapes else (fluid, number)
    variables: Variables = {
        "density": ("x", density),
        "label": ("x", count),
        "displacement": ("x", x - (2 * R + chain.lattice_gap) * (number - chain.size / 2)),
        "velocity_variance": ("x", W**2 * T),
        "heat_flux": ("x", _heat_flux(chain, found, number)),
    }
    return {"x": x}, variables


def _heat_flux(chain: Chain, found: Steady, label: Array) -> Array:
    """Return (m/2) n q at labels."""
    if found.labels is not None and found.flux is not None:
        where, flux = found.labels.fine.centres, found.flux
    else:
        mean, cells = found.mean, found.cells
        T, P = mean.contact_temperature, mean.force[cells.inner]
        through = conductance(found.medium, cells, T, P, found.closure.strength(T))
        where, flux = cells.contacts, -through * np.diff(mean.temperature)
    places, ends = (np.pad(field, 1) for field in (where, flux))
    places[-1] = chain.size
    unit = chain.mass * chain.free_velocity_width**3 / (2 * found.medium.length)
    return np.asarray(unit * np.interp(label, places, ends))


def _of_pairs(chain: Chain, found: Steady, of: Fluctuations, rods: Rods) -> Variables:
    """Return what two rods have in common."""
    medium, cells, state = found.medium, found.cells, of.background
    W, contacts = chain.free_velocity_width, np.arange(1.0, chain.size)
    shared, pressure, loss = (
        np.interp(contacts, cells.contacts, field[cells.inner])
        for field in (state.shared, state.pressure, state.loss)
    )
    variance = rods.velocity_variance
    variables: Variables = {
        "neighbour_covariance": ("contact", W**2 * shared),
        "relative_temperature": ("contact", W**2 * (means(variance) - shared)),
        "contact_force": ("contact", chain.mass * W**2 / medium.length * pressure),
        "contact_loss": ("contact", chain.mass / 2 * W**3 / medium.length * loss),
        "mode_velocity_variance": ("mode", W**2 * _mode_variances(chain, found, of, rods)),
    }
    if chain.size <= _MOST_COVARIANCES:
        covariance = of_rods(of.pairs.velocity, cells)
        # With the local part, and half of what the last collision of neighbours left.
        covariance[:, 0], covariance[:-1, 1] = variance, shared
        variables["velocity_covariance"] = (("particle", "separation"), W**2 * covariance)
    return variables


def _mode_variances(chain: Chain, found: Steady, of: Fluctuations, rods: Rods) -> Array:
    """Return <|v_q|^2>, v_q = sum_i sqrt((2 or, for q = 0, 1)/L) cos(pi q (i - 1/2)/L) v_i."""
    cells, size = found.cells, chain.size
    q = np.arange(cells.rods.size)[:, None]

    def waves(labels: Array) -> Array:
        return np.asarray(
            np.sqrt(np.where(q == 0, 1, 2) / size) * np.cos(np.pi * q * labels / size)
        )

    middles = np.arange(0.5, size)
    shared = np.interp(middles, cells.contacts, of.background.shared[cells.inner])
    local = waves(middles) ** 2 @ (rods.velocity_variance - shared)
    weighted = waves(cells.centres) * cells.rods
    return np.asarray(local + np.einsum("qi,ij,qj->q", weighted, of.pairs.velocity, weighted))
