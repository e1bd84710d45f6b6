"""Wrong calls of public functions and classes, refused in one line.

Python says of ``Chain(restituton=0.9)`` only that this argument is unexpected. The message made
here names the nearest argument, or the one that a symbol of the paper stands for. Objects of the
wrong type are refused by the annotation of the argument. A right call takes a microsecond more.
"""

from __future__ import annotations

import inspect
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import FrozenInstanceError
from functools import cache, wraps
from pkgutil import resolve_name
from typing import Any

import numpy as np

from crazybilliards.model.checks import meant, meant_argument, shown, with_meanings
from crazybilliards.model.words import SYMBOLS, WORDS

# numpy's own settings: solvers rely on them, whatever numpy.seterr the user has chosen.
_NUMPY: Any = {"divide": "warn", "over": "warn", "under": "ignore", "invalid": "warn"}

# annotation: (the classes it stands for, what is wanted)
_OBJECTS = {
    "Chain": (
        ("crazybilliards.model.chain:Chain",),
        "a Chain: Chain(size=60) makes one, chain_of(result) gives that of a result",
    ),
    "xr.Dataset": (
        ("xarray:Dataset",),
        "a result, an xarray.Dataset: simulate(chain), a theory or load(path) returns one, "
        "tree['name'].to_dataset() gives one of a tree",
    ),
    "xr.DataTree": (
        ("xarray:DataTree",),
        "an xarray.DataTree, which compare and compare_relaxation return",
    ),
    "xr.Dataset | xr.DataTree": (
        ("xarray:Dataset", "xarray:DataTree"),
        "a result or a tree of results, an xarray.Dataset or xarray.DataTree",
    ),
    "xr.Dataset | xr.DataTree | Chain": (
        ("xarray:Dataset", "xarray:DataTree", "crazybilliards.model.chain:Chain"),
        "a result with snapshots, of simulate(chain, observe='snapshots'), what compare_relaxation "
        "returns, or a Chain",
    ),
    "bool": (("builtins:int", "numpy:bool"), "True or False"),
    "bool | str": (("builtins:int", "numpy:bool", "builtins:str"), "True, False or a text"),
}


def checked(item: Any, room: str) -> Any:
    """Return a public function or class of a room that refuses wrong calls.

    A function is wrapped, a class gets another ``__init__``. Exceptions stay as they are.
    """
    if not inspect.isclass(item):
        public = _checked(item, inspect.signature(item))
        public.__module__ = room  # where pickle finds it
        return public
    if issubclass(item, BaseException):
        return item
    _check_class(item)
    return item


def warn_user(message: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the line outside of the package that led here."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).startswith("crazybilliards"):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


def _check_class(owner: Any) -> None:
    signature = inspect.signature(owner)
    itself = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    start: Any = _checked(_start_of(owner), signature, owner.__name__)
    start.__signature__ = signature.replace(parameters=[itself, *signature.parameters.values()])
    owner.__init__ = start
    if "__dataclass_fields__" in vars(owner):  # all of them are frozen
        owner.__setattr__ = _explained(owner.__setattr__)
        owner.__delattr__ = _explained(owner.__delattr__)
        owner.__getattr__ = _missing


def _start_of(owner: Any) -> Callable[..., None]:
    """Return ``__init__`` of a class; of one without its own what calls the next one of a base."""
    if "__init__" in vars(owner):
        own: Callable[..., None] = owner.__init__
        return own

    def inherited(self: Any, *arguments: Any, **keywords: Any) -> None:
        super(owner, self).__init__(*arguments, **keywords)

    return inherited


def _checked(
    function: Callable[..., Any], signature: inspect.Signature, owner: str = ""
) -> Callable[..., Any]:
    """Wrap a function, or the ``__init__`` of the class ``owner``."""
    name = owner or function.__name__
    objects = [
        (place, argument.name, argument.annotation)
        for place, argument in enumerate(signature.parameters.values())
        if argument.annotation in _OBJECTS
    ]

    @wraps(function)
    def public(*arguments: Any, **keywords: Any) -> Any:
        given = arguments[1:] if owner else arguments
        for place, argument, kind in objects:
            if place < len(given):
                _require(argument, given[place], kind)
            elif argument in keywords:
                _require(argument, keywords[argument], kind)
        try:
            with np.errstate(**_NUMPY):
                return function(*arguments, **keywords)
        except TypeError:
            if problem := _problem(name, signature, given, keywords):
                raise TypeError(problem) from None
            raise

    return public


def _require(argument: str, value: object, kind: str) -> None:
    """Raise a ValueError unless the value is of a class that the annotation ``kind`` names."""
    if not isinstance(value, _classes(kind)):
        raise ValueError(f"{argument} must be {_OBJECTS[kind][1]}; got {shown(value)}")


@cache
def _classes(kind: str) -> tuple[type, ...]:
    return tuple(resolve_name(name) for name in _OBJECTS[kind][0])


def _problem(
    name: str, signature: inspect.Signature, given: Sequence[Any], keywords: Mapping[str, Any]
) -> str:
    """Return why these arguments do not fit a function; nothing if they do."""
    known = signature.parameters
    by_name = [each for each, argument in known.items() if argument.kind == argument.KEYWORD_ONLY]
    by_place = [each for each in known if each not in by_name]
    takes = ", ".join(known) or "no arguments"
    if wrong := [each for each in keywords if each not in known]:
        all_meant = all(meant_argument(each, known) for each in wrong)
        said = f"argument{'s' * (len(wrong) > 1)} {with_meanings(wrong, known)}"
        return f"{name} has no {said}" + ("" if all_meant else f"; it takes {takes}")
    if len(given) > len(by_place):
        more = shown(given[len(by_place)])
        free = [f"{each}={more}" for each in by_name if each not in keywords]
        way = f": write {free[0]} with its name" if free else f"; it takes {takes}"
        return (
            f"{name} takes {', '.join(by_place) or 'no argument'} without a name, got {more}{way}"
        )
    for each in by_place[: len(given)]:
        if each in keywords:
            return f"{name} got {each} twice, by its place and by its name"
    missing = [
        each
        for each in [*by_place[len(given) :], *by_name]
        if known[each].default is inspect.Parameter.empty and each not in keywords
    ]
    if not missing:
        return ""
    whole = [
        f"; {each} must be numbers, such as one variable of the result, got {shown(value)}"
        for each, value in zip(by_place, given, strict=False)
        if known[each].annotation not in _OBJECTS and isinstance(value, _classes("xr.Dataset"))
    ]
    return f"{name} needs {' and '.join(missing)}; it takes {takes}{''.join(whole)}"


def _missing(self: Any, name: str) -> Any:
    """Raise the AttributeError with what was meant: another attribute, or a function of a chain."""
    try:
        return object.__getattribute__(self, name)
    except AttributeError as error:
        if name.startswith("_") or hasattr(type(self), name):  # that of a property
            raise
        known = [each for each in dir(self) if not each.startswith("_")]
        hint = (_of_a_chain if "replace" in known else meant)(name, known)
        raise AttributeError(f"{error}{hint}") from None


def _of_a_chain(name: str, known: Sequence[str]) -> str:
    """Return what is meant by an attribute that chains do not have."""
    front = sys.modules[__name__.partition(".")[0]]
    for each in WORDS.get(name, [name]):
        if each in front.__all__:
            arguments = inspect.signature(getattr(front, each)).parameters.values()
            if "Chain" in str(next(iter(arguments), "")):
                return f"; {front.__name__}.{each}(chain, ...) is a function"
    return meant_argument(name, known)


def _explained(refuse: Callable[..., None]) -> Callable[..., None]:
    """Return the method of a frozen class that refuses a change, with a message of what to do."""

    @wraps(refuse)
    def change(self: Any, name: str, *value: Any) -> None:
        try:
            refuse(self, name, *value)
        except FrozenInstanceError:
            name = SYMBOLS.get(name, name)
            way = f"; chain.replace({name}=...) returns another" if hasattr(self, "replace") else ""
            kind = type(self).__name__
            raise FrozenInstanceError(f"{name}: a {kind} cannot be changed{way}") from None

    return change
