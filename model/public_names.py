"""The public names of a room: each is loaded when it is first used, and its calls are checked.

A room lists its names in its ``__init__.pyi``, which type checkers read too. What it hands out
refuses a wrong call as :mod:`.calls` says. The loader of the room reads the list, so that a room
can also lie in a zip archive.
"""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from threading import RLock
from typing import Any

_ONE_BY_ONE = RLock()  # a class is changed where it is, and must be so once
# What replaces the names that 0.4.0 does not have any more; 0.5.0 says no more of them.
_GONE = {
    "critical_damping": "critical_size(chain.replace(damping=...)) has as many rods as the chain "
    "at the critical damping",
    "critical_restitution": "it is 1 + (e - 1) critical_size(chain).value/size, at any e > 1",
    "two_clumps": "displaced(chain, 0).assign(flow_velocity=...) lets halves of a chain collide",
}
for _fit in ("Arctanh", "Avalanche", "Exponential", "Growth", "PowerLaw", "Scaling", "Singularity"):
    _GONE[f"{_fit}Fit"] = "every fit is a Fit, with the same attributes"

# The same for 0.5.0.
_GONE |= {
    "animate": "film(tree) films what compare_relaxation returns",
    "compare_elastic": "compare(chain, {'amplitude': [1, 3, 10, 30]})",
    "compare_restitutions": "compare(chain, {'restitution': [0.9, 0.95]})",
    "standalone_page": "film(tree, 'relaxation.html') writes a page",
    "width_deviations": "velocity widths are compared by a division, run.velocity_width / "
    "theory.velocity_width - 1",
}


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
        from crazybilliards.model.calls import checked

        found = getattr(import_module(module_of[name]), name)
        with _ONE_BY_ONE:  # another thread may have been quicker
            if name not in vars(module):
                setattr(module, name, checked(found, room))
        return vars(module)[name]

    return __getattr__, lambda: list(module_of), list(module_of)


# What lies in a folder below the rooms.
_ELSEWHERE = {"Observer": "from crazybilliards.particles.observers.base import Observer"}
for _fit in ("avalanches", "exponential", "growth", "scaling", "singularity"):
    _ELSEWHERE[f"fit_{_fit}"] = f"from crazybilliards.reproduction.fits import fit_{_fit}"
_ELSEWHERE["tail_length"] = "from crazybilliards.reproduction.fits import tail_length"


def missing(module: str, name: str, known: Iterable[str]) -> AttributeError:
    """Return the error for a name that a module does not have, with the one to use."""
    from crazybilliards.model.checks import meant

    hint = f" any more: {_GONE[name]}" if name in _GONE else meant(name, known)
    hint = f"; {_ELSEWHERE[name]}" if name in _ELSEWHERE else hint
    return AttributeError(f"module {module!r} has no attribute {name!r}{hint}")
