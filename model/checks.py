"""Checks of arguments: each returns the value, or raises one ValueError that gives the reason."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Iterable
from difflib import get_close_matches
from numbers import Integral, Real

# Squares and ratios of parameters must neither overflow nor underflow.
_SMALLEST, _LARGEST = 1e-60, 1e60

_SHORTLY = reprlib.Repr()
_SHORTLY.maxstring = _SHORTLY.maxother = _SHORTLY.maxlong = 80


def shown(value: object) -> str:
    """Return a wrong value in the form for an error: on one line, cut in the middle if long."""
    return " ".join(_SHORTLY.repr(value).split())


def check_real(name: str, value: object, *, positive: bool = False, signed: bool = False) -> float:
    """Return ``value`` as a float, or raise one ValueError that says what ``name`` accepts.

    Accepts real numbers (Python's or numpy's) that are finite and whose magnitude lies within
    1e-60..1e60, or 0 unless ``positive``; negative ones only if ``signed``.
    """
    sign = "" if signed else "positive " if positive else "non-negative "
    wanted = f"{name} must be a finite {sign}number between 1e-60 and 1e60"
    if not positive:
        wanted += " (or 0)"
    if isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"{wanted}, got {shown(value)}")
    try:
        number = float(value)
    except OverflowError:  # a whole number of more than 308 digits
        number = math.inf
    in_range = _SMALLEST <= abs(number) <= _LARGEST or (number == 0 and not positive)
    if not in_range or (number < 0 and not signed):
        raise ValueError(f"{wanted}, got {shown(value)}")
    return number


def check_integer(name: str, value: object, *, least: int, most: int | None = None) -> int:
    """Return ``value`` as an int, or raise one ValueError that says what ``name`` accepts."""
    wanted = f"an integer >= {least}" if most is None else f"an integer from {least} to {most}"
    if (
        isinstance(value, bool)
        or not isinstance(value, Integral)
        or int(value) < least
        or (most is not None and int(value) > most)
    ):
        raise ValueError(f"{name} must be {wanted}, got {shown(value)}")
    return int(value)


def check_choice(name: str, value: object, choices: Iterable[str]) -> str:
    """Return ``value``, or raise a ValueError if ``name`` does not accept this word."""
    choices = tuple(choices)
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name} must be one of {got(value, choices)}")
    return value


def got(value: object, choices: Iterable[str]) -> str:
    """Return the end of a message about a wrong name: what is accepted, what came, what is near."""
    choices = tuple(choices)
    return f"{choices}, got {shown(value)}{meant(value, choices)}"


def meant(value: object, choices: Iterable[str]) -> str:
    """Return a question whether the nearest accepted name was meant, or nothing."""
    near = get_close_matches(value, choices, 1) if isinstance(value, str) else []
    return f"; did you mean {near[0]!r}?" if near else ""
