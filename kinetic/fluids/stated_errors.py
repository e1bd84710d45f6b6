"""The errors that a solution in time states, and what it was released from."""

from __future__ import annotations

import math

import numpy as np

from crazybilliards.kinetic.accuracy import Release, UnmeasuredWarning, expected_in_time
from crazybilliards.kinetic.fluids.one_mass import has_one_mass, label_model_error, wave_model_error
from crazybilliards.kinetic.fluids.pde_solver import FlowFields
from crazybilliards.kinetic.starts import Start
from crazybilliards.kinetic.statics.label_closure import stationary
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.warn import warn_user

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
        error = errors["kinetic_energy_model_error"] = expected_in_time(
            chain, _released_from(chain, fields)
        )
        if math.isnan(error) and chain.restitution != 1:
            warn_user(
                "the error of the kinetic energy was not measured for chains and starts like these "
                "(it is NaN)",
                UnmeasuredWarning,
            )
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
        _warn_of_streams(chain, start, errors["label_model_error"])
    return errors


def _warn_of_streams(chain: Chain, start: Start, error: float) -> None:
    """Warn if a label is wrong or, where that is not known, if streams meet."""
    v = start.velocity(start.x)[start.label(start.x, 1) > _THINNEST * chain.size / np.ptp(start.x)]
    closing = float((np.maximum.accumulate(v) - v).max())
    if error > _WRONG:
        warn_user(
            f"the share of the rods on the left of a place is wrong by up to {error:.2g}: equal "
            "elastic rods pass through one another, and those of a fluid do not"
        )
    elif math.isnan(error) and closing > _FASTEST * chain.free_velocity_width:
        warn_user(
            f"two streams meet at {closing / chain.free_velocity_width:.3g} times the free "
            "velocity width: rods may pass through one another, and a fluid does not; the error "
            "of its density is not known"
        )


def _released_from(chain: Chain, fields: FlowFields) -> Release | None:
    """Return how the equilibrium at e = 1 was changed; None for any other start."""
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
    return Release(float(stretch), float(shift), float(heat.mean()))
