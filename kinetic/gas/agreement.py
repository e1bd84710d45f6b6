r"""The steady state of the gas: mean state and fluctuations in agreement.

The mean state needs the strength of collisions and shared motion (:mod:`.closure`), which follow
from the fluctuations about it (:mod:`.fluctuations`). Both are solved in turn until they agree.
"""

from typing import NamedTuple

import numpy as np

from crazybilliards.kinetic.gas.cells import Cells, make_cells
from crazybilliards.kinetic.gas.closure import Closure, implied
from crazybilliards.kinetic.gas.descriptions import Descriptions, Labels, MeanState
from crazybilliards.kinetic.gas.displacements import relaxing_pairs
from crazybilliards.kinetic.gas.driven import driven_points
from crazybilliards.kinetic.gas.fixed_point import find_fixed_point
from crazybilliards.kinetic.gas.fluctuations import (
    Background,
    PairCovariance,
    covariances,
    linear_response,
)
from crazybilliards.kinetic.gas.mean_state import Medium, NoSteadyStateError
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array

_CELLS_OF_DISPLACEMENTS = 130
_WAY = 0.9, 0.75, 0.5, 0.2  # restitutions that smaller ones are reached from
_AGREEMENT, _AGREEMENT_ON_THE_WAY = 1e-3, 0.05


class Fluctuations(NamedTuple):
    """Pairs about a mean state."""

    background: Background
    pairs: PairCovariance
    displaced: PairCovariance  # h'


class Steady(NamedTuple):
    """A steady state: the mean state and, with correlations, its fluctuations in agreement."""

    medium: Medium
    cells: Cells
    mean: MeanState
    closure: Closure
    labels: Labels | None  # of exchangeable points
    fluctuations: Fluctuations | None = None
    residual: float = 0.0
    iterations: int = 0
    flux: Array | None = None  # n q at the fine cells of labels; None: that of the closure


def mean_field(chain: Chain, cells: Cells) -> Steady:
    """Return the steady state in which colliding rods are independent."""
    medium, closure = Medium.of(chain), Closure.of_mean_field(cells.contacts)
    descriptions = Descriptions(chain, cells, mean_field=True)
    bare = not chain.box and chain.spring == "linear" and chain.size > 1
    # Their heavy tails are beyond a closure.
    if bare and chain.restitution > 1 and (labels := descriptions.labels):
        found = driven_points(chain)
        T, flux = found.at(labels.score)
        mean = labels.averaged(T, labels.balanced(T, np.zeros(T.size)))
        state = Steady(medium, cells, mean, closure, labels)
        return state._replace(residual=found.residual, flux=chain.size * flux)
    mean = descriptions.solve(medium, closure)
    return Steady(medium, cells, mean, closure, descriptions.labels)


def in_agreement(chain: Chain, cells: Cells) -> Steady:
    """Bring mean state and fluctuations of a chain with e <= 1 to agreement.

    At small restitutions the iteration would fail if it did not go by way of larger ones.
    """
    closure, iterations = Closure.of_mean_field(cells.contacts), 0
    descriptions = Descriptions(chain, cells)
    for e in (*(e for e in _WAY if e > chain.restitution), chain.restitution):
        medium = Medium.of(chain.replace(restitution=e))

        def image(
            vector: Array, medium: Medium = medium
        ) -> tuple[Array, tuple[MeanState, Background, PairCovariance]]:
            closure, slope = Closure.unpacked(vector), descriptions.slope
            mean = descriptions.solve(medium, closure)
            background = _background(medium, cells, mean, slope, closure)
            pairs = covariances(background, linear_response(background))
            return np.concatenate(implied(background, pairs)), (mean, background, pairs)

        tolerance = _AGREEMENT if e == chain.restitution else _AGREEMENT_ON_THE_WAY
        end = find_fixed_point(image, np.concatenate(closure), tolerance)
        closure, iterations = Closure.unpacked(end.x), iterations + end.evaluations
    mean, background, pairs = end.state
    if not closure.is_possible:
        raise NoSteadyStateError("the correlations are too large for a linear theory of them")
    found = Fluctuations(background, pairs, _displaced(background))
    labels = descriptions.labels
    return Steady(medium, cells, mean, closure, labels, found, end.residual, iterations)


def _displaced(background: Background) -> PairCovariance:
    """Return h', which varies slowly, on fewer cells; raise if the state is not stable."""
    size, walled = background.medium.size, background.cells.walled
    coarse = background.on(make_cells(size, _CELLS_OF_DISPLACEMENTS, walled=walled))
    relaxing, displaced = relaxing_pairs(coarse)
    responses = linear_response(background), relaxing
    if (growth := max(each.largest_growth() for each in responses)) > 0:
        raise NoSteadyStateError(f"the state is not stable: deviations grow at the rate {growth:g}")
    return displaced


def _background(
    medium: Medium, cells: Cells, mean: MeanState, slope: Array, closure: Closure
) -> Background:
    """Return what pairs fluctuate about; at a wall, what its rod has at its other contact."""

    def everywhere(values: Array) -> Array:
        return np.pad(values, 1, mode="edge") if cells.walled else values

    Theta = closure.relative_temperature(mean.contact_temperature)
    b = np.exp(closure.log_strength)
    return Background(
        medium,
        cells,
        density=everywhere(mean.force[cells.inner] / Theta),
        gap=everywhere(mean.gap[cells.inner]),
        temperature=everywhere(Theta),
        pressure=mean.force,
        strength=np.pad(b, 1) if cells.walled else b,
        shared=everywhere(mean.contact_temperature + closure.collective - Theta),
        collective=everywhere(closure.collective),
        stiffness=slope,
    )
