"""What both frames of hydrodynamics share: the call of py-pde, and the fields that they return.

No other module calls py-pde. It gets fields on a uniform grid and a compiled right-hand side, and
provides the grid, the fields, the time steppers, trackers and storage. The interrupts are named,
because trackers that read the clock would make two equal runs differ.
"""

import logging
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from pde import CallbackTracker, CartesianGrid, FieldCollection, MemoryStorage, PDEBase, ScalarField
from pde.trackers.base import FinishedSimulation

from crazybilliards.model import Array
from crazybilliards.model.progress import progress_bar

# py-pde would warn that a short run spent more time on storing than on solving.
logging.getLogger("pde.solvers.controller").setLevel(logging.ERROR)

Rate = Callable[[Array, float], Array]


class FlowFields(NamedTuple):
    """Fields on positions at the output times, in the chain's units."""

    x: Array  # (nodes,)
    density: Array  # (times, nodes)
    label: Array
    velocity: Array
    variance: Array
    rods: Array  # positions of the rods, (times, L)
    rod_velocities: Array
    cells: int
    unsteadiness: Array  # rms rate of change of eta and V in scaled units, (times,)
    energy: Array  # mean of v^2 over the rods, (times,)
    heat_flux: Array | None = None  # (m/2) n q, (times, nodes), over the mass
    diverged: bool = False


class Flow(PDEBase):
    """Equations of motion given as the rates of change of fields (number, cells) at a time."""

    def __init__(self, rate: Rate) -> None:
        super().__init__()
        self.rate = rate

    def make_evolution_rate(self, state: Any, backend: Any) -> Any:
        """Return the function that py-pde's solvers call."""
        return self.rate

    def evolution_rate(self, state: Any, t: float = 0) -> Any:
        """Return the rates with the one attribute of py-pde's slow fields that it reads."""
        # The values lie in an array with cells around them, for which a rate would compile again.
        return SimpleNamespace(data=self.rate(np.ascontiguousarray(state.data), t))


def solve(
    rate: Rate,
    fields: Mapping[str, Array],
    ends: tuple[float, float],
    times: Array,
    *,
    progress: bool,
    unit: float = 1.0,
    watch: Callable[[Array, float], bool] = lambda fields, time: False,
    **solver: Any,
) -> Array:
    """Solve from fields between two ends; return those at all ``times``, (times, fields, cells).

    py-pde ends a run at Ctrl-C without raising. The result then has the first times only, as when
    ``watch`` returned True for the fields and the time [t_0] of an output. ``unit`` is that of
    ``times`` [t_0], and ``solver`` are the arguments of py-pde. Without ``dt`` the unit of time
    must be about the time between outputs: py-pde takes times that differ by 1e-8 for the same.
    """
    grid = CartesianGrid([ends], len(next(iter(fields.values()))))
    state = FieldCollection([ScalarField(grid, fields[name], label=name) for name in fields])
    storage = MemoryStorage()
    flow, span = Flow(rate), (float(times[0]), float(times[-1]))
    try:
        with progress_bar(progress, total=times.size, desc="hydrodynamics", leave=False) as bar:

            def seen(fields: Any, time: float) -> None:
                bar.update()
                if watch(fields.data, unit * time):
                    raise FinishedSimulation

            trackers = [storage.tracker(list(times)), CallbackTracker(seen, list(times))]
            flow.solve(state, t_range=span, tracker=trackers, **solver)
    except RuntimeError as error:  # a step that became too small, or not a number
        reached = unit * storage.times[-1] if storage.times else 0.0
        raise ValueError(
            f"the hydrodynamic equations could not be solved beyond t = {reached:g}: {error}"
        ) from error
    outputs = len(storage.data)
    # py-pde reports Ctrl-C here only.
    controller = flow.diagnostics["controller"]
    ended = controller["stop_reason"] == "Reached final time"
    if controller["successful"] and ended and outputs != times.size:
        raise RuntimeError(f"py-pde made {outputs} outputs of {times.size}")
    if not outputs:
        raise KeyboardInterrupt("nothing was computed yet")
    return np.array(storage.data)
