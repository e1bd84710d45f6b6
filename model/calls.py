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
from functools import wraps
from types import UnionType
from typing import Any, TypeVar

import numpy as np

from crazybilliards.model.checks import meant_argument, shown, with_meanings
from crazybilliards.model.words import WORDS

Item = TypeVar("Item", bound=Callable[..., Any])

# numpy's own settings: solvers rely on them, whatever numpy.seterr the user has chosen.
_NUMPY: Any = {"divide": "warn", "over": "warn", "under": "ignore", "invalid": "warn"}

# What is wanted for an argument that is annotated with these classes, or with several of them.
_WANTED = {
    "Chain": "a Chain: Chain(size=60) makes one, chain_of(result) gives that of a result",
    "Dataset": "a result, an xarray.Dataset: simulate(chain), a theory or load(path) returns one, "
    "tree['name'].to_dataset() gives one of a tree",
    "DataTree": "an xarray.DataTree, which compare and compare_relaxation return",
    "bool": "True or False",
    "str": "a text",
}


def public(item: Item) -> Item:
    """Let a public function, or the ``__init__`` of a public class, refuse wrong calls."""
    if inspect.isclass(item):
        owner: Any = item
        owner.__init__ = _checked(owner.__init__, owner.__name__)
        return item
    return _checked(item, item.__name__)


def warn_user(message: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the line outside of the package that led here."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).startswith("crazybilliards"):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


def _checked(function: Callable[..., Any], name: str) -> Any:
    signature = inspect.signature(function, eval_str=True)
    objects = [  # real classes: an annotation that names none is an error where the function stands
        (place, each.name, classes)
        for place, each in enumerate(signature.parameters.values())
        if (classes := _classes(each.annotation))
    ]

    @wraps(function)
    def checked(*given: Any, **named: Any) -> Any:
        for place, argument, classes in objects:
            if place < len(given):
                _require(argument, given[place], classes)
            elif argument in named:
                _require(argument, named[argument], classes)
        try:
            with np.errstate(**_NUMPY):
                return function(*given, **named)
        except TypeError:
            if problem := _problem(name, signature, given, named):
                raise TypeError(problem) from None
            raise

    return checked


def _classes(kind: Any) -> tuple[type, ...]:
    """Return the classes of an annotation if a message says what is wanted, or nothing."""
    classes = kind.__args__ if isinstance(kind, UnionType) else (kind,)
    told = all(inspect.isclass(each) and each.__name__ in _WANTED for each in classes)
    return classes if told and classes != (str,) else ()  # texts have checks of their own


def _require(argument: str, value: object, classes: tuple[type, ...]) -> None:
    """Raise a ValueError unless the value is of one of the classes; numbers are truth values."""
    if isinstance(value, classes) or (bool in classes and isinstance(value, int | np.bool_)):
        return
    wanted = ", or ".join(_WANTED[each.__name__] for each in classes)
    raise ValueError(f"{argument} must be {wanted}; got {shown(value)}")


def _problem(
    name: str, signature: inspect.Signature, given: Sequence[Any], named: Mapping[str, Any]
) -> str:
    """Return why these arguments do not fit a function; nothing if they do."""
    known = [each for each in signature.parameters if each != "self"]
    kinds: dict[bool, list[str]] = {True: [], False: []}
    for each in known:
        by_name = signature.parameters[each].kind == inspect.Parameter.KEYWORD_ONLY
        kinds[by_name].append(each)
    told = [", ".join(kinds[False]), f"by name {', '.join(kinds[True])}" if kinds[True] else ""]
    takes = f"; it takes {', and '.join(filter(None, told)) or 'no arguments'}"
    if wrong := [each for each in named if each not in known]:
        all_meant = all(meant_argument(each, known) for each in wrong)
        said = f"argument{'s' * (len(wrong) > 1)} {with_meanings(wrong, known)}"
        return f"{name} has no {said}" + ("" if all_meant else takes)
    try:
        signature.bind(*given, **named)
    except TypeError as error:
        return f"{name}: {error}{takes}"
    return ""


def missing_attribute(self: Any, name: str) -> Any:
    """Raise the AttributeError with what was meant: another attribute, or a function of a chain."""
    try:
        return object.__getattribute__(self, name)
    except AttributeError as error:
        if name.startswith("_") or hasattr(type(self), name):  # that of a property
            raise
        hint = _of_a_chain(name) or meant_argument(
            name, [each for each in dir(self) if each[0] != "_"]
        )
        raise AttributeError(f"{error}{hint}") from None


def _of_a_chain(name: str) -> str:
    """Return the public function of a chain that is meant by an attribute, or nothing."""
    front = sys.modules[__name__.partition(".")[0]]
    for each in WORDS.get(name, [name]):
        if each in front.__all__ and "chain" in inspect.signature(getattr(front, each)).parameters:
            return f"; {front.__name__}.{each}(chain, ...) is a function"
    return ""
