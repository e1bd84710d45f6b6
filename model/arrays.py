"""Arrays: the type of most of them, and the check of those that a user gives."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.checks import refuse_units, shown

Array = NDArray[np.float64]


def check_numbers(name: str, values: object) -> Array:
    """Return ``values`` as an array of floats, or raise a ValueError that names the argument."""
    refuse_units(name, values)
    try:
        # numpy would make numbers of None, texts, dates, complex ones, and what lies under a mask.
        kind = np.asarray(values).dtype.kind
        if values is not None and kind not in "SUMmc" and not np.ma.is_masked(values):
            return np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"{name} must be numbers, got {shown(values)}")


def merge_pairs(blocks: NDArray[Any]) -> None:
    """Add up neighbours along the first axis in place; the second half is then free, and 0."""
    half = len(blocks) // 2
    blocks[:half] = blocks[0::2] + blocks[1::2]
    blocks[half:] = 0


def middle_tenth(places: int) -> slice:
    """Return the middle tenth of so many rods or contacts: ``abs(i - (L+1)/2) <= L/20``.

    It is 10 of 100, 9 of 99 and 4 of 30. There are always the one or two in the middle.
    """
    first = min((9 * places + 9) // 20, (places - 1) // 2)
    return slice(first, places - first)
