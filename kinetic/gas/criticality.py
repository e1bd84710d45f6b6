r"""Chains with e > 1: the critical size, and the rate of growth, on linear springs.

**Weak damping.** On linear springs every pair of rods meets once in half a period, whatever the
amplitude, and gains the fraction e^2 - 1 of its relative energy. The relative energies of all pairs
add up to L/2 times the energy E of the chain, and damping takes out gamma/m E per time. The energy
of a chain so hot that the noise does not count therefore obeys

    E' = [(e^2 - 1) L sqrt(k/m)/(2 pi) - gamma/m] E.

To first order in e - 1 the growth vanishes at the size

    L_c = pi gamma/((e - 1) sqrt(k m)).

The rate above vanishes at a size that is smaller by the factor 2/(1 + e).

**Any damping.** A chain so hot that the noise does not count has no unit of its own: its positions
and velocities can be scaled by any factor. The gas of :mod:`crazybilliards.kinetic.gas` is then
linear in the scale of T, and its steady state ends where

    conduction(T) + 2 Gamma T = kappa n T^(3/2) 8/sqrt(pi),      kappa = L_c (e - 1)/2,

has a solution: an eigenvalue kappa(Gamma). Its truncated heat flux leaves the ends of the chain too
cold for strong damping, where kappa is too small. The kinetic equation of first order in e - 1 was
solved for Gamma from 1e-3 to 3.5. Its values lie between this one and that of weak damping,
kappa = (pi/2) Gamma, and much nearer to the latter: within 0.01 % for Gamma <= 0.5 and 1.2 % at 3.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh
from threadpoolctl import threadpool_limits

from crazybilliards.kinetic.gas.cells import cells_of_points
from crazybilliards.kinetic.gas.collision_moments import moments_of_collisions
from crazybilliards.kinetic.gas.mean_state import (
    Medium,
    NoSteadyStateError,
    balanced,
    between,
    first_places,
    heat_operator,
)
from crazybilliards.kinetic.requirements import require_chain
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.words import check_chain

_SMALL = 1e-6  # of e - 1: first order
_MOST_TURNS, _MIXED, _SAME = 300, 0.5, 1e-6
_STRONGEST = 10.0  # damping of a gas that was solved


class CriticalValue(NamedTuple):
    """A critical value and its error."""

    value: float
    error: float


@threadpool_limits.wrap(limits=1, user_api="blas")  # small matrices: more only wait
def critical_size(chain: Chain) -> CriticalValue:
    """Return the number of rods from which on a chain with e > 1 has no steady state.

    The value is that of weak damping, and the error its distance from that of the gas, to first
    order in e - 1. ``chain.size`` and ``chain.gap`` do not matter. It takes half a second; a second
    call with the same damping takes no time.

    Raises
    ------
    ValueError
        For e <= 1, where chains of every size have a steady state; for quadratic springs, where
        no chain has one; for two masses or a box; for a damping above 10 sqrt(k m).

    Examples
    --------
    >>> critical = critical_size(Chain(restitution=1.05, damping=4.0))
    >>> round(critical.value)
    123
    """
    _require_drive(chain)
    drag, share = weak_damping_drag(chain.relative_damping), (chain.restitution - 1) / 2
    error = abs(drag - _drag_of_the_gas(chain.relative_damping))
    return CriticalValue(drag / share, error / share)


def _require_drive(chain: Chain) -> None:
    """Raise if the chain has no critical size."""
    check_chain(chain)
    if chain.restitution <= 1:
        raise ValueError(
            "every size has a steady state unless restitution is above 1, got "
            f"{chain.restitution:g}"
        )
    if chain.spring != "linear":
        raise ValueError(
            "with quadratic springs and e > 1 there is no critical size: rods collide the more "
            "often the faster they are, and a fluctuation large enough always runs away"
        )
    require_chain(chain, "the critical size", steady=False)
    for name in ("damping", "stiffness"):
        if getattr(chain, name) == 0:
            raise ValueError(f"{name}=0: no size has a steady state with e > 1")
    if chain.relative_damping > _STRONGEST:
        raise ValueError(
            f"gamma/sqrt(k m) = {chain.relative_damping:.3g} is too strong a damping: the critical "
            f"size is known up to {_STRONGEST:g}"
        )


@lru_cache(maxsize=256)
def _drag_of_the_gas(damping: float) -> float:
    """Return kappa, with one rod in the place of L: all labels are shares of the chain."""
    cells, drag = cells_of_points(1), weak_damping_drag(damping)
    decay = moments_of_collisions(1 - _SMALL).decay / _SMALL * 2
    medium = Medium(1, 1.0, damping, 1.0, 2, 0.0, math.inf, 0.0, -8 / math.sqrt(math.pi), -decay)
    T, y, none = np.ones(cells.rods.size), first_places(medium, cells), np.zeros(cells.rods.size)
    for _ in range(_MOST_TURNS):
        balance = balanced(medium, cells, y, between(T, False), none)
        y, strength = balance.place, np.full(cells.contacts.size, drag)
        conducted, across, gained, gained_across = heat_operator(
            medium, cells, T, balance, strength
        )
        taken = _matrix(2 * damping * cells.rods + conducted, across)
        shares, shapes = eigh(_matrix(-gained, -gained_across) / drag, taken)
        new, shape = 1 / shares[-1], np.abs(shapes[:, -1])
        shape /= shape @ cells.rods
        change = max(abs(new / drag - 1), float(np.abs(shape - T).max()))
        drag, T = drag + _MIXED * (new - drag), T + _MIXED * (shape - T)
        if change < _SAME:
            return float(drag)
    raise NoSteadyStateError(f"the critical state still changes by {change:.2g}")


def _matrix(diagonal: Array, beside: Array) -> Array:
    return np.asarray(np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1))


def weak_damping_drag(damping: float) -> float:
    """Return the critical (e - 1) L/2 for a damping gamma/sqrt(k m)."""
    return math.pi / 2 * damping


def weak_damping_growth_rate(chain: Chain) -> float:
    """Return E'/E [1/t_0], without an expansion in e - 1.

    Simulated chains grow at this rate within 5 % if they have L >= 30 rods, (e^2 - 1) L/2 <= 1.05,
    gamma <= sqrt(k m)/4 and L >= 1.5 L_c, on linear springs without a gap. At (e^2 - 1) L/2 = 3
    they grow 16 % faster, and 10 rods grow 10 % more slowly. With a gap rods meet less often, and
    may not run away at all.
    """
    meetings = math.sqrt(chain.stiffness / chain.mass) / math.pi  # of a pair, per time
    gain = (chain.restitution**2 - 1) / 2 * chain.size * meetings
    return gain - chain.damping / chain.mass
