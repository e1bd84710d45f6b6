"""What the equations of pairs need to know of a chain, made once."""

from __future__ import annotations

from typing import NamedTuple

from crazybilliards.kinetic.correlations.cells import Cells, make_cells
from crazybilliards.kinetic.correlations.collision_moments import (
    CollisionMoments,
    moments_of_collisions,
)
from crazybilliards.kinetic.kinetic_equation.continuation import free_units
from crazybilliards.kinetic.kinetic_equation.weak_form import coefficients
from crazybilliards.model import Chain


class Problem(NamedTuple):
    """A chain, its cells, what a collision does, and the damping in free units."""

    chain: Chain
    cells: Cells
    moments: CollisionMoments
    damping: float

    @classmethod
    def of(cls, chain: Chain) -> Problem:
        """Make the problem of a chain."""
        moments = moments_of_collisions(chain.restitution)
        damping = coefficients(chain, free_units(chain), 2).damping
        return cls(chain, make_cells(chain.size), moments, damping)

    def on_whole_cells(self) -> Problem:
        """Return the problem with cells none of which is shorter than a rod."""
        return self._replace(cells=make_cells(self.chain.size, whole=True))
