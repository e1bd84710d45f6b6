"""Output times of theories in time, from a duration and a time between outputs."""

from __future__ import annotations

import numpy as np

from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_real

_MOST = 1_000_000


def output_times(duration: float | None, every: float | None, number: int) -> Array:
    """Return the times 0, every, 2 every, ... up to the first one not before ``duration`` [T].

    ``every`` None: ``number`` outputs after the start.
    """
    duration = check_real("duration", duration, positive=True)
    every = duration / number if every is None else check_real("every", every, positive=True)
    if every > duration * (1 + 1e-9):
        raise ValueError(f"every must be at most the duration {duration:g}, got {every:g}")
    count = np.ceil(duration / every - 1e-9)
    if count > _MOST:
        raise ValueError(f"every = {every:g} asks for {count:.1g} outputs, {_MOST} at most")
    return every * np.arange(count + 1)
