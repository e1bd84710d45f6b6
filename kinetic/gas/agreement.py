r"""The steady state of the gas: mean state and fluctuations in agreement.

The mean state needs the strength of collisions and shared motion (:mod:`.closure`), which follow
from the fluctuations about it (:mod:`.fluctuations`). Both are solved in turn until they agree.

**Covariance h' of the displacements of neighbourhoods**, which W_x has in place of h. After one rod
and pairs have agreed, the equation of :mod:`.fluctuations` is solved once more, with three changes.
The velocities keep h.

**Background.** W_x has the local part of f. So T_f, P/T_f and h_uu stand for Theta, n and h_c.

**Source.** Where two rods are about to collide there is one rod more, and 1/L of a rod fewer
everywhere, which displaces the label l': u Theta has Lambda(l) g(l') (step(l' - l) - l'/L). h has
g(l) in place of g(l'). To first order in 1 - e that is not right, but with this source W_v of the
first rod would be worse: two errors cancel.

**Relaxing stress.** Fluctuating gaps resist a sudden strain more than a slow one,

    dPi = P (dTheta/Theta - dg/g) + S,      S' = -alpha (alpha + 1) h_gg P d_l V/g - S/tau,

with the force P ~ g^-alpha of a gas that cools. h_gg of neighbouring gaps and tau, the mean time in
which squares of waves relax, follow from h' itself.
"""

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from scipy import optimize

from crazybilliards.kinetic.gas.cells import Cells, at_distance, make_cells, means
from crazybilliards.kinetic.gas.closure import Closure, implied
from crazybilliards.kinetic.gas.descriptions import Descriptions, Labels, MeanState
from crazybilliards.kinetic.gas.driven import driven_points
from crazybilliards.kinetic.gas.fluctuations import (
    Background,
    LinearResponse,
    PairCovariance,
    covariances,
    linear_response,
)
from crazybilliards.kinetic.gas.mean_state import Medium, NoSteadyStateError
from crazybilliards.model import Array, Chain

_CELLS_OF_DISPLACEMENTS = 130
_WAY = 0.9, 0.75, 0.5, 0.2  # restitutions that smaller ones are reached from
_AGREEMENT, _AGREEMENT_ON_THE_WAY = 1e-3, 0.05
_KEPT = 5  # steps of Anderson's acceleration
_MIXED = 0.5  # share of the residual in a step
_MOST_ITERATIONS = 60
_AGREEMENT_OF_STRESS = 1e-3  # of h_gg and ln tau; W_x changes by less than a tenth of it

State = TypeVar("State")


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
    descriptions: Descriptions
    fluctuations: Fluctuations | None = None
    residual: float = 0.0
    iterations: int = 0
    flux: Array | None = None  # n q at the fine cells of labels; None: that of the closure

    @property
    def labels(self) -> Labels | None:
        """Of exchangeable points."""
        return self.descriptions.labels


def mean_field(chain: Chain, cells: Cells) -> Steady:
    """Return the steady state in which colliding rods are independent."""
    medium, closure = Medium.of(chain), Closure.of_mean_field(cells.contacts)
    descriptions = Descriptions(chain, cells, mean_field=True)
    labels, off, flux = descriptions.labels, 0.0, None
    bare = not chain.box and chain.spring == "linear" and chain.size > 1
    if bare and chain.restitution > 1 and labels:
        # Their heavy tails are beyond a closure.
        found = driven_points(chain)
        T, flux = found.at(labels.score)
        mean = labels.averaged(T, labels.balanced(T, np.zeros(T.size)))
        off, flux = found.residual, chain.size * flux
    else:
        mean = descriptions.solve(medium, closure)
    return Steady(medium, cells, mean, closure, descriptions, residual=off, flux=flux)


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
    # h' varies slowly, so it takes fewer cells.
    coarse = make_cells(chain.size, _CELLS_OF_DISPLACEMENTS, walled=cells.walled)
    relaxing, displaced = relaxing_pairs(background.on(coarse))
    responses = linear_response(background), relaxing
    if (growth := max(each.largest_growth() for each in responses)) > 0:
        raise NoSteadyStateError(f"the state is not stable: deviations grow at the rate {growth:g}")
    found = Fluctuations(background, pairs, displaced)
    return Steady(medium, cells, mean, closure, descriptions, found, end.residual, iterations)


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


def relaxing_pairs(state: Background) -> tuple[LinearResponse, PairCovariance]:
    """Return the linear response with the stress, and h'."""
    T_f = state.temperature + state.shared - state.collective
    state = state._replace(
        density=state.pressure / T_f,
        temperature=T_f,
        strength=state.strength * np.sqrt(state.temperature / T_f),
        shared=state.collective,
    )
    contacts = state.cells.contacts

    def image(unknown: Array) -> tuple[Array, tuple[LinearResponse, PairCovariance]]:
        relaxing = _with_stress(state, np.maximum(unknown[:-1], 0.0), np.exp(unknown[-1]))
        pairs = covariances(state, relaxing)
        gaps = at_distance(pairs.gap, contacts, contacts, 1.0)
        return np.append(gaps, np.log(_memory(state, pairs))), (relaxing, pairs)

    return find_fixed_point(image, np.zeros(contacts.size + 1), _AGREEMENT_OF_STRESS).state


def _with_stress(state: Background, gaps: Array, tau: float) -> LinearResponse:
    """Return the response with the right source and with S/P; ``gaps``: h_gg of neighbours."""
    cells, loss, plain = state.cells, state.loss, linear_response(state)
    cooling = 2 * state.medium.damping * state.temperature
    alpha = (loss / 2 + cooling) / (1.5 * loss + cooling)
    excess = np.zeros(alpha.size)
    excess[cells.inner] = gaps
    K, S, (u, V, Th, _) = alpha.size, slice(len(plain.noise), None), state.parts
    generator, noise = (np.pad(matrix, (0, K)) for matrix in plain[:2])
    if not cells.walled:
        M = cells.rods.size
        below = np.tril(np.ones((M, M - 1)), -1) - cells.centres[:, None] / cells.rods.sum()
        noise[u, Th] = means(np.pad(state.gap, 1, mode="edge"))[:, None] * below * loss
        noise[Th, u] = noise[u, Th].T
    generator[V, S] = state.steps.T * state.pressure / cells.rods[:, None]
    generator[S, V] = -(alpha * (alpha + 1) * excess / state.mean_gaps)[:, None] * state.steps
    generator[S, S] = -np.eye(K) / tau
    scale = np.append(plain.scale, np.ones(K))
    return LinearResponse(generator, noise, scale, (*plain.fields, (K, 1)))


def _memory(state: Background, pairs: PairCovariance) -> float:
    """Return tau."""
    cells, size = state.cells, state.cells.rods.sum()
    q = np.arange(1, cells.rods.size)[:, None]
    waves = np.sqrt(2 / size) * np.cos(np.pi * q * cells.centres / size) * cells.rods
    moved, moving = (
        np.maximum(np.einsum("qi,ij,qj->q", waves, h, waves), np.finfo(float).tiny)
        for h in (pairs.displacement, pairs.velocity)
    )
    square = (2 * np.sin(np.pi * q / (2 * size))) ** 2
    P, gap, T = (each[cells.inner] for each in (state.pressure, state.gap, state.temperature))
    stiffness = state.stiffness.mean() + square * P / gap
    local = cells.distances / cells.distances.sum()
    velocity = T @ local + moving
    displacement = (T / stiffness) @ local + moved
    D, K = state.medium.damping / np.minimum(velocity, 1), velocity / displacement
    return float(np.average((1 / D + D / K) / 2, weights=square[:, 0] * moved))


class FixedPoint(NamedTuple, Generic[State]):
    """Where x = image(x), what was found there, the largest |image(x) - x|, and evaluations."""

    x: Array
    state: State
    residual: float
    evaluations: int


def find_fixed_point(
    image: Callable[[Array], tuple[Array, State]], start: Array, tolerance: float
) -> FixedPoint[State]:
    """Find x = image(x) by Anderson's acceleration; an image comes with a state.

    It agrees to ``tolerance`` in the largest component.
    """
    found: list[FixedPoint[State]] = []

    def off(x: Array) -> Array:
        other, state = image(x)
        evaluations = found.pop().evaluations if found else 0
        found.append(FixedPoint(x, state, _largest(other - x), evaluations + 1))
        return other - x

    try:
        agreed = optimize.root(
            off,
            start,
            method="anderson",
            options={
                "fatol": tolerance,
                "tol_norm": _largest,
                "maxiter": _MOST_ITERATIONS - 1,  # after the first
                "line_search": None,  # it would try states far from the last one
                "jac_options": {"alpha": _MIXED, "M": _KEPT},
            },
        ).success
    except ValueError:  # also of arrays that are not finite
        if not found:
            raise
        agreed = False  # a step to where there is no image
    if not agreed:
        raise NoSteadyStateError(
            f"no agreement after {found[-1].evaluations} iterations: what is looked for still "
            f"changes by {found[-1].residual:.2g}"
        )
    return found[-1]


def _largest(residual: Array) -> float:
    return float(np.abs(residual).max())
