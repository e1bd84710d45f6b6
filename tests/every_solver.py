"""Every solver of the package with its arguments, for the tests that hold for all of them.

A new solver is one line here, and a test fails until it has one. ``NAME, kind`` is another kind of
call of the function NAME. What a call needs besides the chain stands in ``Given``, because the
tests choose it: in other units, for a chain of any scale, or the same for all chains.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

import numpy as np
import xarray as xr

from crazybilliards.kinetic import (
    breathing_cloud,
    compressed,
    critical_size,
    displaced,
    equilibrium,
    equilibrium_states,
    force_balance,
    hydrodynamics,
    rod_by_rod,
    steady_state,
)
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

Along = Callable[[np.ndarray], np.ndarray]


def softly(x):
    """Return a displacement that holds the rods together more weakly than labels do."""
    return 0.3 * np.asarray(x)


@dataclass(frozen=True, kw_only=True)
class Given:
    """What the solvers are given besides the chain."""

    start: xr.Dataset
    variance: Along
    number: float  # a velocity variance that is the same everywhere
    displacement: Along = softly
    length: float = 1.0
    stretch: float = 1.5
    times: Mapping[str, float]  # duration and every, of what is solved in time
    fluid: Mapping[str, Any] = field(default_factory=dict)
    run: Mapping[str, float] = field(default_factory=dict)  # of simulations
    warmup: float = 1.0


@dataclass(frozen=True)
class Solver:
    """A call, and what a chain of the tests is changed to before it."""

    solve: Callable[[Chain, Given], Any]
    needs: Mapping[str, Any] = field(default_factory=dict)


def _flow(**settings):
    """Return a call of the fluid; a setting may be a function of what is given."""

    def solve(chain, given):
        chosen = {name: each(given) if callable(each) else each for name, each in settings.items()}
        return hydrodynamics(
            chain, given.start, **given.times, **given.fluid, **chosen, progress=False
        )

    return Solver(solve, ELASTIC)


def _run(**settings):
    def solve(chain, given):
        observe = ("widths", "density", "energy", "velocities")
        options = {**given.run, "warmup": given.warmup, **settings}
        return simulate(chain, observe=observe, progress=False, **options)

    return Solver(solve)


ELASTIC = {"restitution": 1.0}
LINEAR = {"spring": "linear"}
DRIVEN = {"restitution": 1.1, **LINEAR}
SOLVERS = {
    "equilibrium": Solver(lambda chain, _: equilibrium(chain), ELASTIC),
    "equilibrium_states": Solver(lambda chain, _: equilibrium_states(chain, 2), ELASTIC),
    "displaced": Solver(lambda chain, given: displaced(chain, given.length)),
    "compressed": Solver(lambda chain, given: compressed(chain, given.stretch)),
    "force_balance": Solver(lambda chain, _: force_balance(chain), ELASTIC),
    "force_balance, variance": Solver(
        lambda chain, given: force_balance(chain, velocity_variance=given.variance), LINEAR
    ),
    "force_balance, number": Solver(
        lambda chain, given: force_balance(chain, velocity_variance=given.number)
    ),
    "force_balance, displacement": Solver(
        lambda chain, given: force_balance(chain, given.displacement), ELASTIC
    ),
    "force_balance, both": Solver(
        lambda chain, given: force_balance(chain, given.displacement, given.number)
    ),
    "hydrodynamics, label": _flow(),
    "hydrodynamics, label, evolving": _flow(velocity_variance="evolving"),
    "hydrodynamics, label, number": _flow(velocity_variance=attrgetter("number")),
    "hydrodynamics, eulerian": _flow(frame="eulerian"),
    "hydrodynamics, eulerian, evolving": _flow(frame="eulerian", velocity_variance="evolving"),
    "hydrodynamics, eulerian, number": _flow(
        frame="eulerian", velocity_variance=attrgetter("number")
    ),
    "hydrodynamics, eulerian, variance": _flow(
        frame="eulerian", velocity_variance=attrgetter("variance")
    ),
    "hydrodynamics, eulerian, displacement": _flow(
        frame="eulerian", displacement=attrgetter("displacement")
    ),
    "breathing_cloud": Solver(
        lambda chain, given: breathing_cloud(chain, **given.times, stretch=0.5),
        {"gap": 0.0, **ELASTIC, **LINEAR},
    ),
    "steady_state": Solver(lambda chain, _: steady_state(chain), {"restitution": 0.8}),
    "steady_state, mean field": Solver(
        lambda chain, _: steady_state(chain, correlations=False), {"restitution": 0.8}
    ),
    "rod_by_rod": Solver(lambda chain, _: rod_by_rod(force_balance(chain)), ELASTIC),
    "rod_by_rod, in time": Solver(
        lambda chain, given: rod_by_rod(
            hydrodynamics(chain, given.start, **given.times, **given.fluid, progress=False)
        ),
        ELASTIC,
    ),
    "critical_size": Solver(lambda chain, _: critical_size(chain), DRIVEN),
    "simulate": _run(),
    "simulate, contact dynamics": _run(method="contact-dynamics"),
    "simulate, euler": _run(stepper="euler"),
}
