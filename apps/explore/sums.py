"""Running sums over a chain's motion: density, velocity widths and velocity distributions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.chain import middle_tenth
from crazybilliards.model.grid import deposit, position_grid, thermal_reach

Array = NDArray[np.float64]

_MOST_NODES = 2**18
# Velocity distributions reach to so many widths of a free rod. Flippers get faster than that.
_REACH, _REACH_OF_FLIPPERS = 6.0, 20.0
_BINS = 81


class Distributions(NamedTuple):
    """Probability densities of velocities, over ``v`` [R/T]."""

    v: Array
    border: Array  # of the two outermost rods, outward positive
    middle: Array  # of the middle tenth of the rods


class Sums:
    """Sums of the measurements since the first snapshot.

    Attributes
    ----------
    snapshots
        How many were added.
    x
        Nodes of the density [R]. The grid grows when a rod leaves it.
    squares
        Sums of v_i^2 [R^2/T^2], shape (L,).
    """

    def __init__(self, chain: Chain) -> None:
        self._chain = chain
        self.snapshots = 0
        # Flippers (e > 1) drive a chain apart by several times the free reach.
        driven = chain.restitution > 1
        self.x = position_grid(chain, thermal_reach(chain) * (5 if driven else 1))
        self._spacing = float(self.x[1] - self.x[0])
        self._weights = np.zeros(self.x.size)
        self.squares = np.zeros(chain.size)
        fastest = (_REACH_OF_FLIPPERS if driven else _REACH) * chain.free_velocity_width
        self._v = np.linspace(-fastest, fastest, _BINS)
        self._border, self._middle = np.zeros(_BINS), np.zeros(_BINS)
        self._centre = middle_tenth(chain.size)

    def add(self, positions: Array, v: Array) -> None:
        """Add a snapshot."""
        self._make_room(float(np.abs(positions[[0, -1]]).max()))
        deposit(positions, self.x[0], self._spacing, self._weights)
        self.squares += v * v
        first, spacing = self._v[0], self._v[1] - self._v[0]
        deposit(np.array([-v[0], v[-1]]), first, spacing, self._border)
        deposit(v[self._centre], first, spacing, self._middle)
        self.snapshots += 1

    def density(self) -> Array:
        """Density of the rods' centres [1/R], over ``x``."""
        return self._weights / (self.snapshots * self._spacing)

    def velocity_widths(self) -> Array:
        """Root mean square velocity of each rod [R/T]."""
        return np.asarray(np.sqrt(self.squares / self.snapshots))

    def distributions(self) -> Distributions:
        """Return the distributions of the velocities."""
        spacing = self._v[1] - self._v[0]
        both = [
            counts / max(counts.sum() * spacing, 1e-300) for counts in (self._border, self._middle)
        ]
        return Distributions(self._v, *both)

    def _make_room(self, reach: float) -> None:
        """Extend the grid on the same nodes if rods leave it."""
        room = self.x[-1] - 4 * self._chain.radius  # smoothing spreads a rod by that
        if reach < room:
            return
        half = (self.x.size - 1) // 2
        more = min(int(2 * reach / self._spacing), _MOST_NODES // 2) - half
        if more > 0:
            self.x = self._spacing * np.arange(-half - more, half + more + 1.0)
            self._weights = np.pad(self._weights, more)
