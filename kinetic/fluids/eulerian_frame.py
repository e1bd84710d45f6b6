r"""Hydrodynamics on a grid of positions (Eulerian): ``eq9`` and ``modeleq`` of the paper.

With lengths in thermal lengths s, velocities in W, times in s/W, n = rho s/L and B = 2 R L/s, the
conserved quantities n, n V and, with a temperature, E = n (V^2 + theta)/2 obey

    n_t     + (n V)_x           = 0,
    (n V)_t + (n V^2 + p)_x     = -n f - Gamma n V,                  p = n theta/(1 - B n),
    E_t     + (V (E + p))_x     = -n V f - Gamma n (V^2 + theta - 1),

where f is the spring's force at the displacement u = x - (B + Lam) nu, nu = int n dx - 1/2, or at a
frozen profile u(x).

**Discretisation.** The finite volumes (:mod:`.finite_volumes`) are of second order and well
balanced, and n always stays positive and below close packing. The walls are far out, where the
density vanishes, and no flux passes them. The time steps are Runge-Kutta steps of four stages and
of fixed length. If the flow is faster than the step allows, the solution is computed again with
half the step.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from crazybilliards.kinetic.fluids.finite_volumes import (
    VACUUM,
    Constants,
    eulerian_rate,
    make_rate,
    primitive,
)
from crazybilliards.kinetic.fluids.flow_fields import FlowFields
from crazybilliards.kinetic.fluids.pde_solver import solve
from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.profiles import Profile
from crazybilliards.model import Chain
from crazybilliards.model.grid import position_grid, thermal_reach

Array = NDArray[np.float64]

_COURANT = 0.5
_MOST_COURANT = 1.0  # beyond, four-stage Runge-Kutta with second-order fluxes is not stable
_HALVINGS = 6
_CELL = 0.1  # default width in thermal lengths
_WIDEST_CELL = 0.5  # in thermal lengths; the scheme's error is then 0.01 to 0.03 of s
_MOST_BY_DEFAULT = 50_000
MOST_CELLS = 100_000
_POPULATED = 1e-12  # of the largest density; how far thinner places swing does not matter
_JUST_INSIDE = 1 - 1e-9  # an arctanh is infinite at its end
_ROOM = 9.5  # beyond the lattice of anchors, in thermal lengths
_MARGIN = 3.0  # beyond the farthest swing
_AT_THE_WALL = 1e-4  # rods per thermal length, as a share of all
_MOST_WORK = 4e10
_CELL_STEP = 2.6e-7  # seconds that a step of a cell takes
_MANY_STEPS = 25_000


def solve_on_positions(
    chain: Chain,
    start: Start,
    times: Array,
    number: int | None,
    *,
    variance: Profile | None,
    displacement: Profile | None,
    thermal: bool,
    progress: bool,
) -> FlowFields:
    """Solve from a start with ``number`` cells, by Runge-Kutta steps of py-pde.

    ``variance``: W^2(x) if prescribed; ``displacement``: <dx>(x) if frozen.
    """
    for wider in (1.0, 1.6, 2.5, 4.0):
        faces = make_faces(chain, start, number, wider)
        fields = starting_fields(chain, start, faces, thermal=thermal)
        constants = make_constants(chain, faces, variance, displacement)
        scaled = times * chain.free_velocity_width / chain.thermal_length
        solution = _integrate(fields, scaled, constants, progress=progress)
        if max(solution[:, 0, 0].max(), solution[:, 0, -1].max()) < _AT_THE_WALL:
            break
    else:
        raise ValueError("the rods spread without end on the grid of positions")
    unsteadiness = np.array([_unsteadiness(each, constants) for each in solution])
    return _on_grid(chain, faces, solution, constants.theta, unsteadiness)


def make_constants(
    chain: Chain, faces: Array, variance: Profile | None, displacement: Profile | None
) -> Constants:
    """Return the quantities that the rates depend on, at the cells between ``faces``."""
    s, W, L = chain.thermal_length, chain.free_velocity_width, chain.size
    x = (faces[1:] + faces[:-1]) / 2
    theta, frozen = np.ones(x.size), np.empty(0)
    if variance is not None:
        theta = np.asarray(variance.function(s * x), dtype=float) / W**2
    if displacement is not None:
        frozen = _frozen(displacement, s * x) / s
    return Constants(
        x,
        float(faces[1] - faces[0]),
        theta,
        frozen,
        crowd=2 * chain.radius * L / s,
        lam=chain.lattice_gap * L / s,
        gamma=chain.damping * s / (chain.mass * W),
        exponent=chain.potential_exponent,
    )


def _integrate(
    fields: dict[str, Array], times: Array, constants: Constants, *, progress: bool
) -> Array:
    """Take steps that resolve the fastest signal, whose speed is certain only afterwards."""
    rate = make_rate(constants)
    h, interval = constants.spacing, times[1] - times[0]
    fastest = _fastest(np.array(list(fields.values())), constants)
    for _ in range(_HALVINGS):
        steps = math.ceil(interval * fastest / (_COURANT * h))
        _refuse_endless(steps * (times.size - 1) * constants.x.size)
        solution = solve(
            rate,
            fields,
            times,
            progress=progress,
            solver="runge-kutta",
            # The rate is compiled already; compiling the steps as well takes some seconds.
            backend="numba" if steps * (times.size - 1) > _MANY_STEPS else "numpy",
            dt=interval / steps,
        )
        reached = math.inf
        if np.isfinite(solution).all():
            reached = max(_fastest(each, constants) for each in solution)
        if reached * interval / steps < _MOST_COURANT * h:
            return solution
        fastest = max(2 * fastest, reached if reached < math.inf else 0.0)
    raise ValueError("the flow gets too fast for the grid: give fewer cells or frame='label'")


def _frozen(profile: Profile, x: Array) -> Array:
    """Return <dx> at x; beyond the end of a profile it is continued with slope 1."""
    middle, half = (profile.right + profile.left) / 2, (profile.right - profile.left) / 2
    inside = x
    if np.isfinite(half):
        inside = middle + np.clip(x - middle, -half * _JUST_INSIDE, half * _JUST_INSIDE)
    values = np.asarray(profile.function(inside), dtype=float) + (x - inside)
    if not np.isfinite(values).all():
        raise ValueError("displacement must be finite on the grid of positions")
    return values


def make_faces(chain: Chain, start: Start, number: int | None, wider: float) -> Array:
    """Return the scaled positions of the cells' faces, beyond the farthest swing."""
    s, W, L = chain.thermal_length, chain.free_velocity_width, chain.size
    density = start.label(start.x, 1)
    there = density > _POPULATED * density.max()
    label = start.label(start.x)
    u = (start.x - (2 * chain.radius + chain.lattice_gap) * (label - L / 2))[there] / s
    swing = float(np.hypot(u, start.velocity(start.x)[there] / W).max())
    half = (chain.radius + chain.lattice_gap / 2) * L / s + wider * max(_ROOM, swing + _MARGIN)
    if number is None:
        number = min(math.ceil(2 * half / _CELL), _MOST_BY_DEFAULT)
    enough = 2 * half / _WIDEST_CELL
    if number < enough:
        advice = f"give cells={math.ceil(enough)}" if enough <= MOST_CELLS else "use frame='label'"
        raise ValueError(
            f"frame='eulerian' with {number} cells: each is {2 * half / number:.3g} thermal "
            f"lengths wide, {_WIDEST_CELL:g} at most resolve the flow; {advice}"
        )
    return np.linspace(-half, half, number + 1)


def starting_fields(chain: Chain, start: Start, faces: Array, *, thermal: bool) -> dict[str, Array]:
    """Return the means of n, nV and, if wanted, E over the cells."""
    s, W, L = chain.thermal_length, chain.free_velocity_width, chain.size
    at = np.clip(s * faces, start.x[0], start.x[-1])
    middle = np.clip(s * (faces[1:] + faces[:-1]) / 2, start.x[0], start.x[-1])
    h = faces[1] - faces[0]
    n = np.maximum(np.diff(start.label(at)) / (L * h), 0.0)
    n[0] += start.label(at[0]) / (L * h)
    v = start.velocity(middle) / W
    fields = {"n": n, "nV": n * v}
    if thermal:
        fields["E"] = n * (v**2 + start.variance(middle) / W**2) / 2
    return fields


def _fastest(fields: Array, constants: Constants) -> float:
    """Largest speed of a signal."""
    crowd = constants.crowd
    log_pressure, v, log_theta = primitive(fields, constants.theta, crowd).T
    free = np.exp(log_pressure - log_theta)
    here = free > 1e-9 * free.max()
    stiffness = math.sqrt(3) if len(fields) == 3 else 1.0
    speed = np.abs(v) + stiffness * np.exp(log_theta / 2) * (1 + crowd * free)
    return float(speed[here].max())


def _refuse_endless(work: float) -> None:
    if work > _MOST_WORK:
        raise ValueError(
            f"frame='eulerian' would take {work:.1e} steps of cells, about "
            f"{work * _CELL_STEP / 3600:.0f} hours; use frame='label'"
        )


def _unsteadiness(fields: Array, constants: Constants) -> float:
    """Rms of the velocity and of the acceleration over the rods."""
    n = np.maximum(fields[0], VACUUM)
    v = fields[1] / n
    rates = eulerian_rate(fields, *constants)
    # d(nV)/dt = n dV/dt + V dn/dt
    acceleration = (rates[1] - v * rates[0]) / n
    here = n > 1e-9 * n.max()
    share = fields[0][here] / fields[0][here].sum()
    return float(np.sqrt(share @ (v[here] ** 2 + acceleration[here] ** 2)))


def _on_grid(
    chain: Chain, faces: Array, solution: Array, theta: Array, unsteadiness: Array
) -> FlowFields:
    """Put the cells' means onto the position grid and the particles, in the chain's units."""
    s, W, L = chain.thermal_length, chain.free_velocity_width, chain.size
    h, middle = faces[1] - faces[0], (faces[1:] + faces[:-1]) / 2
    farthest = float(s * faces[-1] - chain.anchors[-1])
    x = position_grid(chain, max(farthest, thermal_reach(chain)))
    here = np.clip(x / s, faces[0], faces[-1])
    density, label, velocity, variance = np.empty((4, len(solution), x.size))
    rods, rod_velocities = np.empty((2, len(solution), L))
    for i, fields in enumerate(solution):
        _, v, log_theta = primitive(fields, theta, 2 * chain.radius * L / s).T
        count = CubicSpline(faces, np.concatenate([[0.0], np.cumsum(fields[0]) * h]))
        label[i] = L * count(here)
        # A spline through a shock may overshoot vacuum and close packing.
        there = np.clip(count(here, 1) * L / s, 0.0, (1 - 1e-9) * chain.close_packed_density)
        density[i] = np.where(here == x / s, there, 0.0)
        velocity[i] = W * np.interp(here, middle, v)
        variance[i] = W**2 * np.interp(here, middle, np.exp(log_theta))
        rods[i] = np.interp(chain.rank + L / 2, np.maximum.accumulate(label[i]), x)
        rod_velocities[i] = np.interp(rods[i], x, velocity[i])
    fields = (density, label, velocity, variance, rods, rod_velocities)
    return FlowFields(x, *fields, middle.size, unsteadiness)
