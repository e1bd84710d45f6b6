r"""The steady state of every chain, by the gas along labels.

Mean state and fluctuations of the equations in :mod:`crazybilliards.kinetic.gas` agree with one
another (:mod:`.agreement`). No number is fitted, and nothing from a simulation goes in:

    W_v(i)^2 = T(i) + K h_uu(i),       W_x(i)^2 = q(i)^2 + h'_uu(i),

T being the temperature within a neighbourhood, K h_uu the velocity that it shares, q the width of a
rod in it (without a gap of the i-th of L points, with a gap in the elastic chain at its
temperature), and h'_uu the displacement of neighbourhoods (:mod:`.agreement`).

**The mean field** (``correlations=False``, and always for e > 1) takes colliding rods for
independent. The noise drives the centre of mass as well, which collisions leave alone, so that

    W_v^2 = (1 - 1/L) T + 1/L,

and the same for the displacements on linear springs. For e > 1, on linear springs without a gap and
walls, T is that of points in phase space (:mod:`.driven`). Other chains with e > 1 have the
closure, which is too cold at the ends if the damping is above 0.6 sqrt(k m).
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from crazybilliards.kinetic.accuracy import Accuracy, errors_of_steady_state, warn_if_unmeasured
from crazybilliards.kinetic.exact.places import (
    are_resolved,
    at_temperature,
    elastic_rods,
    over_positions,
)
from crazybilliards.kinetic.gas.agreement import Fluctuations, Steady, in_agreement, mean_field
from crazybilliards.kinetic.gas.cells import at_distance, make_cells, means, of_rods
from crazybilliards.kinetic.gas.mean_state import NoSteadyStateError, conductance
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import shown
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, OF_RODS, result

_MOST_RODS = 100_000
_FEWEST_CORRELATED = 4  # rods; fewer have no pairs beyond neighbours
_MOST_COVARIANCES = 1000  # rods whose covariances, a square table, are returned

Variables = dict[str, tuple[str | tuple[str, ...], Array]]


def steady_state(chain: Chain, *, correlations: bool = True) -> xr.Dataset:
    """Solve for the steady state of the gas in this module.

    Parameters
    ----------
    chain
        Up to 100 000 rods of one mass, with any restitution and any gap, on linear or quadratic
        springs, also between walls with a wall restitution above 0, and without springs in a box.
        At restitution 1 ``equilibrium`` is exact.
    correlations
        False: the mean field, in which colliding rods are independent. It is the theory of first
        order in 1 - e, and the only one for e > 1. There it is solved up to 0.85 of the critical
        size if the damping is 3 sqrt(k m), and further if it is weaker.

    Returns
    -------
    xarray.Dataset
        Over particle ``velocity_width``, ``displacement_width`` and ``mean_displacement``; over x
        ``density`` and ``label`` of the rods (``attrs["density_of"]``: of more than 10 000, or 3000
        with a gap, of a fluid), ``displacement``, ``velocity_variance`` and ``heat_flux`` of the
        gas; in a box ``wall_force`` over wall.

        With correlations, over ``contact`` (i with i + 1): ``neighbour_covariance`` <v_i v_{i+1}>,
        ``relative_temperature`` <(v_i - v_{i+1})^2>/2, ``contact_force`` and ``contact_loss``, the
        power that collisions take; over ``mode`` the ``mode_velocity_variance`` <|v_q|^2> of the
        waves cos(pi q (i - 1/2)/L), q = 0 being the centre of mass; up to 1000 rods over (particle,
        separation) the ``velocity_covariance`` <v_i v_{i+r}>, NaN beyond the chain.

        ``attrs``: ``residual``, the largest disagreement of mean state and fluctuations, and
        for e > 1 the share of points that the grid loses in a time m/gamma; ``iterations``; and
        the errors measured in simulations of chains like this one, or NaN:
        ``velocity_width_model_error`` and ``border_model_error``, relative, of W_v of the particles
        3 to L - 2 and of the first and the last; ``displacement_width_model_error``, relative;
        ``mean_displacement_model_error``, in thermal lengths; ``density_model_error``, of the
        smoothed density, relative to close packing; ``wall_force_model_error``, relative. An
        ``UnmeasuredWarning`` says that the first of these is not known.

    Raises
    ------
    ValueError
        For a chain without a steady state; for two masses; for absorbing walls; if mean state and
        fluctuations cannot be brought to agree.

    Notes
    -----
    It takes 0.1 s for 30 rods, half a second to two for 100, and up to 10 s for more than 200.

    Examples
    --------
    >>> theory = steady_state(Chain(size=30, restitution=0.5))
    >>> theory.velocity_width.values[[0, 7, 14]].round(3)
    array([0.236, 0.134, 0.122])
    """
    check_steady_state(chain, correlations=correlations)
    correlated = correlations and chain.restitution <= 1 and chain.size >= _FEWEST_CORRELATED
    solve = in_agreement if correlated else mean_field
    try:
        with threadpool_limits(limits=1, user_api="blas"):  # small matrices: more only wait
            found = solve(chain, make_cells(chain.size, walled=chain.box > 0))
    except NoSteadyStateError as error:
        raise ValueError(f"the gas has no steady state that could be found: {error}") from error
    state = _in_vocabulary(chain, found)
    # Below e = 1 the mean field was not measured.
    measured = correlations or chain.restitution >= 1
    errors = errors_of_steady_state(chain) if measured else Accuracy()
    warn_if_unmeasured("the steady state of the gas", errors.velocity_width)
    return state.assign_attrs(errors.named())


def check_steady_state(chain: Chain, *, correlations: bool = True) -> None:
    """Raise for what ``steady_state`` does not take."""
    require_chain(chain, "the gas in its steady state", knows=("box", "wall_restitution"))
    if not isinstance(correlations, bool):
        raise ValueError(f"correlations must be True or False, got {shown(correlations)}")
    if chain.size > _MOST_RODS:
        raise ValueError(f"size must be at most {_MOST_RODS}, got {chain.size}")
    if chain.wall_restitution == 0:
        raise ValueError("the gas needs walls that do not absorb: wall_restitution above 0, got 0")


class Rods(NamedTuple):
    """Moments of each rod in the units of the gas, shape (L,)."""

    place: Array
    width: Array  # W_x; NaN if it is not known
    velocity_variance: Array


def _in_vocabulary(chain: Chain, found: Steady) -> xr.Dataset:
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
    pairs = _of_pairs(chain, found, of, rods) if of else {}
    coordinates, fields = _over_positions(chain, found, rods)
    if of:
        coordinates["mode"] = np.arange(float(found.cells.rods.size))
    if "velocity_covariance" in pairs:
        coordinates["separation"] = np.arange(float(chain.size))
    return result(
        chain,
        variables | fields | pairs,
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
    own = found.descriptions.widths(medium, found.mean)
    middles: Array = np.arange(0.5, chain.size)
    place, T = (
        np.interp(middles, cells.centres, field)
        for field in (found.mean.place, found.mean.temperature)
    )
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
    farthest, shapes = float(np.abs(places).max() - chain.anchors[-1]), None
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
        farthest = max(farthest, float(np.abs(shapes.places).max() - chain.reduced_anchors[-1]))
    x = position_grid(chain, farthest)
    number = np.interp(x, places, label + chain.size / 2)
    number[x < places[0]], number[x > places[-1]] = 0.0, chain.size
    T = np.interp(number, np.arange(0.5, chain.size), rods.velocity_variance)
    fluid = np.gradient(np.interp(x, places, label), x)
    flux = _flux(found, number)
    density, count = over_positions(chain, x, shapes) if shapes else (fluid, number)
    variables: Variables = {
        "density": ("x", density),
        "label": ("x", count),
        "displacement": ("x", x - (2 * R + chain.lattice_gap) * (number - chain.size / 2)),
        "velocity_variance": ("x", W**2 * T),
        "heat_flux": ("x", chain.mass * W**3 / (2 * medium.length) * flux),
    }
    return {"x": x}, variables


def _flux(found: Steady, label: Array) -> Array:
    """Return n q at labels."""
    if found.labels is not None and found.flux is not None:
        where, flux = found.labels.fine.centres, found.flux
    else:
        mean, cells = found.mean, found.cells
        T, P = mean.contact_temperature, mean.force[cells.inner]
        through = conductance(found.medium, cells, T, P, found.closure.strength(T))
        where, flux = cells.contacts, -through * np.diff(mean.temperature)
    places, ends = (np.pad(field, 1) for field in (where, flux))
    places[-1] = found.medium.size
    return np.interp(label, places, ends)


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
