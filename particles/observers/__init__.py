"""Observers: the measurements. A new measurement is a class in a file here and a name below.

It needs no change of a kernel: kernels fill buffers of snapshots, and observers read them.
"""

from __future__ import annotations

from collections.abc import Collection

from crazybilliards.model.checks import is_list, meant, nearest, shown
from crazybilliards.particles.observers.avalanches import Avalanches, TriggeredCollisions
from crazybilliards.particles.observers.base import Observer
from crazybilliards.particles.observers.collisions import Collisions
from crazybilliards.particles.observers.covariances import Covariances
from crazybilliards.particles.observers.density import Density
from crazybilliards.particles.observers.energy import Energy
from crazybilliards.particles.observers.impacts import Impacts
from crazybilliards.particles.observers.modes import Modes
from crazybilliards.particles.observers.raw import Raw
from crazybilliards.particles.observers.time_correlations import TimeCorrelations
from crazybilliards.particles.observers.velocities import Velocities
from crazybilliards.particles.observers.walls import Walls
from crazybilliards.particles.observers.widths import Widths

OBSERVERS: dict[str, type[Observer]] = {
    observer.name: observer
    for observer in (
        Widths,
        Density,
        Velocities,
        Energy,
        Covariances,
        Modes,
        TimeCorrelations,
        Collisions,
        Impacts,
        Avalanches,
        TriggeredCollisions,
        Walls,
        Raw,
    )
}


def find_observers(observe: str | Observer | Collection[str | Observer]) -> tuple[Observer, ...]:
    """Return the observers for the argument ``observe``, each name once."""
    if isinstance(observe, str | Observer):
        observe = [observe]
    elif not is_list(observe):
        raise ValueError(
            f"observe takes a list of names or observers, got {shown(observe)}{_made(observe)}"
        )
    for each in observe:
        if not isinstance(each, str | Observer):
            raise ValueError(f"observe takes names and observers, got {shown(each)}{_made(each)}")
        if isinstance(each, Observer) and not hasattr(each, "name"):
            raise ValueError(f"observe: {type(each).__name__} must have a name")
        if isinstance(each, str) and each not in OBSERVERS:
            given = {name: of for of, observer in OBSERVERS.items() for name in observer.gives}
            near = nearest(each, [*OBSERVERS, *given])
            way = f"; {given[near]!r} gives {near!r}" if near in given else meant(each, OBSERVERS)
            names = f"{tuple(sorted(OBSERVERS))} or a list of them"
            raise ValueError(f"observe takes any of {names}, got {shown(each)}{way}")
    if len(observe) == 0:
        raise ValueError(f"observe must name at least one of {sorted(OBSERVERS)}")
    return tuple(
        OBSERVERS[each]() if isinstance(each, str) else each for each in dict.fromkeys(observe)
    )


def _made(kind: object) -> str:
    """Return how to make an observer of a class that was given in its place, or nothing."""
    right = isinstance(kind, type) and issubclass(kind, Observer)
    return f"; {kind.__name__}() makes one" if right else ""  # type: ignore[attr-defined]
