r"""Hydrodynamics on a grid of positions (Eulerian): ``eq9`` and ``modeleq`` of the paper.

The conserved quantities rho, rho V and, with a temperature, E = rho (V^2 + W^2)/2 obey

    rho_t     + (rho V)_x         = 0,
    (rho V)_t + (rho V^2 + p)_x   = -rho F/m - (gamma/m) rho V,      p = rho W^2/(1 - 2 R rho),
    E_t       + (V (E + p))_x     = -rho V F/m - (gamma/m) rho V^2 - Gamma_T rho (W^2 - W_0^2),

where Gamma_T = gamma <1/m>, W_0^2 = A^2/(2 m gamma) and F is the spring's force at the displacement
<dx> = x - (2 R + g)(N - L/2), N = int rho dx, or at a frozen profile <dx>(x). py-pde gets the grid
and these fields in the chain's units, R and t_0, and with these names.

**Discretisation.** The finite volumes (:mod:`.finite_volumes`) are of second order. The grid ends
far out, where the density vanishes, or at walls, where V = 0. The Runge-Kutta steps of four stages
have a fixed length, which resolves the speed that the springs give the rods. If the flow is faster,
the solution is computed again with half the step.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from crazybilliards.kinetic.fluids.finite_volumes import VACUUM, Constants, eulerian_rate, primitive
from crazybilliards.kinetic.fluids.pde_solver import FlowFields, solve
from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.label_closure import length_unit
from crazybilliards.kinetic.statics.profiles import Profile
from crazybilliards.model import Array, Chain
from crazybilliards.model.grid import position_grid

# Widths of a cell, by default and at most, over what it has to resolve. With the widest cells the
# scheme's error is 0.01 to 0.03 of s.
_CELL, _WIDEST_CELL = 0.1, 0.5
_MOST_BY_DEFAULT = 50_000
MOST_CELLS = 100_000
_POPULATED = 1e-12  # of the largest density; how far thinner places swing does not matter
_ROOM = 9.5  # beyond the lattice of anchors, in thermal lengths
_MARGIN = 3.0  # beyond the farthest swing
_COURANT = 0.5
_MOST_COURANT = 1.0  # beyond, four-stage Runge-Kutta with second-order fluxes is not stable
_HALVINGS = 6
# Speed of the rods [W] times the width of a cell [s], from which no step keeps the solution finite;
# with a temperature, which is what the energy of the flow leaves, it is less (7 and 1.7 work).
_SWIFTEST, _SWIFTEST_THERMAL = 8.0, 2.5
_JUST_INSIDE = 1 - 1e-9  # an arctanh is infinite at its end
_AT_THE_END = 1e-4  # of the density L/s
_MOST_WORK = 4e10
_CELL_STEP = 2.6e-7  # seconds that a step of a cell takes
_MANY_STEPS = 25_000


def solve_on_positions(
    chain: Chain,
    start: Start,
    times: Array,
    number: int | None,
    variance: Profile | None,
    displacement: Profile | None,
    *,
    thermal: bool,
    exchange: float,
    progress: bool,
) -> FlowFields:
    """Solve from a start with ``number`` cells; ``exchange`` is m Gamma_T/gamma."""
    for wider in (1.0, 1.6, 2.5, 4.0):
        faces = _make_faces(chain, start, times[-1], number, wider)
        fields = _starting_fields(chain, start, faces, thermal=thermal)
        constants = _make_constants(chain, faces, variance, displacement, exchange)
        solution = _integrate(fields, times, faces, constants, progress=progress)
        away = solution[:, 0][:, [0, -1]].max(axis=1) < _AT_THE_END * constants.dilute
        away |= constants.walled
        if len(solution) < times.size:
            solution = _before_the_first(away, solution)
            break
        if away.all():
            break
    else:
        raise ValueError("the rods spread without end on the grid of positions")
    return _on_grid(chain, faces, solution, constants)


def _make_faces(
    chain: Chain, start: Start, duration: float, number: int | None, wider: float
) -> Array:
    """Return the positions [R] of the cells' faces, beyond the farthest swing."""
    s, W, L = length_unit(chain), chain.free_velocity_width, chain.size
    density = start.label(start.x, 1)
    populated = density > _POPULATED * density.max()
    label = start.label(start.x)
    u = (start.x - (2 * chain.radius + chain.lattice_gap) * (label - L / 2))[populated] / s
    swing = float(np.hypot(u, start.velocity(start.x)[populated] / W).max())
    half = (chain.radius + chain.lattice_gap / 2) * L / s + wider * max(_ROOM, swing + _MARGIN)
    half = min(half, chain.box / (2 * s) if chain.box else math.inf)
    # Cells resolve the thermal length or, if shorter, all rods or the waves of a steep start.
    rods = float(np.ptp(start.x[populated]))
    most, slope = (np.abs(start.label(start.x[populated], order)).max() for order in (1, 2))
    steep = float(most / slope) if slope > 0 else math.inf
    finest = min(s, rods / 20, max(W * duration, steep, rods / 100)) / s
    if number is None:
        number = min(math.ceil(2 * half / (_CELL * finest)), _MOST_BY_DEFAULT)
    enough = 2 * half / (_WIDEST_CELL * finest)
    if number < enough:
        advice = f"give cells={math.ceil(enough)}" if enough <= MOST_CELLS else "use frame='label'"
        raise ValueError(
            f"frame='eulerian' with {number} cells: each is {2 * half / number:.3g} thermal "
            f"lengths wide, {_WIDEST_CELL * finest:.3g} at most resolve the flow; {advice}"
        )
    return s * np.linspace(-half, half, number + 1)


def _starting_fields(
    chain: Chain, start: Start, faces: Array, *, thermal: bool
) -> dict[str, Array]:
    """Return the means of rho, rho V and, if wanted, E over the cells, by these names."""
    at = np.clip(faces, start.x[0], start.x[-1])
    middle = np.clip((faces[1:] + faces[:-1]) / 2, start.x[0], start.x[-1])
    h = faces[1] - faces[0]
    rho = np.maximum(np.diff(start.label(at)) / h, 0.0)
    rho[0] += start.label(at[0]) / h
    if chain.box:
        rho[-1] += (chain.size - start.label(at[-1])) / h
    rho *= chain.size / (h * rho.sum())  # cubics between nodes may overshoot at a jump
    v = start.velocity(middle)
    fields = {"rho": rho, "rho V": rho * v}
    if thermal:
        fields["E"] = rho * (v**2 + start.variance(middle)) / 2
    return fields


def _make_constants(
    chain: Chain,
    faces: Array,
    variance: Profile | None,
    displacement: Profile | None,
    exchange: float,
) -> Constants:
    """Return the quantities that the rates depend on, at the cells between ``faces``."""
    s, W, L = length_unit(chain), chain.free_velocity_width, chain.size
    x = (faces[1:] + faces[:-1]) / 2
    return Constants(
        x,
        float(faces[1] - faces[0]),
        np.full(x.size, W**2) if variance is None else variance.function(x),
        np.empty(0) if displacement is None else _frozen(displacement, x),
        size=L,
        rod=2 * chain.radius,
        lattice=2 * chain.radius + chain.lattice_gap,
        stiffness=chain.stiffness / chain.mass,
        damping=chain.damping / chain.mass,
        heating=exchange * chain.damping / chain.mass,
        exponent=chain.potential_exponent,
        heat=W**2,
        dilute=L / s,
        walled=chain.box > 0,
    )


def _integrate(
    fields: dict[str, Array], times: Array, faces: Array, constants: Constants, *, progress: bool
) -> Array:
    """Take steps that resolve the fastest signal, whose speed is certain only afterwards."""
    h, s, interval = constants.spacing, constants.size / constants.dilute, times[1] - times[0]
    start = np.array(list(fields.values()))
    fastest = _fastest(start, constants)
    drawn, W = _drawn(start, float(times[-1]), constants), math.sqrt(constants.heat)
    if drawn * h > (_SWIFTEST_THERMAL if len(start) == 3 else _SWIFTEST) * W * s:
        raise ValueError(
            f"the springs move the rods at up to {drawn / W:.3g} times the free velocity width, "
            "too fast for cells of this width in frame='eulerian'; use frame='label'"
        )
    if drawn > _MOST_COURANT / _COURANT * fastest:
        fastest += drawn
    for _ in range(_HALVINGS):
        steps = math.ceil(interval * fastest / (_COURANT * h))
        work = float(steps * (times.size - 1) * constants.x.size)
        if work > _MOST_WORK:
            raise ValueError(
                f"frame='eulerian' would take {work:.1e} steps of cells, about "
                f"{work * _CELL_STEP / 3600:.0f} hours; use frame='label'"
            )
        solution = solve(
            lambda values, time: eulerian_rate(values, constants),
            fields,
            (faces[0], faces[-1]),
            times,
            progress=progress,
            solver="runge-kutta",
            # The rate is compiled already; compiling the steps as well takes some seconds.
            backend="numba" if steps * (times.size - 1) > _MANY_STEPS else "numpy",
            dt=interval / steps,
        )
        speeds = [_fastest(f, constants) if np.isfinite(f).all() else math.inf for f in solution]
        resolved = np.array(speeds) * interval / steps < _MOST_COURANT * h
        if len(solution) < times.size:  # Ctrl-C ended it
            return _before_the_first(resolved, solution)
        if resolved.all():
            return solution
        fastest = max(2 * fastest, max(speeds) if max(speeds) < math.inf else 0.0)
    raise ValueError("the flow gets too fast for the grid: give fewer cells or frame='label'")


def _before_the_first(sound: NDArray[np.bool_], solution: Array) -> Array:
    """Return the times of a solution before the first one that is not sound."""
    if not (number := int(np.argmin(np.append(sound, False)))):
        raise KeyboardInterrupt("nothing was computed yet")
    return solution[:number]


def _drawn(fields: Array, duration: float, constants: Constants) -> float:
    """Return the speed that the springs give the centre of mass, at most."""
    rods = fields[0] * constants.spacing
    labels = np.cumsum(rods) - rods / 2 - constants.size / 2
    u = constants.frozen if constants.frozen.size else constants.x - constants.lattice * labels
    centre, v = (
        abs(each) / constants.size for each in (rods @ u, fields[1].sum() * constants.spacing)
    )
    n, pull = constants.exponent, constants.stiffness * centre ** (constants.exponent - 1)
    gained = min(pull * duration, pull / constants.damping if constants.damping else math.inf)
    return min(v + gained, math.hypot(v, math.sqrt(2 * pull * centre / n)))


def _frozen(profile: Profile, x: Array) -> Array:
    """Return <dx> at x; beyond the end of a profile it is continued with slope 1."""
    middle, half = (profile.right + profile.left) / 2, (profile.right - profile.left) / 2
    inside = x
    if np.isfinite(half):
        inside = middle + np.clip(x - middle, -half * _JUST_INSIDE, half * _JUST_INSIDE)
    values = profile.function(inside) + (x - inside)
    if not np.isfinite(values).all():
        raise ValueError("displacement must be finite on the grid of positions")
    return values


def _fastest(fields: Array, constants: Constants) -> float:
    """Largest speed of a signal."""
    log_pressure, v, log_variance = primitive(fields, constants).T
    free = constants.dilute * np.exp(log_pressure - log_variance)
    occupied = free > 1e-9 * free.max()
    sound = math.sqrt(3) if len(fields) == 3 else 1.0
    W = math.sqrt(constants.heat)
    speed = np.abs(v) + sound * W * np.exp(log_variance / 2) * (1 + constants.rod * free)
    return float(speed[occupied].max())


def _unsteadiness(fields: Array, constants: Constants) -> float:
    """Rms of the velocity [W] and of the acceleration [W^2/s] over the rods."""
    n = np.maximum(fields[0], VACUUM * constants.dilute)
    v = fields[1] / n
    rates = eulerian_rate(fields, constants)
    # d(nV)/dt = n dV/dt + V dn/dt
    acceleration = (rates[1] - v * rates[0]) / n
    occupied = n > 1e-9 * n.max()
    share = fields[0][occupied] / fields[0][occupied].sum()
    s = constants.size / constants.dilute
    square = v[occupied] ** 2 / constants.heat + (acceleration[occupied] * s / constants.heat) ** 2
    return float(np.sqrt(share @ square))


def _on_grid(chain: Chain, faces: Array, solution: Array, constants: Constants) -> FlowFields:
    """Put the cells' means onto the position grid and the particles."""
    L = chain.size
    h, middle = faces[1] - faces[0], (faces[1:] + faces[:-1]) / 2
    x = position_grid(chain, max(float(faces[-1] - chain.anchors[-1]), chain.thermal_reach))
    within = np.clip(x, faces[0], faces[-1])
    density, label, velocity, variance = np.empty((4, len(solution), x.size))
    rods, rod_velocities = np.empty((2, len(solution), L))
    unsteadiness, energy = np.empty((2, len(solution)))  # energy: of the flow and of the heat
    for i, fields in enumerate(solution):
        _, v, log_variance = primitive(fields, constants).T
        heat = constants.heat * np.exp(log_variance)
        count = CubicSpline(faces, np.concatenate([[0.0], np.cumsum(fields[0]) * h]))
        label[i] = count(within)
        # A spline through a shock may overshoot vacuum and close packing.
        reduced = np.clip(count(within, 1), 0.0, (1 - 1e-9) * chain.close_packed_density)
        density[i] = np.where(within == x, reduced, 0.0)
        velocity[i] = np.interp(within, middle, v)
        variance[i] = np.interp(within, middle, heat)
        rods[i] = np.interp(chain.rank + L / 2, np.maximum.accumulate(label[i]), x)
        rod_velocities[i] = np.interp(rods[i], x, velocity[i])
        unsteadiness[i] = _unsteadiness(fields, constants)
        energy[i] = fields[0] @ (v**2 + heat) / fields[0].sum()
    return FlowFields(
        x,
        density,
        label,
        velocity,
        variance,
        rods,
        rod_velocities,
        middle.size,
        unsteadiness,
        energy,
    )
