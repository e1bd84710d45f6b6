"""What was meant by a wrong name, in one line: a symbol of the paper, or a name spelled alike."""

import inspect
from collections.abc import Callable, Collection, Iterable
from difflib import get_close_matches
from functools import wraps
from typing import ParamSpec, TypeVar

_ALIKE = 0.65  # of names that are meant by one another, from 0 to 1

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

# The symbols of the paper, and the arguments of Chain and simulate that they stand for.
SYMBOLS = {
    "L": "size",
    "R": "radius",
    "m": "mass",
    "k": "stiffness",
    "gamma": "damping",
    "\N{GREEK SMALL LETTER GAMMA}": "damping",
    "A": "amplitude",
    "e": "restitution",
    "g": "gap",
    "dt": "time_step",
}


def meant(name: object, known: Iterable[str]) -> str:
    """Return the end of a message: the known name that was meant by a wrong one, or nothing."""
    known = list(known)
    if SYMBOLS.get(str(name)) in known:
        return f"; {SYMBOLS[str(name)]} is {name} of the paper"
    near = get_close_matches(str(name), known, 1, _ALIKE)
    return f"; did you mean {near[0]!r}?" if near else ""


def check_arguments(
    owner: str, names: Iterable[str], known: Collection[str], error: type[Exception] = ValueError
) -> None:
    """Raise an error for the first name of an argument that ``owner`` does not take."""
    for name in names:
        if name not in known:
            hint = meant(name, known) or f"; it takes {', '.join(known)}"
            raise error(f"{owner} has no argument {name!r}{hint}")


def with_hints(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Let a TypeError say what was meant by an argument that a function does not take.

    A decorator; Python says only that the argument is unexpected.
    """
    owner = function.__qualname__.removesuffix(".__init__")
    known = [name for name in inspect.signature(function).parameters if name != "self"]

    @wraps(function)
    def checked(*positional: Arguments.args, **named: Arguments.kwargs) -> Result:
        check_arguments(owner, named, known, TypeError)
        return function(*positional, **named)

    return checked
