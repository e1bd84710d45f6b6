"""Starts of the kinetic equation in time: f(y, v) itself, or a density with Maxwellians."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator, RectBivariateSpline

from crazybilliards.kinetic.kinetic_equation.weak_form import Units
from crazybilliards.kinetic.starts import read_start, require_rods
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array
from crazybilliards.model.checks import refuse_units
from crazybilliards.model.vocabulary import require

REACH = 6.5  # of a mesh, in widths of a Gaussian


@dataclass(frozen=True)
class PhaseSpaceStart:
    """f as a function of y and v, and its extent, in scaled units."""

    f: Callable[[Array, Array], Array]
    length: float
    velocity: float


def read_phase_space(chain: Chain, units: Units, start: xr.Dataset) -> PhaseSpaceStart:
    """Check a start, f(y, v) itself or a density over x, and make a function of it."""
    length, velocity = units
    if "phase_space_density" not in start:
        return _maxwellian(chain, units, start)
    require(start, ("phase_space_density",))
    density = start.phase_space_density
    if density.dims != ("y", "velocity"):
        raise ValueError(
            f"start: phase_space_density must be over y and velocity, got {density.dims}"
        )
    refuse_units("start: phase_space_density", density)
    y, v = start.y.values / length, start.velocity.values / velocity
    values = density.values
    if not (np.isfinite(values).all() and values.max() > 0):
        raise ValueError("start: phase_space_density must be finite and not zero everywhere")
    spline = RectBivariateSpline(y, v, values / values.max())
    rods = spline.integral(y[0], y[-1], v[0], v[-1]) * values.max() * length * velocity
    require_rods(chain, "phase_space_density", rods)

    def f(at_y: Array, at_v: Array) -> Array:
        inside = (np.abs(at_y - y.mean()) <= np.ptp(y) / 2)[:, None]
        inside = inside & (np.abs(at_v - v.mean()) <= np.ptp(v) / 2)
        return np.where(inside, spline(at_y, at_v), 0.0)

    return PhaseSpaceStart(f, float(np.abs(y).max()), float(np.abs(v).max()))


def _maxwellian(chain: Chain, units: Units, start: xr.Dataset) -> PhaseSpaceStart:
    length, velocity = units
    known = read_start(chain, start)
    x, R, L = known.x, chain.radius, chain.size
    y = (x - 2 * R * (known.label(x) - L / 2)) / length
    density = np.maximum(known.label(x, 1), 0.0)
    reduced = density / np.maximum(1 - 2 * R * density, 1e-12)
    kept = np.concatenate([[True], np.diff(y) > 0])
    log_density, flow, variance = (
        PchipInterpolator(y[kept], values[kept], extrapolate=False)
        for values in (
            np.log(np.maximum(reduced / reduced.max(), 1e-30)),
            known.velocity(x) / velocity,
            known.variance(x) / velocity**2,
        )
    )
    populated = kept & (reduced > 1e-9 * reduced.max())
    widest = float(np.sqrt(known.variance(x[populated]).max())) / velocity

    def f(at_y: Array, at_v: Array) -> Array:
        inside = np.isfinite(log_density(at_y))
        where = np.where(inside, at_y, y[kept].mean())
        W2 = variance(where)[:, None]
        values = np.exp(
            log_density(where)[:, None] - (at_v - flow(where)[:, None]) ** 2 / (2 * W2)
        ) / np.sqrt(W2)
        return np.where(inside[:, None], values, 0.0)

    fastest = float(np.abs(known.velocity(x[populated])).max()) / velocity
    return PhaseSpaceStart(f, float(np.abs(y[populated]).max()), fastest + REACH * widest)
