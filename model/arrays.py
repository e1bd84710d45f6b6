"""Arrays: the type of most of them, and the check of those that a user gives."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.checks import shown

Array = NDArray[np.float64]


def check_numbers(name: str, values: object) -> Array:
    """Return ``values`` as an array of floats, or raise a ValueError that names the argument."""
    try:
        if values is not None:  # numpy would make a NaN of it
            return np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"{name} must be numbers, got {shown(values)}")
