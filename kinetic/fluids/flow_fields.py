"""The fields on positions at the output times, which both frames of hydrodynamics return."""

from __future__ import annotations

from typing import NamedTuple

from crazybilliards.model.arrays import Array


class FlowFields(NamedTuple):
    """Fields in the chain's units."""

    x: Array  # (nodes,)
    density: Array  # (times, nodes)
    label: Array
    velocity: Array
    variance: Array
    rods: Array  # positions of the rods, (times, L)
    rod_velocities: Array
    cells: int
    unsteadiness: Array  # rms rate of change of eta and V in scaled units, (times,)
