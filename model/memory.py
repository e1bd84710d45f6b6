"""Whether there is memory for what is asked for, before any of it is taken.

Linux grants more memory than there is and kills the process when it is used: a program that
allocates first and looks afterwards loses everything. So whoever is about to allocate in
proportion to what a user gave says how much, by the formula that its docstring states, and is
refused in time.
"""

from __future__ import annotations

import math
import os
from pathlib import Path

_GIB = 2**30


def require_memory(wanted: str, needed: float) -> None:
    """Raise a ValueError with both numbers unless ``needed`` bytes are available.

    ``wanted`` says what for, and begins with the name of the argument to change.
    """
    available = available_memory()
    if needed > available:
        raise ValueError(
            f"{wanted} would take {needed / _GIB:.3g} GiB of memory, "
            f"{available / _GIB:.3g} GiB are available"
        )


def available_memory() -> float:
    """Return the bytes that can be taken without swapping; where nobody knows, infinity."""
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            name, amount = line.split()[:2]
            if name == "MemAvailable:":
                return 1024.0 * int(amount)
    except OSError:
        pass  # not Linux
    try:
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return math.inf
