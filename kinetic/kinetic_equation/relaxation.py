r"""The kinetic equation in time: relaxation of the phase-space density f(y, v, t).

This module solves the equation of :mod:`.weak_form` from any start on the whole (y, v) plane. The
time scheme is Crank-Nicolson. Force and collision integrals are extrapolated from the two steps
before to the middle of the step. The scheme is of second order and stable, and it conserves the
number of rods exactly. If force and integrals do not depend on f (restitution 1 and no gap, the
Kramers equation), the matrix is factorised only once.

The mesh contains the start and the motion of a free rod. For e > 1 it is enlarged when f reaches
its border, and the solution ends as "diverged" when the energy has grown a thousandfold.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.sparse import csc_matrix
from scipy.stats import norm

from crazybilliards.kinetic.accuracy import expected_relax_phase_space, warn_if_unmeasured
from crazybilliards.kinetic.kinetic_equation.continuation import free_units
from crazybilliards.kinetic.kinetic_equation.relaxation_result import in_vocabulary, snapshot
from crazybilliards.kinetic.kinetic_equation.start import REACH, PhaseSpaceStart, read_phase_space
from crazybilliards.kinetic.kinetic_equation.stationary_result import positions
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.kinetic.kinetic_equation.velocity_space import (
    Box,
    VelocitySpace,
    factorised,
    one_thread,
)
from crazybilliards.kinetic.kinetic_equation.weak_form import (
    Coefficients,
    Equation,
    Mean,
    Units,
    coefficients,
)
from crazybilliards.kinetic.requirements import output_times, require_chain
from crazybilliards.kinetic.starts import check_start
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import check_integer, check_real
from crazybilliards.model.memory import require_memory
from crazybilliards.model.progress import progress_bar

_STEP = 0.04  # in units of the spring's 1/w0
_CELLS = 20
_LARGEST_MESH = 80
_BYTES_PER_CELL = 1.1e5
_BYTES_PER_OUTPUT = 600  # and cell: f at six points in each direction, twice
_BYTES_PER_NODE = 20  # of x, and output
_OUTPUTS = 50
_CORE = 1.5
_LOST = 2e-4  # share of the points on a line of the outermost cells at which the mesh is enlarged
_NEGATIVE = 0.1
_DIVERGED = 1e3  # times the energy of the start or the free rod
_ENLARGED = 1.4
_LIKE = 0.1  # share of the points that a start may have in other places than an equilibrium


@one_thread
def relax_phase_space(
    chain: Chain,
    start: xr.Dataset | None = None,
    duration: float | None = None,
    *,
    every: float | None = None,
    time_step: float | None = None,
    cells: int = _CELLS,
    progress: bool = True,
) -> xr.Dataset:
    """Solve the kinetic equation in time.

    Parameters
    ----------
    chain
        The chain, with a restitution near 1, both springs, and any gap (in mean field).
    start
        A result with ``phase_space_density``, e.g. ``phase_space`` of another chain. Or a start
        of ``hydrodynamics``: a result with ``density`` over x and optionally ``label``,
        ``flow_velocity`` and ``velocity_variance``, such as ``displaced``, ``compressed`` or
        ``force_balance`` of another chain. Velocities are then Maxwellian around the flow.
    duration
        Time to solve for [t_0].
    every
        Time between outputs [t_0]; None: a fiftieth of the duration.
    time_step
        Longest step [t_0]; None: 0.04 of the spring's s/W. The error of the moments is a quarter of
        its square in these units, 4e-4.
    cells
        Number of cells from the centre to the end of the mesh in each direction. Its square
        times 110 kB, and 600 bytes for each output, are needed.
    progress
        Show a progress bar, on a terminal or in a notebook.

    Returns
    -------
    xarray.Dataset
        ``phase_space_density`` over (time, y, velocity); ``density`` and ``label`` over (time, x);
        ``mean_displacement``, ``mean_velocity``
        and ``velocity_width`` (about zero) over (time, particle), of points drawn independently
        from f; over time ``rods``, ``centre``, ``cloud_width``, ``kinetic_energy`` and
        ``covariance``. ``attrs["status"]`` is ``diverged`` if the energy grew without bound, or
        ``interrupted`` if Ctrl-C ended it. The result then has the times before.
        ``attrs["kinetic_energy_model_error"]`` is the largest relative error of
        ``kinetic_energy`` at any time that the theory had in simulations of chains like this one,
        released from their equilibrium at e = 1, or from there with y multiplied by 0.4 to 1. It
        is NaN, with an ``UnmeasuredWarning``, for other starts, and where none was measured.

    Notes
    -----
    All rods are independent here, the centre of mass included. ``phase_space`` corrects its widths
    for the centre of mass, on which collisions do not act; widths and energy of this function are
    not corrected. For e < 1 the energy is therefore too small, in the steady state too: by 5 % for
    10 and 4 % for 30 rods at e = 0.9.

    Raises
    ------
    ValueError
        For a missing or wrong argument or start, before any work; for e <= 1, if rods that cool
        become more concentrated than the mesh resolves, with the time of the last output before.

    Examples
    --------
    >>> from crazybilliards.kinetic import displaced
    >>> chain = Chain(size=20)
    >>> flow = relax_phase_space(chain, displaced(chain, 1.0), 20, cells=12, progress=False)
    >>> flow.centre.values[[0, -1]].round(2) + 0.0
    array([ 1.  , -0.09])
    """
    start = check_start(start, ", and phase_space of another one with f itself")
    times = output_times(duration, every, _OUTPUTS)
    count, interval = times.size - 1, times[1]
    cells = check_integer("cells", cells, least=4, most=_LARGEST_MESH)
    bytes_per_cell = _BYTES_PER_CELL + _BYTES_PER_OUTPUT * float(count)
    require_memory(f"{count} outputs on cells={cells}", bytes_per_cell * cells**2)
    require_chain(chain, "the kinetic equation in time")
    units = free_units(chain)
    unit_time = units.length / units.velocity
    if time_step is not None:
        time_step = check_real("time_step", time_step, positive=True) / unit_time
    steps = max(1, math.ceil(interval / unit_time / (time_step or _STEP) - 1e-9))
    flow = _start(chain, units, read_phase_space(chain, units, start), cells)
    nodes = positions(chain, units.length, flow.space).size
    require_memory(f"every: {count} outputs", _BYTES_PER_NODE * float(nodes) * count)
    outputs = [snapshot(chain, units, flow.space, flow.f, flow.energy())]
    most = _DIVERGED * max(flow.energy(), 1.0)
    status = "completed"
    try:
        for _ in progress_bar(progress, range(count), desc="kinetic equation", unit=" outputs"):
            flow = flow.advanced(interval / unit_time / steps, steps)
            sound = flow.sound()
            if chain.restitution <= 1 and not sound:
                raise ValueError(
                    f"the kinetic equation in time could not be solved beyond "
                    f"{times[len(outputs) - 1]:g}: on cells={cells} the distribution became "
                    "negative, because it is narrower than the mesh resolves; a shorter duration "
                    "or more cells can help"
                )
            if not sound or flow.energy() > most:
                status = "diverged"
                break
            outputs.append(snapshot(chain, units, flow.space, flow.f, flow.energy()))
    except KeyboardInterrupt:
        status = "interrupted"
    dataset = in_vocabulary(chain, units, outputs, times[: len(outputs)], flow.space, status)
    released = _compression(chain, outputs[0])
    error = dataset.attrs["kinetic_energy_model_error"] = expected_relax_phase_space(
        chain, released
    )
    warn_if_unmeasured("the kinetic equation in time", error)
    return dataset


def _compression(chain: Chain, start: Mapping[str, Any]) -> float:
    """Return what y of the equilibrium at e = 1 was multiplied by; NaN for any other start."""
    if chain.gap > 0:
        return math.nan
    y, v, width = start["y"], start["v"], start["cloud_width"]
    released = norm.pdf(y, scale=width)[:, None] * norm.pdf(v, scale=chain.free_velocity_width)
    off = np.abs(start["phase_space_density"] / chain.size - released)
    share = np.trapezoid(np.trapezoid(off, v), y) / 2
    return round(width / chain.thermal_length, 2) if share < _LIKE else math.nan


@dataclass(frozen=True)
class _Flow:
    """The distribution on its mesh, and the fields of the step before for the extrapolation."""

    numbers: Coefficients
    space: VelocitySpace
    f: Array
    before: Mean | None = None

    def energy(self) -> float:
        """Mean of v^2, 1 for free rods."""
        return float(self.space.whole_energy @ self.f)

    def sound(self) -> bool:
        """Return whether this is still a distribution; a diverging energy exceeds every mesh."""
        profiles = moments(self.space, self.f)
        spread = (profiles.density * profiles.weights) @ profiles.y**2
        return bool(self.energy() > 0 and spread > 0 and self.f.min() > -_NEGATIVE * self.f.max())

    def advanced(self, dt: float, steps: int) -> _Flow:
        """Take ``steps`` steps of length ``dt``."""
        flow, step = self._enlarged(), None
        linear = self.numbers.drag == self.numbers.diffusion == self.numbers.gap == 0
        equation = Equation(flow.space, flow.numbers)
        inertia = flow.space.gram.tocsc()
        f, before = flow.f, flow.before
        for _ in range(steps):
            if step is None or not linear:
                now = equation.mean(f)
                step = _step(inertia, equation.matrix(_midway(now, before)), dt)
                before = now
            f = step(f)
        return _Flow(self.numbers, flow.space, f, before)

    def _enlarged(self) -> _Flow:
        """Move to a larger mesh if f has reached the border, which is possible for e > 1."""
        if self.numbers.drag >= 0:
            return self
        space = self.space
        table = space.table(space.interpolate(self.f)[0])
        shares = table * space.y_weights[:, None] * space.v_weights
        # In sums over whole lines the ripples of an uneven start largely cancel.
        lost_y, lost_v = (
            float(np.abs(shares.sum(axis=axis))[[0, 1, 2, -3, -2, -1]].max()) for axis in (1, 0)
        )
        if max(lost_y, lost_v) < _LOST:
            return self
        box = space.box._replace(
            length=space.box.length * (_ENLARGED if lost_y >= _LOST else 1),
            velocity=space.box.velocity * (_ENLARGED if lost_v >= _LOST else 1),
        )
        larger = VelocitySpace(box, space.cells, symmetric=False)
        f = larger.take_over(space, self.f)
        total = space.whole_mass @ self.f
        return _Flow(self.numbers, larger, f * total / (larger.whole_mass @ f))


def _step(inertia: csc_matrix, matrix: csc_matrix, dt: float) -> Callable[[Array], Array]:
    solve = factorised(inertia - dt / 2 * matrix).solve
    explicit = inertia + dt / 2 * matrix
    return lambda f: np.asarray(solve(explicit @ f))


def _midway(now: Mean, before: Mean | None) -> Mean:
    if before is None:
        return now
    return Mean(*(1.5 * a - 0.5 * b for a, b in zip(now, before, strict=True)))


def _start(chain: Chain, units: Units, start: PhaseSpaceStart, cells: int) -> _Flow:
    order = 2 if chain.restitution <= 1 else 1
    lattice = chain.lattice_gap * chain.size / (2 * units.length)
    # A harmonic oscillation turns an extent along y into one along v.
    swing = max(REACH, start.length - lattice, start.velocity)
    box = Box(lattice + swing, swing, lattice + _CORE, _CORE)
    space = VelocitySpace(box, cells, symmetric=False)
    f = space.project(start.f)
    total = space.whole_mass @ f
    if not total > 0:
        raise ValueError("start: its velocities lie too far apart for the mesh, which misses them")
    return _Flow(coefficients(chain, units, order), space, f / total)
