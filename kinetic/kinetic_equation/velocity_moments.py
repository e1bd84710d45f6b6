"""Moments of f(y, v) over the velocities, and the box of a mesh that fits such a distribution."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.kinetic_equation.velocity_space import Box, VelocitySpace
from crazybilliards.model.arrays import Array

_TAIL = 1e-5  # share of the points beyond which only a margin follows
_MARGIN = 1.5
_GROWTH = 1.6  # of a box in one go: ripples beyond a box that is too small look like a tail
_CORE = 0.45  # label up to which the core reaches, which the coldest place must be in


class Moments(NamedTuple):
    """Moments of f over v at each y of the quadrature, y ascending."""

    y: Array
    weights: Array
    density: Array
    flux: Array  # int v f dv
    variance: Array  # of the velocity
    heat_flux: Array  # int (v - V)^3 f dv / 2
    label: Array  # share of the points between 0 (or the lower end) and y


def moments(space: VelocitySpace, f: Array) -> Moments:
    """Integrate a distribution over the velocities."""
    table = space.table(space.interpolate(f)[0])
    density, first, second, third = (table @ (space.v_weights * space.v**n) for n in range(4))
    safe = np.where(density > 0, density, np.inf)
    flow = first / safe
    # Ripples in the vacuum far out may have any sign.
    variance = np.maximum(second / safe - flow**2, 0.0)
    heat_flux = (third - 3 * flow * second + 2 * flow**2 * first) / 2
    label = space.cumulative(density)
    return Moments(space.y, space.y_weights, density, first, variance, heat_flux, label)


def fitting_box(space: VelocitySpace, f: Array) -> Box:
    """Return the box that fits a symmetric f of mass 1; larger if f exceeds its present box."""
    profiles = moments(space, f)
    table = space.table(space.interpolate(f)[0])
    right = space.v > 0
    along_v = 2 * ((space.y_weights @ table) * space.v_weights)[right]
    coldest = float(profiles.variance[profiles.label < _CORE].min())
    if not coldest > 0:
        raise ValueError("the velocity variance became negative")
    wanted = Box(
        _end(profiles.y, profiles.density * profiles.weights),
        _end(space.v[right], along_v),
        float(np.interp(0.3, profiles.label, profiles.y)),
        1.5 * coldest**0.5,
    )
    return Box(*np.minimum(wanted, _GROWTH * np.array(space.box)))


def _end(places: Array, shares: Array) -> float:
    beyond = np.cumsum(shares[::-1])[::-1]
    return float(_MARGIN * places[np.flatnonzero(beyond > _TAIL)[-1]])
