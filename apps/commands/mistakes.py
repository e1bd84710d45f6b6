"""What the parser of the command line says of a mistake, in the words of the other messages."""

from __future__ import annotations

import re
import sys
from typing import Any

import typer

from crazybilliards.model.checks import shown
from crazybilliards.model.words import NOTES, SYMBOLS

_WANTED = {"int_parsing": "an integer", "float_parsing": "a number"}
_LISTS = "separated by commas"  # stands in the help of every list


def explained(error: typer.TyperException) -> str:
    """Return the message for an error of the parser."""
    if extra := re.search(r"unexpected extra argument\S* \((.+)\)$", str(error)):
        return _extra(extra[1].split()[0], error)
    problem: list[dict[str, Any]] = getattr(error.__cause__, "errors", list)()  # of pydantic
    if problem and problem[0]["type"] in _WANTED:
        return _no_number(error, problem[0]["type"], problem[0]["input"])
    return _with_symbol(error)


def _no_number(error: Any, kind: str, text: str) -> str:
    message = f"{error.param.name} must be {_WANTED[kind]}, got {shown(text)}"
    # 1,5 is meant as 1.5; nobody knows what 1,500 is.
    plain = re.sub(r"^([+-]?\d*),(?!\d{3}$)(\d+)$", r"\1.\2", text)
    try:
        number = float(plain)
    except ValueError:
        return message
    if kind == "int_parsing" and number.is_integer() and plain == text and abs(number) < 1e15:
        return f"{message}; write {int(number)}"
    return f"{message}; write {plain}" if kind == "float_parsing" else message


def _extra(word: str, error: Any) -> str:
    """Say that an argument is one too many; in a list, that its values are joined by commas."""
    before = sys.argv[2 : sys.argv.index(word, 2)] if word in sys.argv[2:] else []
    place = max((at for at, each in enumerate(before) if each.startswith("-")), default=-1)
    option, _, value = before[place].partition("=") if place >= 0 else ("", "", "")
    values = [value] * bool(value) + before[place + 1 :]
    for each in error.ctx.command.params:
        named = option in each.opts if option else each.param_type_name == "argument"
        if named and values and _LISTS in (getattr(each, "help", "") or ""):
            example = " ".join([option] * bool(option) + [",".join([*values, word])])
            return f"{each.name} takes values {_LISTS}: {example}"
    return f"unexpected extra argument {shown(word)}"


def _with_symbol(error: typer.TyperException) -> str:
    """Return the message of an error; of an unknown option, what is meant or replaces it."""
    symbol = getattr(error, "option_name", "").lstrip("-")
    if note := NOTES.get(symbol.replace("-", "_")):
        return f"{error}; {note}"
    context = getattr(error, "ctx", None)
    known = [each.name for each in context.command.params] if context else []
    if (name := SYMBOLS.get(symbol, "")) not in known:
        return error.format_message()
    return f"{error}; --{name.replace('_', '-')} is {symbol} of the paper"
