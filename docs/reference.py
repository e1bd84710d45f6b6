"""Pages of the reference are made from public names and the docstrings of their modules.

A new public name appears by itself, below the docstring of the module that it comes from.
"""

import re
from dataclasses import is_dataclass
from importlib import import_module
from inspect import getsourcelines, isclass, isfunction, unwrap
from typing import Any

from sphinx.util import logging

logger = logging.getLogger(__name__)

_NAMES = re.compile(r"^```\{names\} (\S+)\n```$", re.MULTILINE)
_MODULE = re.compile(r"^```\{module\} (\S+)\n```$", re.MULTILINE)


def fill_page(app, page, source) -> None:
    """Fill the blocks ``{names} ROOM`` and ``{module} MODULE`` of a page of the reference.

    The second becomes the docstring of the module and the public names of the room that come from
    it. The first lists all public names in the order of the page. A name on no page is a warning.
    """
    if not (found := _NAMES.search(source[0])):
        return
    room, text = found[1], source[0]
    public = {name: unwrap(getattr(import_module(room), name)) for name in _public(room)}
    shown: list[str] = []

    def module(match: re.Match[str]) -> str:
        names = [
            name for name in public if f"{public[name].__module__}.".startswith(f"{match[1]}.")
        ]
        names.sort(key=lambda name: _place(public[name]))
        shown.extend(names)
        lines = [f".. automodule:: {match[1]}", "   :no-index:", "   :no-members:"]
        for name in names:
            thing = public[name]
            kind = "class" if isinstance(thing, type) else "function"
            lines += ["", f".. auto{kind}:: {room}.{name}"]
            lines += ["   :members:"] * is_dataclass(thing)
        return _as_block(lines)

    text = _MODULE.sub(module, text)
    if sorted(shown) != sorted(public):
        logger.warning("names on no page or twice: %s", set(public) ^ set(shown), location=page)
    head = [f".. currentmodule:: {room}", "", ".. autosummary::", "   :nosignatures:", ""]
    source[0] = _NAMES.sub(_as_block([*head, *(f"   {name}" for name in shown)]), text)


def _public(room: str) -> list[str]:
    """Return functions and classes of a room; observers and sweeps have pages of their own."""
    module = import_module(room)
    things = {name: getattr(module, name) for name in module.__all__}
    names = [name for name, thing in things.items() if isclass(thing) or isfunction(thing)]
    if room != "crazybilliards.comparison":
        return names
    return [name for name in names if name not in import_module(f"{room}.sweeps").__all__]


def _place(thing: Any) -> tuple[bool, str, int]:
    """Return where a name stands in its section: in the order of the source, warnings last."""
    error = isinstance(thing, type) and issubclass(thing, Exception)
    return error, thing.__module__, getsourcelines(thing)[1]


def _as_block(lines: list[str]) -> str:
    return "\n".join(["```{eval-rst}", *lines, "```"])


def setup(app) -> None:
    """Let Sphinx know of the above."""
    app.connect("source-read", fill_page)
