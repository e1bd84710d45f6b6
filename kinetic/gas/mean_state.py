r"""The steady mean state of the gas: two tridiagonal equations in turn.

The equations are those of :mod:`crazybilliards.kinetic.gas` at V = 0, divided onto cells of labels.
A cell of N rods has a place y and a temperature T. Between two cells lies a contact, and in a box
one between the outermost cells and the walls, with the mean gap g = dy/dl and T of both sides:

    P(right) - P(left) = -N F(y - y0),                P = phi T/g,
    2 Gamma N (1 - h - T) = flux(right) - flux(left) + half of the loss at both contacts,
    flux = -3 n^2 T/r dT/dl,      n = P/T,            loss = a zeta n T^(3/2) dl.

At a wall half of the velocities are smaller by e_w. There T = e_w T(incoming), because slow rods
stay longer, and the loss is (1 - e_w) P sqrt(8/pi) sqrt(T/e_w).

**Quadratic springs** have the mean force K <(x + u) |x + u|> where a place is displaced by x + u. x
is its mean displacement, and u is Gaussian with the variance h_uu of neighbourhoods. A rod also has
the local variance T/sqrt(k^2 + 4 k T/g^2) of a lattice of springs k whose neighbours repel one
another with the stiffness T/g^2. Fluctuations of rods feel the mean slope k = 2 K <|x + u|>.
"""

from collections.abc import Callable
from typing import NamedTuple, Self

import numpy as np
from scipy.linalg import solve_banded
from scipy.special import erf, ndtri

from crazybilliards.kinetic.gas.cells import Cells, means
from crazybilliards.kinetic.gas.collision_moments import CollisionMoments, moments_of_collisions
from crazybilliards.model import Array, Chain

_SAME = 1e-7  # relative change of T, from which on it has converged
_MOST_TURNS, _MOST_STEPS, _TURNS_OF_SLOPE = 400, 100, 20
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
    restitution: float
    moments: CollisionMoments

    @classmethod
    def of(cls, chain: Chain) -> Self:
        """Make the medium of a chain."""
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
            chain.restitution,
            moments_of_collisions(chain.restitution),
        )

    def anchors(self, cells: Cells) -> Array:
        """Return y0 of the cells."""
        return np.asarray(self.lattice * (cells.centres - self.size / 2))


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
    if not cells.walled:
        return ndtri(cells.centres / medium.size) + medium.anchors(cells)
    free = 1.8 * medium.wall / medium.size
    gap = min(medium.lattice, free) if medium.lattice else free
    return np.asarray((cells.centres - medium.size / 2) * gap)


def balanced(medium: Medium, cells: Cells, y: Array, stress: Array, spread: Array) -> Balance:
    """Balance the forces from places y on, by Newton's method.

    ``stress``: P g = phi T at all contacts. ``spread``: h_uu at the cells.
    """
    pressure, anchors, last = stress * cells.all_distances, medium.anchors(cells), np.inf
    for _ in range(_MOST_STEPS):
        room = _steps(y, medium.wall)
        F, slope = mean_force(medium, y - anchors, spread)
        P = pressure / room
        left, right = cells.sides(P)
        off = left - right - cells.rods * F
        stiffness = cells.rods * slope + np.add(*cells.sides(P / room))
        step = _solve_banded(stiffness, -(P / room)[cells.inner], off)
        change = _steps(step, 0.0 if cells.walled else np.inf)
        closing = change < 0
        share = min(1.0, float((-_CLOSER * room[closing] / change[closing]).min(initial=1.0)))
        y = y + share * step
        largest = float(np.abs(change / room).max())
        # Gaps at walls are so small that rounding may stay above the first limit.
        if share == 1 and (largest < 1e-11 or last <= largest < 1e-6):
            break
        last = largest
    room = _steps(y, medium.wall)
    return Balance(y, room / cells.all_distances, pressure / room)


def mean_force(medium: Medium, x: Array, variance: Array) -> tuple[Array, Array]:
    """Return the mean of F and of its slope where x is Gaussian with this variance."""
    K = medium.stiffness
    if medium.exponent == 2:
        return K * x, np.full(x.size, K)
    width = np.sqrt(np.maximum(variance, 1e-12))
    beyond = erf(x / width / np.sqrt(2))
    gauss = width * np.sqrt(2 / np.pi) * np.exp(-((x / width) ** 2) / 2)
    return K * ((x**2 + width**2) * beyond + x * gauss), 2 * K * (gauss + x * beyond)


def mean_slope(medium: Medium, x: Array, T: Array, gap: Array | float, spread: Array) -> Array:
    """Return k of quadratic springs at the cells. ``spread``: h_uu."""
    k = np.full(x.size, 2 * medium.stiffness)
    for _ in range(_TURNS_OF_SLOPE):
        local = T / np.sqrt(k**2 + 4 * k * T / gap**2)
        k = mean_force(medium, x, local + np.maximum(spread, 0.0))[1]
    return k


def heated(
    medium: Medium,
    cells: Cells,
    T: Array,
    forces: Callable[[Array], Balance],
    strength: Callable[[Array], Array],
    shared: Array,
) -> tuple[Array, Balance]:
    """Balance the heat, beginning with the temperatures T of the cells.

    ``forces``: of temperatures. ``strength``: a, of T at the M - 1 contacts. ``shared``: h.
    """
    noise = 2 * medium.damping * cells.rods
    for _ in range(_MOST_TURNS):
        balance, middle = forces(T), means(T)
        P, a = balance.force[cells.inner], strength(middle)
        conducted = conductance(medium, cells, middle, P, a)
        # Linear in T with the last coefficients. Each side has half of the loss, half by its own T.
        lost = a * medium.moments.energy * P * np.sqrt(middle) / middle * cells.distances / 4
        taken = noise + sum(np.pad(conducted + lost, each) for each in ((0, 1), (1, 0)))
        if cells.walled:
            taken[[0, -1]] += medium.wall_loss * balance.force[[0, -1]] / np.sqrt(T[[0, -1]])
        new = _solve_banded(taken, lost - conducted, noise * (1 - shared))
        if not (np.isfinite(new).all() and (new > 0).all()):
            raise NoSteadyStateError("collisions give more than damping takes")
        change = float(np.abs(np.log(new / T)).max())
        T = T + _MIXED * (np.maximum(new, _COLDEST * T) - T)
        if change < _SAME:
            return T, forces(T)
    raise NoSteadyStateError(f"the mean state still changes by {change:.2g}")


def conductance(medium: Medium, cells: Cells, T: Array, P: Array, strength: Array) -> Array:
    """Return the heat flux between cells over the difference of their T, with the sign changed."""
    n = P / T
    least = -_LARGEST_GAIN * 3 * medium.damping
    decay = np.maximum(strength * medium.moments.decay * n * np.sqrt(T), least)
    return np.asarray(3 * n**2 * T / (3 * medium.damping + decay) / cells.distances)


def _solve_banded(diagonal: Array, beside: Array, right: Array) -> Array:
    """Solve a symmetric tridiagonal system."""
    bands = np.zeros((3, diagonal.size))
    bands[0, 1:], bands[1], bands[2, :-1] = beside, diagonal, beside
    return np.asarray(solve_banded((1, 1), bands, right))


def _steps(y: Array, wall: float) -> Array:
    """Return the differences of neighbouring places, to walls at -wall and wall as well."""
    return np.diff(y, prepend=-wall, append=wall) if np.isfinite(wall) else np.diff(y)
