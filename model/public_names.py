"""The public names of a room: each is loaded when it is first used.

A room lists its names in its ``__init__.pyi``, which type checkers read too. The loader of the room
reads the list, so that a room can also lie in a zip archive.
"""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any

# What replaces the names that 0.5.0 does not have any more; 0.6.0 says no more of them.
_GONE = {
    "animate": "film(tree) films what compare_relaxation returns",
    "compare_elastic": "compare(chain, {'amplitude': [1, 3, 10, 30]})",
    "compare_restitutions": "compare(chain, {'restitution': [0.9, 0.95]})",
    "standalone_page": "film(tree, 'relaxation.html') writes a page",
    "width_deviations": "velocity widths are compared by a division, run.velocity_width / "
    "theory.velocity_width - 1",
}
# What lies in a folder below the rooms.
_ELSEWHERE = {"Observer": "from crazybilliards.particles.observers.base import Observer"}
for _fit in ("avalanches", "exponential", "growth", "scaling", "singularity"):
    _ELSEWHERE[f"fit_{_fit}"] = f"from crazybilliards.reproduction.fits import fit_{_fit}"
_ELSEWHERE["tail_length"] = "from crazybilliards.reproduction.fits import tail_length"


def hand_out(room: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a room."""
    module = sys.modules[room]
    loader: Any = module.__loader__
    stub = loader.get_data(os.path.join(module.__path__[0], "__init__.pyi"))
    module_of = {
        alias.name: f"{room}.{line.module}"
        for line in ast.parse(stub).body
        if isinstance(line, ast.ImportFrom)
        for alias in line.names
    }

    def __getattr__(name: str) -> Any:  # noqa: N807
        if name not in module_of:
            raise missing(room, name, module_of)
        found = getattr(import_module(module_of[name]), name)
        setattr(module, name, found)
        return found

    return __getattr__, lambda: list(module_of), list(module_of)


def missing(module: str, name: str, known: Iterable[str]) -> AttributeError:
    """Return the error for a name that a module does not have, with the one to use."""
    from crazybilliards.model.checks import meant

    hint = f" any more: {_GONE[name]}" if name in _GONE else meant(name, known)
    hint = f"; {_ELSEWHERE[name]}" if name in _ELSEWHERE else hint
    return AttributeError(f"module {module!r} has no attribute {name!r}{hint}")
