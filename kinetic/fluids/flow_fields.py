"""The fields on positions at the output times, which both frames of hydrodynamics return."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
