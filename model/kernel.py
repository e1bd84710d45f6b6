"""How kernels are compiled: cached on disk, without the global interpreter lock, IEEE arithmetic.

numba's cache notices when the file of a kernel changes, but not when a kernel that it calls
changes in another file: it would go on running the old one. So the cache entries made here also
carry a fingerprint of every source file of the kernel's folder.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from numba import njit


def kernel(function: Callable[..., Any]) -> Any:
    """Compile ``function`` when it is first called; a decorator."""
    dispatcher = njit(cache=True, nogil=True, error_model="numpy")(function)
    # numba has no public way to add to the stamp. Where this one is gone (or compilation is
    # disabled), the cache works as numba made it.
    entries = getattr(getattr(dispatcher, "_cache", None), "_cache_file", None)
    stamp = getattr(entries, "_source_stamp", None)
    if entries is not None and stamp is not None:
        entries._source_stamp = (stamp, _fingerprint(Path(inspect.getfile(function)).parent))
    return dispatcher


def inlined(function: Callable[..., Any]) -> Any:
    """Compile ``function`` into every kernel that calls it; a decorator.

    For helpers that take many arrays, which cost more to hand over than to work on.
    """
    return njit(nogil=True, error_model="numpy", forceinline=True)(function)


@cache
def _fingerprint(folder: Path) -> str:
    sources = sorted(folder.glob("*.py"))
    return hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()
