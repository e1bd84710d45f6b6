"""How kernels are compiled: cached on disk, without the global interpreter lock, IEEE arithmetic.

numba's cache notices when the file of a kernel changes, but not when a kernel that it calls
changes in another file: it would go on running the old one. So the cache entries made here also
carry a fingerprint of the files of all kernels that a kernel calls, directly or not, and of the
constants that these take from elsewhere.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from numba import njit

from crazybilliards.model.fingerprint import fingerprint_of


def kernel(function: Callable[..., Any]) -> Any:
    """Compile ``function`` when it is first called; a decorator."""
    dispatcher = njit(cache=True, nogil=True, error_model="numpy")(function)
    # numba has no public way to add to the stamp. Where this one is gone (or compilation is
    # disabled), the cache works as numba made it.
    entries = getattr(getattr(dispatcher, "_cache", None), "_cache_file", None)
    stamp = getattr(entries, "_source_stamp", None)
    if entries is not None and stamp is not None:
        entries._source_stamp = (stamp, _fingerprint(function))
    return dispatcher


def inlined(function: Callable[..., Any]) -> Any:
    """Compile ``function`` into every kernel that calls it; a decorator.

    For helpers that take many arrays, which cost more to hand over than to work on.
    """
    return njit(nogil=True, error_model="numpy", forceinline=True)(function)


def _fingerprint(function: Callable[..., Any]) -> str:
    """Return the fingerprint of all that the compiled ``function`` depends on."""
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
    """Return what a function names outside itself, also through modules: ``sort.drift``, say."""
    scope = {**function.__globals__, **inspect.getclosurevars(function).nonlocals}
    names = (*function.__code__.co_names, *function.__code__.co_freevars)
    found = [(name, scope[name]) for name in names if name in scope]
    for _, value in found:  # grows on the way: modules hold modules
        if isinstance(value, ModuleType):
            attributes = vars(value)
            new = [(name, attributes[name]) for name in names if name in attributes]
            found += [each for each in new if all(each[1] is not old for _, old in found)]
    return found
