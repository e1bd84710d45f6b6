"""Observers: what is measured. A new measurement is a class in a file here and a line below.

No kernel changes for it: the kernels fill buffers of snapshots, observers consume them.
"""

from crazybilliards.particles.observers.avalanches import Avalanches
from crazybilliards.particles.observers.base import Integers, Observer, Plan, Snapshots, Variables
from crazybilliards.particles.observers.collisions import Collisions
from crazybilliards.particles.observers.density import Density
from crazybilliards.particles.observers.energy import Energy
from crazybilliards.particles.observers.raw import Raw
from crazybilliards.particles.observers.velocities import Velocities
from crazybilliards.particles.observers.widths import Widths

OBSERVERS: dict[str, type[Observer]] = {
    "widths": Widths,
    "density": Density,
    "velocities": Velocities,
    "energy": Energy,
    "collisions": Collisions,
    "avalanches": Avalanches,
    "snapshots": Raw,
}

__all__ = ["OBSERVERS", "Avalanches", "Integers", "Observer", "Plan", "Snapshots", "Variables"]
