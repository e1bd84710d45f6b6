r"""The errors that a solution in time states, and what it was released from.

Equal elastic rods only exchange their velocities. Without springs, in a box and in the reduced
coordinate, each point of such a gas moves as if it were alone. The slowest wave of density,
k = pi/(X - 2RL), then decays exactly as

    exp(-k^2 M(t)/2),      G = gamma/m,      M(t) as in :mod:`crazybilliards.kinetic.exact.motion`,

while small deviations of the fluid's density r, velocity w, temperature h and heat flux f obey

    r' = -k w,      w' = k W^2 (r + h) - G w,      h' = -2 k w - k f - 2 G h,
    f' = 3 k W^2 h - 3 G f,

without the last line if there is no heat flux, f = 0, and without the last two if the fluid is
isothermal, h = 0. The two agree if damping is strong, where both diffuse. With weak damping the
fluid has sound, and such a gas has none.

Without a gap equal elastic rods on linear springs are such points, too. From any start the position
of a point is then normal, with the mean and the variance

    y(t) = a y + b V,      s^2 (1 - a^2) + b^2 (W_0^2 - W^2),      s^2 (1 - a^2) = M(t) at k = 0,

where a and b are the first row of exp(B t), B = [[0, 1], [-k/m, -G]], and W_0^2 is the variance at
the start. In a box every cosine of the density decays by itself.
"""

import math

import numpy as np
from scipy.linalg import expm

from crazybilliards.kinetic.accuracy import expected_in_time, warn_if_unmeasured
from crazybilliards.kinetic.exact.motion import free_spread
from crazybilliards.kinetic.fluids.pde_solver import FlowFields
from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.label_closure import stationary
from crazybilliards.model import Array, Chain
from crazybilliards.model.warn import warn_user

_TIMES = 400
_MOMENTS, _POINTS, _WAVES, _PLACES = 20, 1000, 200, 300
_FARTHEST = 8.0  # standard deviations of a point
_LIKE = 0.02  # how far positions [s] and velocities [W] may be from such a state
_NO_FLUID, _WRONG = 0.1, 0.15  # error of a wave, and of the label, that is told of
_THINNEST = 1e-3  # of the mean density: streams that are thinner do not matter
_FASTEST = 4.0  # speed at which two streams meet [W], where a fluid may not describe them


def errors_to_state(
    chain: Chain, start: Start, fields: FlowFields, times: Array, *, thermal: bool
) -> dict[str, float]:
    """Return the errors to state, by name, and warn of those that are large or not known."""
    duration, times = float(times[-1]), times[: len(fields.label)]
    errors = {"label_model_error": label_model_error(chain, start, fields, times)}
    if thermal:
        release = _released_from(chain, fields)
        error = expected_in_time(chain, *release) if release else math.nan
        errors["kinetic_energy_model_error"] = error
        if chain.restitution != 1:
            warn_if_unmeasured("the kinetic energy", error, "chains and starts like these")
    wave = 0.0
    if has_one_mass(chain):
        moments = 2 if not thermal else 3 if fields.heat_flux is None else 4
        wave = errors["wave_model_error"] = wave_model_error(chain, duration, moments=moments)
    if wave > _NO_FLUID:
        warn_user(
            f"equal elastic rods without springs are no fluid: within duration={duration:g} a "
            f"wave of density is wrong by up to {wave:.0%} of its height; rods of two masses "
            "(mass_ratio) or a damping above 4 pi m W/(X - 2RL) make them one"
        )
    else:
        _warn_of_streams(chain, start, errors["label_model_error"], thermal=thermal)
    return errors


def _warn_of_streams(chain: Chain, start: Start, error: float, *, thermal: bool) -> None:
    """Warn if a label is wrong or, where that is not known, if streams meet."""
    v = start.velocity(start.x)[start.label(start.x, 1) > _THINNEST * chain.size / np.ptp(start.x)]
    closing = float((np.maximum.accumulate(v) - v).max())
    if error > _WRONG:
        held = "" if thermal else "; velocity_variance='evolving' lets its temperature change"
        warn_user(
            f"the share of the rods on the left of a place is wrong by up to {error:.2g}: equal "
            f"elastic rods pass through one another, and those of a fluid do not{held}"
        )
    elif math.isnan(error) and closing > _FASTEST * chain.free_velocity_width:
        warn_user(
            f"two streams meet at {closing / chain.free_velocity_width:.3g} times the free "
            "velocity width: rods may pass through one another, and a fluid does not; the error "
            "of its density is not known"
        )


def _released_from(chain: Chain, fields: FlowFields) -> tuple[float, float, float] | None:
    """Return how the equilibrium at e = 1 was changed: the arguments of ``expected_in_time``.

    None for any other start.
    """
    s, W, L = chain.thermal_length, chain.free_velocity_width, chain.size
    x, density, label, flow, variance = (
        each[0] if each.ndim == 2 else each
        for each in (fields.x, fields.density, fields.label, fields.velocity, fields.variance)
    )
    if not math.isfinite(s):
        return None
    inside = density > 1e-3 * density.max()
    x, label, weight = x[inside], label[inside], np.sqrt(density[inside])
    y = (x - 2 * chain.radius * (label - L / 2)) / s
    state = stationary(chain)
    rest = state.unit * state.at(np.clip(label / L - 0.5, -0.5 + 1e-9, 0.5 - 1e-9)) / s
    stretch, shift = np.polyfit(rest, y, 1, w=weight)
    off = np.abs(y - stretch * rest - shift) * weight
    heat = variance[inside] / W**2
    moves = np.abs(flow[inside]).max() > _LIKE * W
    if moves or off.max() > _LIKE * weight.max() or np.ptp(heat) > _LIKE * heat.mean():
        return None
    return float(stretch), float(shift), float(heat.mean())


def has_one_mass(chain: Chain) -> bool:
    """Return whether the rods are equal and elastic, in a box without springs."""
    alone = chain.box > 0 == chain.stiffness
    return alone and chain.restitution == chain.wall_restitution == chain.mass_ratio == 1


def wave_model_error(chain: Chain, duration: float, *, moments: int) -> float:
    """Return the largest error of the fluid's slowest wave, in units of its first height.

    ``moments`` of the fluid: 2 if it is isothermal, 3 with a temperature, 4 with the heat flux.
    """
    W, G = chain.free_velocity_width, chain.damping / chain.mass
    k = math.pi / (2 * chain.walls[1])
    rates = np.array(
        [
            [0, -k, 0, 0],
            [k * W**2, -G, k * W**2, 0],
            [0, -2 * k, -2 * G, -k],
            [0, 0, 3 * k * W**2, -3 * G],
        ]
    )[:moments, :moments]
    t = np.linspace(0, duration, _TIMES)
    step, state, wave = expm(rates * t[1]), np.eye(moments)[0], []
    for _ in t:
        wave.append(state[0])
        state = step @ state
    return float(np.abs(wave - np.exp(-(k**2) * free_spread(chain, t) / 2)).max())


def label_model_error(chain: Chain, start: Start, fields: FlowFields, times: Array) -> float:
    """Return the largest error of the label, over L; NaN unless the rods are independent points."""
    points = has_one_mass(chain) or (chain.exchangeable and not chain.box)
    alike = chain.restitution == chain.mass_ratio == 1 and chain.spring == "linear"
    if not (points and alike):
        return math.nan
    L, W, G = chain.size, chain.free_velocity_width, chain.damping / chain.mass
    x = start.positions(L * (np.arange(_POINTS) + 0.5) / _POINTS)
    y = x - 2 * chain.radius * (start.label(x) - L / 2)
    rates = np.array([[0, 1], [-chain.stiffness / chain.mass, -G]])
    nodes = np.linspace(0, fields.x.size - 1, _PLACES).astype(int)
    errors = []
    for k in np.unique(np.linspace(0, times.size - 1, _MOMENTS).astype(int)):
        a, b = expm(rates * times[k])[0]
        if chain.stiffness:
            spread = np.asarray(chain.thermal_length**2 * (1 - a**2))
        else:
            spread = free_spread(chain, times[k])
        variance = np.maximum(spread + b**2 * (start.variance(x) - W**2), 0.0)
        label = fields.label[k, nodes] / L
        at = fields.x[nodes] - 2 * chain.radius * L * (label - 0.5)
        exact = _share_below(at, a * y + b * start.velocity(x), np.sqrt(variance), chain.walls[1])
        errors.append(np.abs(label - exact).max())
    return float(max(errors))


def _share_below(at: Array, mean: Array, width: Array, wall: float) -> Array:
    """Return which share of normal points is below some places; walls at +-wall fold their laws."""
    end = min(wall, float(np.abs([at[0], at[-1], *(np.abs(mean) + _FARTHEST * width)]).max()))
    k = np.pi * np.arange(1, _WAVES + 1) / (2 * end)
    k = k[k * width.min() < 9]  # shorter waves are below rounding
    waves = (np.cos(np.outer(k, mean + end)) * np.exp(-(np.outer(k, width) ** 2) / 2)).mean(axis=1)
    place = np.clip(at + end, 0, 2 * end)
    return np.asarray(place / (2 * end) + (waves / (k * end)) @ np.sin(np.outer(k, place)))
