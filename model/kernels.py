"""How kernels are compiled: cached on disk, without the global interpreter lock, IEEE arithmetic.

numba's cache notices when the file of a kernel changes. It does not notice when a kernel that it
calls changes in another file, and would run the old one. Cache entries made here therefore also
carry a fingerprint of the files of all kernels that a kernel calls, directly or not, and of the
constants that these import.

**No counting of references.** numba counts the references to every array that a function receives,
or takes out of a tuple, although the arrays of a kernel belong to the Python code that called it.
For a short chain this took far longer than the work. numba's ``_nrt=False`` switches the counting
off for kernels that allocate no memory. Where a later numba does not know this option, kernels
count again and are slower.

Processes that start together, those of a sweep say, need the same kernels. One of them compiles,
and the others wait until they can load what it has written.

The cache only saves time. If it cannot be written, as in a container without a home or on a full
disk, kernels are compiled in every process, with one warning.
"""

from __future__ import annotations

import inspect
import multiprocessing
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from filelock import FileLock
from numba import njit
from numba.core.compiler_lock import global_compiler_lock
from numba.core.options import DefaultOptions

from crazybilliards.model.fingerprint import fingerprint_of
from crazybilliards.model.process import announce_compilation, interrupts_held_back

_ANEW = "the kernels are compiled anew in every process, which takes some seconds"
_LONGEST = 120.0  # s to wait for another process, which may have been stopped
_warned: set[str] = set()


class _Turn:
    """The turn of this process to compile the kernels of a folder, and all that they call.

    All of it happens while this thread holds numba's own lock.
    """

    def __init__(self) -> None:
        self.depth = 0  # of kernels that are being compiled, each for the one before
        self.lock: FileLock | None = None

    def begins(self, folder: Path) -> bool:
        """Wait for other processes. False: this one has its turn already, so nothing is new."""
        if self.lock is not None:
            return False
        self.lock = FileLock(folder / ".compiling", timeout=_LONGEST, fallback_to_soft=False)
        # Without a lock, on a file system that has none say, it is only done twice.
        with suppress(OSError, NotImplementedError):
            self.lock.acquire()
        return True

    def ends_with(self, compile_: Callable[..., Any]) -> Callable[..., Any]:
        """Let the turn end when the first of the kernels is compiled."""

        def compiled(signature: Any) -> Any:
            with global_compiler_lock:
                self.depth += 1
                try:
                    return compile_(signature)
                finally:
                    self.depth -= 1
                    if self.depth == 0 and self.lock is not None:
                        self.lock.release()
                        self.lock = None

        return compiled


_turn = _Turn()


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
    dispatcher.compile = interrupts_held_back()(_turn.ends_with(dispatcher.compile))
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
        _add_fingerprint(kept, function)
        _let_it_fail(kept)
    return dispatcher


def _add_fingerprint(kept: Any, function: Callable[..., Any]) -> None:
    """Add the fingerprint to the stamp by which numba recognises an outdated cache."""
    entries = getattr(kept, "_cache_file", None)
    stamp = getattr(entries, "_source_stamp", None)
    if entries is not None and stamp is not None:
        entries._source_stamp = (stamp, _fingerprint(function))


def _let_it_fail(kept: Any) -> None:
    """Make a cache that cannot be read or written a warning; numba makes it an error."""
    load, save = kept.load_overload, kept.save_overload

    def load_or_none(*arguments: Any) -> Any:
        try:
            return load(*arguments)
        # Unpickling a damaged file can raise anything. The newly compiled kernel replaces it.
        except Exception as error:
            _warn("numba's cache cannot be read, compiling anew", f"{kept.cache_path}: {error}")
            with suppress(OSError):
                kept.flush()
            return None

    def load_in_turn(*arguments: Any) -> Any:
        found = load_or_none(*arguments)
        if found is None:
            announce_compilation()
            if _turn.begins(Path(kept.cache_path)):
                found = load_or_none(*arguments)  # if another process has compiled it
        return found

    def save_if_possible(*arguments: Any) -> None:
        try:
            save(*arguments)
        except Exception as error:  # saving reads what is there, too
            _warn(_ANEW, f"{kept.cache_path}: {error}; NUMBA_CACHE_DIR can name another folder")

    kept.load_overload, kept.save_overload = load_in_turn, save_if_possible


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


def _fingerprint(function: Callable[..., Any]) -> str:
    """Return the fingerprint of all source code that the compiled ``function`` depends on."""
    files: set[Path] = set()
    constants: set[str] = set()
    known: set[Callable[..., Any]] = set()
    waiting = [function]
    while waiting:
        each = waiting.pop()
        if each in known:
            continue
        known.add(each)
        file = Path(inspect.getfile(each))
        if file.is_file():
            files.add(file)
        else:  # a cell of a notebook
            constants.add(inspect.getsource(each))
        for name, value in _named(each):
            if hasattr(value, "py_func"):
                waiting.append(value.py_func)
            elif isinstance(value, bool | int | float | str | tuple):
                constants.add(f"{name}={value!r}")
    return fingerprint_of(files, *sorted(constants))


def _named(function: Callable[..., Any]) -> list[tuple[str, Any]]:
    """Return the objects outside a function that it names, also as ``module.name``."""
    scope = {**function.__globals__, **inspect.getclosurevars(function).nonlocals}
    names = (*function.__code__.co_names, *function.__code__.co_freevars)
    found = [(name, scope[name]) for name in names if name in scope]
    for _, value in found:  # grows on the way: modules hold modules
        if isinstance(value, ModuleType):
            attributes = vars(value)
            new = [(name, attributes[name]) for name in names if name in attributes]
            found += [each for each in new if all(each[1] is not old for _, old in found)]
    return found
