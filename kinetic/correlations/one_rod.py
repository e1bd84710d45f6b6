r"""What the pair correlations need of the one-rod distribution f(y, v), at the contacts.

Rods i and i + 1 of L independent points meet where i - 1 others lie on one side and L - i - 1 on
the other: the label of their contact is distributed as Beta(i, L - i), and what happens there,
temperature, force and loss, is a mean over it. The mean gap of the two follows from the chance
binom(L, i) N^i (1 - N)^(L - i) that a place with the label N lies between them,

    <y_{i+1} - y_i> = int binom(L, i) N^i (1 - N)^(L-i) dy = E[1/n] L/(L + 1),

the mean being over Beta(i + 1, L - i + 1).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.gas.cells import Cells
from crazybilliards.kinetic.kinetic_equation.continuation import State
from crazybilliards.kinetic.kinetic_equation.order_statistics import LabelAverage, mirrored
from crazybilliards.kinetic.kinetic_equation.velocity_moments import Moments, moments
from crazybilliards.model.arrays import Array


class OneRod(NamedTuple):
    """Profiles of f at the M - 1 contacts, in free units."""

    temperature: Array  # T, variance of the velocity
    force: Array  # n T
    gap: Array  # mean gap of two neighbours
    cubes: Array  # n <|v - u|^3>, with 8/sqrt(pi) as the unit: n T^(3/2) of Gaussians


def profiles_of_one_rod(cells: Cells, state: State) -> OneRod:
    """Return the profiles at the contacts."""
    profiles, size = moments(state.space, state.f), state.chain.size
    whole, below = mirrored(profiles), cells.contacts
    above = below[::-1]  # L - below, to the last bit
    labels = LabelAverage(whole)
    density = size * np.maximum(whole.density, np.finfo(float).tiny)
    cubes = size * _cubes(state, profiles)
    cubes = np.concatenate([cubes[::-1], cubes])
    return OneRod(
        labels.mean(whole.variance, below, above),
        labels.mean(density * whole.variance, below, above),
        labels.mean(1 / density, below + 1, above + 1) * size / (size + 1),
        labels.mean(cubes, below, above),
    )


def _cubes(state: State, profiles: Moments) -> Array:
    """Return int int |v - u|^3 f f du dv over int f dv."""
    space = state.space
    table = space.table(space.interpolate(state.f)[0])
    partners = table @ (np.abs(space.v[:, None] - space.v) ** 3 * space.v_weights).T
    both = (table * partners) @ space.v_weights * np.sqrt(np.pi) / 8
    density = profiles.density
    return np.divide(both, density, out=np.zeros_like(both), where=density > 0)
