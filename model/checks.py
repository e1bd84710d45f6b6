"""Checks of arguments: each returns the value, or raises one ValueError that gives the reason."""

import inspect
import math
import os
import re
import reprlib
from collections.abc import Callable, Collection, Iterable
from difflib import get_close_matches
from functools import wraps
from numbers import Integral, Real
from pathlib import Path
from typing import Any, ParamSpec, TypeGuard, TypeVar

# Squares and ratios of parameters must neither overflow nor underflow.
_SMALLEST, _LARGEST = 1e-60, 1e60

# A unit as `vocabulary.described` writes it, or did up to version 0.5.
_OWN_UNIT = re.compile(r"[RMTt\d_^/ ]*")

_SHORTLY = reprlib.Repr()
_SHORTLY.maxstring = _SHORTLY.maxother = _SHORTLY.maxlong = 80

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


def shown(value: object) -> str:
    """Return a wrong value in the form for an error: on one line, cut in the middle if long.

    Of an object of xarray only the kind is shown.
    """
    if type(value).__module__.startswith("xarray."):
        return f"a {type(value).__name__}"
    return " ".join(_SHORTLY.repr(value).split())


def check_real(name: str, value: object, *, positive: bool = False, signed: bool = False) -> float:
    """Return ``value`` as a float, or raise one ValueError that says what is wrong with it.

    Accepts real numbers (Python's or numpy's, also in an array without dimensions) that are finite
    and whose magnitude lies within 1e-60..1e60, or 0 unless ``positive``; negative ones only if
    ``signed``.
    """
    refuse_units(name, value)
    number = _plain(value)
    if not _is_a(Real, number):
        wanted = "a number"
    elif not _SMALLEST <= abs(number) <= _LARGEST and number != 0:
        finite = isinstance(number, Integral) or math.isfinite(number)
        wanted = "between 1e-60 and 1e60 in magnitude, or 0" if finite else "finite"
        wanted = wanted.removesuffix(", or 0") if positive else wanted
    elif (number < 0 and not signed) or (number == 0 and positive):
        wanted = "positive" if positive else "0 or more"
    else:
        return float(number)
    raise ValueError(f"{name} must be {wanted}, got {shown(value)}")


def refuse_units(name: str, value: Any) -> None:
    """Raise a ValueError if numbers carry a unit of another library, which would be lost."""
    # astropy calls it unit, pint and unyt units; xarray gives an attribute of this name.
    unit = getattr(value, "units", getattr(value, "unit", None))
    if unit is not None and not (isinstance(unit, str) and _OWN_UNIT.fullmatch(unit)):
        raise ValueError(
            f"{name} must be plain numbers, in the chain's own units, and not carry a unit, got "
            f"{shown(value)}"
        )
    parts: Iterable[Any] = ()
    if type(value).__module__.startswith("xarray."):
        parts = [getattr(value, "data", None)]
    elif isinstance(value, list | tuple):
        parts = value
    elif getattr(getattr(value, "dtype", None), "kind", "") == "O":
        parts = value.ravel()
    for part in parts:
        if not isinstance(part, float | int):
            refuse_units(name, part)


def _is_a(kind: type, number: Any) -> bool:
    """Return whether this is a number of a kind; a truth value is none."""
    return isinstance(number, kind) and not isinstance(number, bool)


def _plain(value: Any) -> Any:
    """Return the number in an array without dimensions, such as one value of a coordinate."""
    # numpy's masked number is no number, although ``item`` gives 0 for it.
    whole = getattr(value, "shape", None) == () and not getattr(value, "mask", False)
    return value.item() if whole else value


def as_written(value: Any) -> Any:
    """Return a number as a person writes it: .3 for .1 + .2 and for numpy's float32(.3)."""
    kind = getattr(getattr(value, "dtype", None), "name", "")
    value = (
        float(str(_plain(value.astype(str)))) if kind in ("float16", "float32") else _plain(value)
    )
    if not isinstance(value, float) or not math.isfinite(value):
        return value
    short = float(f"{value:.10g}")
    return short if math.isclose(value, short, rel_tol=1e-13) else value


def check_integer(name: str, value: object, *, least: int, most: int | None = None) -> int:
    """Return ``value`` as an int, or raise one ValueError that says what ``name`` accepts."""
    wanted = f"an integer >= {least}" if most is None else f"an integer from {least} to {most}"
    refuse_units(name, value)
    number = _plain(value)
    if not _is_a(Integral, number) or number < least or (most is not None and number > most):
        raise ValueError(f"{name} must be {wanted}, got {shown(value)}")
    return int(number)


def is_list(value: object) -> TypeGuard[Collection[Any]]:
    """Return whether this has entries: a text and an array without dimensions have none."""
    whole = isinstance(value, str) or getattr(value, "shape", None) == ()
    return isinstance(value, Collection) and not whole


def meant(name: object, known: Iterable[str]) -> str:
    """Return the end of a message: the known name that was meant by a wrong one, or nothing."""
    known = list(known)
    if SYMBOLS.get(str(name)) in known:
        return f"; {SYMBOLS[str(name)]} is {name} of the paper"
    near = get_close_matches(str(name), known, 1, _ALIKE)
    return f"; did you mean {near[0]!r}?" if near else ""


def check_choice(name: str, value: object, choices: Iterable[str]) -> str:
    """Return ``value``, or raise a ValueError if ``name`` does not accept this word."""
    choices = tuple(choices)
    if not isinstance(value, str) or value not in choices:
        raise ValueError(
            f"{name} must be one of {choices}, got {shown(value)}{meant(value, choices)}"
        )
    return value


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


def check_path(name: str, path: object) -> Path:
    """Return ``path``, in which ``~`` is the home folder, or raise a ValueError if it is none."""
    if not isinstance(path, str | os.PathLike):
        raise ValueError(f"{name} must be a text or a Path, got {shown(path)}")
    try:
        return Path(path).expanduser()
    except RuntimeError as error:
        raise ValueError(f"{name}: there is no home folder for {shown(str(path))}") from error


def check_chain(chain: object) -> None:
    """Raise a TypeError unless this is a Chain: results are easily taken for their chain."""
    if not hasattr(chain, "require_known"):
        raise TypeError(
            f"chain must be a Chain, got a {type(chain).__name__}: Chain(size=60) makes one, "
            "chain_of(result) returns that of a result"
        )


def require_memory(wanted: str, needed: float) -> None:
    """Raise a ValueError with both numbers unless ``needed`` bytes are available.

    Linux grants more memory than there is, and kills the process when the memory is used. So this
    comes before any of it is allocated. ``wanted`` says what the memory is for, and begins with the
    name of the argument to change.
    """
    import psutil  # here, because most commands allocate little and start sooner without it

    available = psutil.virtual_memory().available
    if needed > available:
        raise ValueError(
            f"{wanted} would take {needed / 2**30:.3g} GiB of memory, "
            f"{available / 2**30:.3g} GiB are available"
        )
