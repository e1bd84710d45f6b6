"""How kernels are compiled: cached on disk, without the global interpreter lock, IEEE arithmetic.

numba's cache notices when the file of a kernel changes, but not when a kernel that it calls changes
in another file. Cache entries made here therefore carry a fingerprint of all rooms that have
kernels. If the cache cannot be written, as in a container without a home or on a full disk, kernels
are compiled in every process, with one warning.

**No counting of references.** numba counts the references to every array that a function receives,
or takes out of a tuple, although the arrays of a kernel belong to the Python code that called it.
For a short chain this takes far longer than the work. numba's ``_nrt=False`` switches the counting
off for kernels that allocate no memory. A numba that does not know this option counts again.
"""

import multiprocessing
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache, partial, wraps
from typing import Any

import numpy as np
from numba import njit
from numba.core.options import DefaultOptions

from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.process import interrupts_noted

# With unsigned indices compiled code need not check for indices from the end of an array.
INDEX = np.uint64

_to_announce: ContextVar[bool] = ContextVar("to_announce", default=False)


@contextmanager
def announced(progress: bool) -> Iterator[None]:
    """Print once that kernels are being compiled, if a kernel is not in numba's cache."""
    before = _to_announce.set(progress)
    try:
        yield
    finally:
        _to_announce.reset(before)


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

    ``fused``: a multiplication and an addition may become one instruction. ``allocates``: it makes
    or returns arrays, which numba refuses otherwise ("NRT required").
    """
    if function is None:
        return partial(kernel, fused=fused, allocates=allocates)
    dispatcher = _compiled(function, fused=fused, allocates=allocates)
    if not hasattr(dispatcher, "enable_caching"):  # compilation is disabled
        # Compiled code does not warn of numbers that are infinite or undefined.
        return np.errstate(all="ignore")(dispatcher)
    dispatcher.compile = _in_one_piece(dispatcher.compile)
    try:
        dispatcher.enable_caching()
    except RuntimeError:
        _warn("there is no folder for it")
        return dispatcher
    # These names of numba are private. Without them its cache works unchanged.
    disk = getattr(dispatcher, "_cache", None)
    index: Any = getattr(disk, "_cache_file", None)
    if hasattr(index, "_source_stamp"):
        index._source_stamp = index._source_stamp, room_fingerprint("model", "particles", "kinetic")
        _let_it_fail(disk)
    return dispatcher


def _in_one_piece(compile_: Callable[..., Any]) -> Callable[..., Any]:
    """Let Ctrl-C act after the compilation: numba would lose functions that it registers in it."""

    @wraps(compile_)
    def compile_whole(*arguments: Any) -> Any:
        with interrupts_noted() as signals:
            compiled = compile_(*arguments)
        if signals:
            raise KeyboardInterrupt
        return compiled

    return compile_whole


def _let_it_fail(disk: Any) -> None:
    """Make a cache that cannot be written a warning, and empty a damaged one.

    numba makes either an error. What names a class that has moved since cannot be read, either.
    """
    read = disk.load_overload

    def attempt(work: Callable[..., Any]) -> Callable[..., Any]:
        def attempted(*arguments: Any) -> Any:
            try:
                return work(*arguments)
            except Exception as error:
                return _warn(getattr(error, "strerror", None) or str(error))

        return attempted

    @attempt
    def load(*arguments: Any) -> Any:
        try:
            return read(*arguments)
        except Exception:  # a damaged file can raise anything
            return disk.flush()

    def load_or_announce(*arguments: Any) -> Any:
        compiled = load(*arguments)
        if compiled is None and _to_announce.get():
            _to_announce.set(False)
            print(
                "crazybilliards: compiling the kernels, once (they are cached) ...",
                file=sys.stderr,
                flush=True,
            )
        return compiled

    disk.load_overload, disk.save_overload = load_or_announce, attempt(disk.save_overload)


@cache  # Python forgets what it has warned of whenever filters of warnings change
def _warn(problem: str) -> None:
    """Warn once that the cache fails; the process that started this one has already warned."""
    if multiprocessing.current_process().name == "MainProcess":
        warnings.warn(
            "the kernels are compiled anew in every process, which takes some seconds: numba's "
            f"cache fails, {problem}; the environment variable NUMBA_CACHE_DIR names its folder",
            RuntimeWarning,
            stacklevel=2,
        )


def inlined(
    function: Callable[..., Any] | None = None, *, fused: bool = False, once: bool = False
) -> Any:
    """Compile ``function`` into every kernel that calls it; a decorator.

    For helpers with many arrays, for which the call costs more than the work. numba then inlines
    also the kernels that it calls, if they are compiled because of that call. ``fused``: as
    in :func:`kernel`. ``once``: one kernel calls it, without a ``*``. It becomes a part of that
    kernel before anything is compiled, which saves seconds for what calls all operators. It is not
    for what a loop calls with tuples of many arrays: they would be copied at every call.
    """
    if function is None:
        return partial(inlined, fused=fused, once=once)
    how = {"inline": "always"} if once else {"forceinline": True}
    return _compiled(function, fused=fused, allocates=False, **how)


@inlined
def copy(source, target):  # type: ignore[no-untyped-def]
    """Copy a one-dimensional array: numba compiles ``target[:] = source`` for seconds."""
    for i in range(source.size):
        target[i] = source[i]
