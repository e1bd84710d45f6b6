"""The points of a fit: columns of numbers, equally long."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.arrays import check_numbers
from crazybilliards.model.checks import shown


def check_points(**columns: object) -> list[NDArray[np.float64]]:
    """Return the columns as arrays; a ValueError names the arguments that do not fit."""
    arrays = [check_numbers(name, values) for name, values in columns.items()]
    shapes = [array.shape for array in arrays]
    if len(set(shapes)) > 1 or arrays[0].ndim != 1:
        raise ValueError(
            f"{', '.join(columns)} must have one dimension and the same length, got the shapes "
            f"{', '.join(map(str, shapes))}"
        )
    for name, array in zip(columns, arrays, strict=True):
        if not np.isfinite(array).all():
            raise ValueError(f"{name} must be finite, got {shown(columns[name])}")
    return arrays
