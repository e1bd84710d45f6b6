"""Noisy rods on springs colliding in one dimension: simulation and gas-kinetic theory.

All public names of the rooms ``model``, ``particles``, ``kinetic`` and ``comparison`` can be
taken from here. Each name loads its module when it is first used. Above these rooms stand
``reproduction``, the paper's figures and claims, and ``apps``, the command line and the page.

Examples
--------
>>> import crazybilliards as cb
>>> chain = cb.Chain(size=20, amplitude=10)
>>> run = cb.simulate(chain, duration=1000, progress=False)
>>> theory = cb.force_balance(chain)
>>> cb.deviation(cb.smooth(run), cb.smooth(theory)).rms < 0.02
True
"""

from importlib import import_module
from typing import Any

_ROOMS = ("model", "particles", "kinetic", "comparison")

# The rooms list their names; here they are only collected.
_ROOM_OF = {name: room for room in _ROOMS for name in import_module(f"{__name__}.{room}").__all__}

__all__ = list(_ROOM_OF)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("crazybilliards")
    if name not in _ROOM_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_ROOM_OF[name]}"), name)


def __dir__() -> list[str]:
    return [*_ROOM_OF, *_ROOMS, "__version__"]
