"""How kernels are compiled: cached on disk, without the global interpreter lock, IEEE arithmetic.

numba's cache notices when the file of a kernel changes. It does not notice when a kernel that it
calls changes in another file, and would run the old one. Cache entries made here therefore also
carry a fingerprint of all rooms that have kernels.

**No counting of references.** numba counts the references to every array that a function receives,
or takes out of a tuple, although the arrays of a kernel belong to the Python code that called it.
For a short chain this took far longer than the work. numba's ``_nrt=False`` switches the counting
off for kernels that allocate no memory. Where a later numba does not know this option, kernels
count again and are slower.

The cache only saves time. If it cannot be written, as in a container without a home or on a full
disk, kernels are compiled in every process, with one warning.
"""

from __future__ import annotations

import multiprocessing
import warnings
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numba import njit
from numba.core.options import DefaultOptions

from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.process import announce_compilation, interrupts_held_back

_ANEW = "the kernels are compiled anew in every process, which takes some seconds"
_warned: set[str] = set()


def _compiled(function: Callable[..., Any], *, fused: bool, allocates: bool, **options: Any) -> Any:
    """Return the function as numba's dispatcher."""
    if not allocates and hasattr(DefaultOptions, "_nrt"):
        options["_nrt"] = False
    fast = {"contract"} if fused else False
    return njit(nogil=True, error_model="numpy", fastmath=fast, **options)(function)


def kernel(
    function: Callable[..., Any] | None = None, *, fused: bool = False, allocates: bool = False
) -> Any:
    """Compile ``function`` when it is first called; a decorator.

    ``fused``: a multiplication and an addition may become one instruction with one rounding.
    ``allocates``: it makes arrays, or returns one. Otherwise numba refuses ("NRT required").
    """
    if function is None:
        return partial(kernel, fused=fused, allocates=allocates)
    dispatcher = _compiled(function, fused=fused, allocates=allocates)
    if not hasattr(dispatcher, "enable_caching"):  # compilation is disabled
        # Compiled code does not warn of numbers that are infinite or undefined.
        return np.errstate(all="ignore")(dispatcher)
    # Ctrl-C while numba registers its functions would leave it without them in this process.
    dispatcher.compile = interrupts_held_back()(dispatcher.compile)
    try:
        dispatcher.enable_caching()
    except RuntimeError:
        # The process that started this one has already warned.
        if multiprocessing.current_process().name == "MainProcess":
            _warn(_ANEW, "there is no folder for numba's cache; NUMBA_CACHE_DIR can name one")
        return dispatcher
    # numba has no public way to add to the stamp, or to let a cache fail. If a later numba lacks
    # the private names used here, its cache works unchanged.
    if (kept := getattr(dispatcher, "_cache", None)) is not None:
        _add_fingerprint(kept)
        _let_it_fail(kept)
    return dispatcher


def _add_fingerprint(kept: Any) -> None:
    """Add the fingerprint of all rooms with kernels to the stamp of an outdated cache."""
    entries = getattr(kept, "_cache_file", None)
    stamp = getattr(entries, "_source_stamp", None)
    if entries is not None and stamp is not None:
        entries._source_stamp = (stamp, room_fingerprint("model", "particles", "kinetic"))


def _let_it_fail(kept: Any) -> None:
    """Make a cache that cannot be read or written a warning; numba makes it an error."""
    load, save = kept.load_overload, kept.save_overload

    def load_if_possible(*arguments: Any) -> Any:
        found = None
        try:
            found = load(*arguments)
        except Exception as error:  # unpickling a damaged file can raise anything
            _warn("numba's cache cannot be read, compiling anew", f"{kept.cache_path}: {error}")
        if found is None:
            announce_compilation()
        return found

    def save_if_possible(*arguments: Any) -> None:
        try:
            save(*arguments)
        except Exception as error:  # saving reads what is there, too
            _warn(_ANEW, f"{kept.cache_path}: {error}; NUMBA_CACHE_DIR can name another folder")

    kept.load_overload, kept.save_overload = load_if_possible, save_if_possible


def _warn(problem: str, reason: str) -> None:
    """Warn of a problem once, and not again for every kernel."""
    if problem not in _warned:
        _warned.add(problem)
        warnings.warn(f"{problem}: {reason}", RuntimeWarning, stacklevel=3)


def inlined(
    function: Callable[..., Any] | None = None, *, fused: bool = False, once: bool = False
) -> Any:
    """Compile ``function`` into every kernel that calls it; a decorator.

    For helpers with many arrays, for which the call costs more than the work. ``fused``: as
    in :func:`kernel`. ``once``: one kernel calls it, without a ``*``. It becomes a part of that
    kernel before anything is compiled. Otherwise it is compiled alone first, and all that it calls
    is optimised once more with it, which takes seconds for what calls all operators. It is not for
    what a loop calls with tuples of many arrays: they would be copied at every call.
    """
    if function is None:
        return partial(inlined, fused=fused, once=once)
    how = {"inline": "always"} if once else {"forceinline": True}
    return _compiled(function, fused=fused, allocates=False, **how)


@inlined
def copy(source, target):  # type: ignore[no-untyped-def]
    """Copy a one-dimensional array: numba compiles ``target[:] = source`` for seconds.

    It would compile the message of an error, of arrays that do not fit, with all of its strings.
    """
    for i in range(source.size):
        target[i] = source[i]
