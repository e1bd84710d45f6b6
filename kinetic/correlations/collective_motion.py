"""The phase-space density where rods are, from that within their neighbourhoods.

The kinetic equation with pair correlations has f(y, v) of rods whose neighbourhood is where it is
in the mean. Neighbourhoods are displaced by u and move with V, Gaussian, independent at equal
times, with the variance h_uu each (see :mod:`.closure`). At a place one sees the convolution.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crazybilliards.kinetic.kinetic_equation.continuation import State
from crazybilliards.kinetic.kinetic_equation.velocity_moments import moments
from crazybilliards.model.arrays import Array

_NARROWEST = 1e-4  # of a Gaussian, in free units: far below any mesh


def as_seen_in_place(state: State, labels: Array, variance: Array) -> State:
    """Return the state with its collective motion, of the given variance at labels from 0 to L."""
    space, size = state.space, state.chain.size
    upper = size * (0.5 + moments(space, state.f).label)
    half = np.interp(upper, labels, variance)
    width = np.sqrt(np.maximum(np.concatenate([half[::-1], half]), _NARROWEST**2))
    y, v, f = space.sampled(state.f)
    y_weights = np.concatenate([space.y_weights[::-1], space.y_weights]) / 2
    moving = np.empty_like(f)
    for place in range(y.size):
        spread = _gaussian(v, space.v_weights, width[place])
        moving[place] = spread @ (space.v_weights * f[place])
    displaced = _gaussian(y, y_weights, width) @ (y_weights[:, None] * moving)
    upper_half = displaced[y.size // 2 :]
    return replace(state, f=space.project(lambda _y, _v: upper_half))


def _gaussian(x: Array, weights: Array, width: Array | float) -> Array:
    """Return the matrix of Gaussians about each x (columns), with integrals of 1 in quadrature."""
    peak = np.exp(-(((x[:, None] - x) / width) ** 2) / 2)
    return np.asarray(peak / (weights @ peak))
