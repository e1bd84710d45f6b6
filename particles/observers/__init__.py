"""Observers: the measurements. A new measurement is a class in a file here and a name below.

It needs no change of a kernel: kernels fill buffers of snapshots, and observers read them.
"""

from collections.abc import Collection

from crazybilliards.model.checks import check_choice, is_list, shown
from crazybilliards.particles.observers.avalanches import Avalanches, TriggeredCollisions
from crazybilliards.particles.observers.base import Observer
from crazybilliards.particles.observers.collisions import Collisions, Walls
from crazybilliards.particles.observers.covariances import Covariances
from crazybilliards.particles.observers.density import Density
from crazybilliards.particles.observers.energy import Energy
from crazybilliards.particles.observers.impacts import Impacts
from crazybilliards.particles.observers.modes import Modes
from crazybilliards.particles.observers.raw import Raw
from crazybilliards.particles.observers.time_correlations import TimeCorrelations
from crazybilliards.particles.observers.velocities import Velocities
from crazybilliards.particles.observers.widths import Widths
from crazybilliards.particles.run import Run

__all__ = [
    "Avalanches",
    "Collisions",
    "Covariances",
    "Density",
    "Energy",
    "Impacts",
    "Modes",
    "Raw",
    "TimeCorrelations",
    "TriggeredCollisions",
    "Velocities",
    "Walls",
    "Widths",
]

OBSERVERS: dict[str, type[Observer]] = {
    observer.name: observer
    for observer in (
        *(Widths, Density, Velocities, Energy, Covariances, Modes, TimeCorrelations, Collisions),
        *(Impacts, Avalanches, TriggeredCollisions, Walls, Raw),
    )
}


def find_observers(observe: str | Observer | Collection[str | Observer]) -> tuple[Observer, ...]:
    """Return the observers for the argument ``observe``, each name once."""
    names = [observe] if isinstance(observe, str | Observer) else observe
    if not is_list(names) or len(names) == 0:
        raise ValueError(f"observe takes a list of names or observers, got {shown(observe)}")
    return tuple(
        one if isinstance(one, Observer) else OBSERVERS[check_choice("observe", one, OBSERVERS)]()
        for one in dict.fromkeys(names)
    )


def check_observers(run: Run) -> None:
    """Raise if an observer cannot work in this run, or if two report the same variable."""
    owners: dict[str, Observer] = {}
    for observer in run.observers:
        least, walls = observer.least_rods, observer.meets_walls
        refusals = {
            f"needs a chain of at least {least} rods": run.chain.size < least,
            "is averaged over time only, not over an ensemble": run.ensemble
            and not observer.ensemble,
            "needs a chain between walls, Chain(box=...)": walls and not run.chain.box,
            "needs single collisions, which only method='event-driven' sees": (
                observer.single_collisions or walls
            )
            and run.method != "event-driven",
        }
        for reason, refused in refusals.items():
            if refused:
                raise ValueError(f"observe: {observer.name!r} {reason}")
        # The times of an ensemble are the same for all observers.
        names = {*observer.gives, *observer.along} - ({"time"} if run.ensemble else set())
        for name in sorted(names):
            other = owners.setdefault(name, observer)
            common = name == "time" and observer.shares_time and other.shares_time
            if other is not observer and type(other) is type(observer):
                raise ValueError(f"observe holds {observer.name!r} twice; take one of them")
            if other is not observer and not common:
                raise ValueError(
                    f"observe: {other.name!r} and {observer.name!r} would both give {name!r}; "
                    "take one of them"
                )
