r"""The steady mean state of the gas: two tridiagonal equations in turn.

The equations are those of :mod:`crazybilliards.kinetic.gas` at V = 0, divided onto cells of labels.
A cell of N rods has a place y and a temperature T. Between two cells lies a contact, and in a box
one between the outermost cells and the walls, with the mean gap g = dy/dl and T of both sides:

    P(right) - P(left) = -N F(y - y0),                P = phi T/g,
    2 Gamma N (1 - h - T) = flux(right) - flux(left) + half of the loss at both contacts,
    flux = -3 n^2 T/r dT/dl,      n = P/T,            loss = a E n T^(3/2) dl.

An elastic wall takes nothing: the rod at it loses energy at one contact only, and is hotter. At an
inelastic one half of the velocities are smaller by e_w. There T = e_w T(incoming), because slow
rods stay longer, and the loss is (1 - e_w) P sqrt(8/pi) sqrt(T/e_w).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_banded
from scipy.special import erf, ndtri

from crazybilliards.kinetic.gas.cells import Cells
from crazybilliards.kinetic.gas.collision_moments import moments_of_collisions
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_SAME = 1e-7  # relative change of T, from which on it has converged
_MOST_TURNS, _MOST_STEPS = 400, 100
_MIXED = 0.7  # share of a new T
_CLOSER = 0.8  # a step may take so much of any gap
_LARGEST_GAIN = 0.99  # of a third moment by collisions at e > 1, over its damping
_COLDEST = 0.3  # of T, in one turn


class NoSteadyStateError(ValueError):
    """The mean state runs away, or was not found."""


class Medium(NamedTuple):
    """A chain in the units of the gas."""

    size: int
    length: float  # u [R]
    damping: float  # Gamma
    stiffness: float  # of a spring, F = K x |x|^(n-2)
    exponent: int  # n
    lattice: float  # distance of the anchors
    wall: float  # place of the right wall; inf: open ends
    wall_loss: float  # of v^2, in units of P sqrt(T)
    energy: float  # E(e)
    decay: float  # c(e)

    @classmethod
    def of(cls, chain: Chain) -> Medium:
        """Make the medium of a chain."""
        moments = moments_of_collisions(chain.restitution)
        length, n = unit_length(chain), chain.potential_exponent
        springs, e_w = chain.stiffness > 0, chain.wall_restitution
        return cls(
            chain.size,
            length,
            chain.damping * length / (chain.mass * chain.free_velocity_width),
            (length / chain.thermal_length) ** n if springs else 0.0,
            n,
            chain.lattice_gap / length if springs else 0.0,
            chain.walls[1] / length,
            (1 - e_w) * np.sqrt(8 / (np.pi * e_w)),
            moments.energy,
            moments.decay,
        )

    @property
    def walled(self) -> bool:
        """True in a box."""
        return bool(np.isfinite(self.wall))


def unit_length(chain: Chain) -> float:
    """Return u: the thermal length or, where it is shorter, the room of a rod [R]."""
    room = 2 * chain.walls[1] / chain.size
    return min(chain.thermal_length, room) if chain.stiffness > 0 else room


class Balance(NamedTuple):
    """Places of M cells where forces balance, and what acts at all K contacts, walls included."""

    place: Array  # y, (M,)
    gap: Array  # g, (K,)
    force: Array  # P, (K,)


def first_places(medium: Medium, cells: Cells) -> Array:
    """Return places to begin with."""
    label = cells.centres - medium.size / 2
    if not medium.walled:
        return ndtri(cells.centres / medium.size) + medium.lattice * label
    free = 1.8 * medium.wall / medium.size
    return label * (min(medium.lattice, free) if medium.lattice else free)


def balanced(medium: Medium, cells: Cells, y: Array, stress: Array, spread: Array) -> Balance:
    """Balance the forces from places y on, by Newton's method.

    ``stress``: P g = phi T at all contacts. ``spread``: h_uu at the cells, which changes the mean
    force of quadratic springs.
    """
    N, d = cells.rods, cells.all_distances(medium.walled)
    pressure, anchor = stress * d, medium.lattice * (cells.centres - medium.size / 2)
    for _ in range(_MOST_STEPS):
        room = _steps(y, medium.wall)
        F, slope = _mean_force(medium, y - anchor, spread)
        P = pressure / room
        left, right = sides(P, medium.walled)
        stiff_left, stiff_right = sides(P / room, medium.walled)
        inner = (P / room)[1:-1] if medium.walled else P / room
        bands = banded(N * slope + stiff_left + stiff_right, -inner)
        step = solve_banded((1, 1), bands, left - right - N * F)
        change = _steps(step, 0.0 if medium.walled else np.inf)
        closing = change < 0
        share = min(1.0, float((-_CLOSER * room[closing] / change[closing]).min(initial=1.0)))
        y = y + share * step
        if share == 1 and np.abs(change / room).max() < 1e-11:
            break
    room = _steps(y, medium.wall)
    return Balance(y, room / d, pressure / room)


def _mean_force(medium: Medium, x: Array, spread: Array) -> tuple[Array, Array]:
    """Return the mean of F and of its slope where x is Gaussian with the variance ``spread``."""
    K = medium.stiffness
    if medium.exponent == 2:
        return K * x, np.full(x.size, K)
    width = np.sqrt(np.maximum(spread, 1e-12))
    beyond = erf(x / width / np.sqrt(2))
    gauss = width * np.sqrt(2 / np.pi) * np.exp(-((x / width) ** 2) / 2)
    return K * ((x**2 + width**2) * beyond + x * gauss), 2 * K * (gauss + x * beyond)


def heated(
    medium: Medium,
    cells: Cells,
    T: Array,
    forces: Callable[[Array], Balance],
    strength: Callable[[Array], Array],
    shared: Array | float,
) -> tuple[Array, Balance]:
    """Balance the heat, beginning with the temperatures T of the cells.

    ``forces``: the balance of the forces at temperatures. ``strength``: a at the M - 1 contacts,
    of T there. ``shared``: h at the cells, what neighbourhoods share.
    """
    noise = 2 * medium.damping * cells.rods
    for _ in range(_MOST_TURNS):
        balance = forces(T)
        conducted, across, lost, lost_across = heat_operator(
            medium, cells, T, balance, strength((T[1:] + T[:-1]) / 2)
        )
        bands = banded(noise + conducted + lost, across + lost_across)
        new = np.asarray(solve_banded((1, 1), bands, noise * (1 - shared)))
        if not (np.isfinite(new).all() and (new > 0).all()):
            raise NoSteadyStateError("collisions give more than damping takes")
        change = float(np.abs(np.log(new / T)).max())
        T = T + _MIXED * (np.maximum(new, _COLDEST * T) - T)
        if change < _SAME:
            return T, forces(T)
    raise NoSteadyStateError(f"the mean state still changes by {change:.2g}")


def heat_operator(
    medium: Medium, cells: Cells, T: Array, balance: Balance, strength: Array
) -> tuple[Array, Array, Array, Array]:
    """Return conduction and loss of the cells, both linear in T: their diagonals and side ones.

    The coefficients are those of T.
    """
    d, middle = cells.distances, (T[1:] + T[:-1]) / 2
    force = balance.force[1:-1] if medium.walled else balance.force
    n = force / middle
    collisions = n * np.sqrt(middle)
    decay = collisions * strength * medium.decay
    rate = 3 * medium.damping + np.maximum(decay, -_LARGEST_GAIN * 3 * medium.damping)
    conduction = 3 * n**2 * middle / rate / d
    loss = strength * medium.energy * collisions * d / 4  # half of it for T of each side
    of_conduction, of_loss = (np.add(*sides(values, False)) for values in (conduction, loss))
    if medium.walled:
        ends = [0, -1]
        of_loss[ends] += medium.wall_loss * balance.force[ends] / np.sqrt(T[ends])
    return of_conduction, -conduction, of_loss, loss


def banded(diagonal: Array, beside: Array) -> Array:
    """Return a symmetric tridiagonal matrix as scipy's ``solve_banded`` takes it."""
    return np.array([np.append(0.0, beside), diagonal, np.append(beside, 0.0)])


def between(at_cells: Array, walled: bool) -> Array:
    """Return the means at all contacts; at a wall the value of its cell."""
    means = (at_cells[1:] + at_cells[:-1]) / 2
    return np.concatenate([at_cells[:1], means, at_cells[-1:]]) if walled else means


def sides(at_contacts: Array, walled: bool) -> tuple[Array, Array]:
    """Return what lies left and right of each cell, 0 beyond open ends."""
    if walled:
        return at_contacts[:-1], at_contacts[1:]
    return np.append(0.0, at_contacts), np.append(at_contacts, 0.0)


def _steps(y: Array, wall: float) -> Array:
    """Return the differences of neighbouring places, to walls at -wall and wall as well."""
    return np.diff(np.concatenate([[-wall], y, [wall]]) if np.isfinite(wall) else y)
