"""Check that there is enough memory, before any of it is allocated.

Linux grants more memory than there is, and kills the process when the memory is used. A process
that allocates without checking can therefore lose its results. A function whose memory grows with
its arguments estimates it by the formula in its docstring and calls :func:`require_memory`, which
raises a ValueError if the estimate is too large.
"""

from __future__ import annotations

import math
import time
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from crazybilliards.model.control_groups import limiting_groups

_GIB = 2**30
_LATELY = 0.1  # seconds; a look-up takes half a millisecond, and a sweep makes one for every case


def require_memory(wanted: str, needed: float) -> None:
    """Raise a ValueError with both numbers unless ``needed`` bytes are available.

    ``wanted`` says what the memory is for, and begins with the name of the argument to change. The
    available memory is looked up at most ten times a second.
    """
    available = _available_lately(int(time.monotonic() / _LATELY))
    if needed > available:
        raise ValueError(
            f"{wanted} would take {needed / _GIB:.3g} GiB of memory, "
            f"{available / _GIB:.3g} GiB are available"
        )


@lru_cache(maxsize=1)
def _available_lately(moment: int) -> float:
    return available_memory()


def available_memory(root: Path = Path("/")) -> float:
    """Return the bytes that can be allocated without swapping, on Linux, macOS and Windows.

    A container or a batch job may have less memory than the machine: Linux kills a process that
    exceeds the limit of its control group or of an enclosing group. The smallest number counts.
    ``root`` is for tests.
    """
    import psutil  # here, because most commands allocate little and start sooner without it

    of_the_machine = float(psutil.virtual_memory().available)
    return min([of_the_machine, *map(_left, limiting_groups(root))])


def _left(group: Path) -> float:
    """Return the limit of a group minus its usage, without the cached files it can drop."""
    try:
        limit, used = ((group / f"memory.{name}").read_text() for name in ("max", "current"))
        left = int(limit) - int(used)
    except (OSError, ValueError):  # the outermost group has none; "max" is no number
        return math.inf
    with suppress(OSError, ValueError, KeyError):
        statistics = dict(line.split() for line in (group / "memory.stat").read_text().splitlines())
        left += int(statistics["inactive_file"])
    return max(float(left), 0.0)
