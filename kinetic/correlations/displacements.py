r"""Covariance h' of the displacements of neighbourhoods, which W_x has in place of h.

After one rod and pairs have agreed, the equation of :mod:`.pair_covariance` is solved once more,
with three changes, which docs/correlations.md derives. The velocities keep h.

**Background.** W_x has the local part of f. So T_f, P/T_f and h_uu stand for Theta, n and h_c.

**Source.** u Theta: Lambda(l) g(l') (step(l' - l) - l'/L).

**Relaxing stress.** Fluctuating gaps resist a sudden strain more than a slow one,

    dPi = P (dTheta/Theta - dg/g) + S,      S' = -alpha (alpha + 1) h_gg P d_l V/g - S/tau,

with the force P ~ g^-alpha of a gas that cools. h_gg of neighbouring gaps and tau, the mean time in
which squares of waves relax, follow from h' itself.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import block_diag

from crazybilliards.kinetic.correlations.pair_covariance import (
    Background,
    LinearResponse,
    PairCovariance,
    Problem,
    covariances,
    dissipation,
    linear_response,
    mirror_basis,
    parts,
    scales,
    steps,
)
from crazybilliards.kinetic.gas.cells import Cells, at_distance, of_cells
from crazybilliards.kinetic.gas.fixed_point import find_fixed_point
from crazybilliards.model.arrays import Array

_AGREEMENT = 1e-3  # of h_gg and ln tau; W_x changes by less than a tenth of it
_MOST_ITERATIONS = 40


def relaxing_pairs(
    problem: Problem, around: Background, collective: Array
) -> tuple[LinearResponse, PairCovariance]:
    """Return the linear response with the stress, and h', between whole cells, in free units.

    ``collective``: h_uu at the contacts, the variance of the collective velocities.
    """
    contacts, problem = problem.cells.contacts, problem.on_whole_cells()
    cells, damping = problem.cells, problem.damping
    _, gap, Theta, P, b, shared, collective = (
        np.interp(cells.contacts, contacts, each) for each in (*around, collective)
    )
    T_f = Theta + shared - collective
    state = Background(P / T_f, gap, T_f, P, b * np.sqrt(Theta / T_f), collective)
    loss, cooling = dissipation(problem, state), 2 * damping * T_f
    alpha = (loss / 2 + cooling) / (1.5 * loss + cooling)
    plain = linear_response(problem, state)
    known: list[tuple[LinearResponse, PairCovariance]] = []

    def image(unknown: Array) -> Array:
        excess, tau = alpha * (alpha + 1) * np.maximum(unknown[:-1], 0), np.exp(unknown[-1])
        relaxing = _with_stress(cells, state, plain, loss, excess, tau)
        known[:] = [(relaxing, pairs := covariances(cells, state, relaxing))]
        gaps = at_distance(pairs.gap, cells.contacts, cells.contacts, 1.0)
        return np.append(gaps, np.log(_memory(cells, state, pairs, damping)))

    find_fixed_point(image, np.zeros(cells.rods.size), _AGREEMENT, _MOST_ITERATIONS)
    return known[0]


def _with_stress(
    cells: Cells, state: Background, plain: LinearResponse, loss: Array, excess: Array, tau: float
) -> LinearResponse:
    """Return the response with the right source and with S, in units of P, at the contacts."""
    M, S = cells.rods.size, slice(len(plain.noise), None)
    (u, V, Th, _), scale, step = parts(M), scales(cells, state), steps(cells)
    below = np.tril(np.ones((M, M - 1)), -1) - cells.centres[:, None] / cells.rods.sum()
    source = of_cells(state.gap)[:, None] * below * loss
    generator, noise = (np.pad(each, (0, M - 1)) for each in plain[:2])
    noise[u, Th] = source / np.outer(scale[u], scale[Th])
    noise[Th, u] = noise[u, Th].T
    generator[V, S] = step.T * state.pressure / (cells.rods * scale[V])[:, None]
    generator[S, V] = -(excess / cells.distances / state.gap)[:, None] * step * scale[V]
    generator[S, S] = -np.eye(M - 1) / tau
    even, odd = plain.bases
    bases = block_diag(even, mirror_basis(M - 1, 1)), block_diag(odd, mirror_basis(M - 1, -1))
    return LinearResponse(generator, noise, bases)


def _memory(cells: Cells, state: Background, pairs: PairCovariance, damping: float) -> float:
    """Return tau."""
    q, size = np.arange(1, cells.rods.size)[:, None], cells.rods.sum()
    waves = np.sqrt(2 / size) * np.cos(np.pi * q * cells.centres / size) * cells.rods
    moved, moving = (
        np.maximum(np.einsum("qi,ij,qj->q", waves, h, waves), np.finfo(float).tiny)
        for h in (pairs.displacement, pairs.velocity)
    )
    square = (2 * np.sin(np.pi * q / (2 * size))) ** 2
    stiffness = 1 + square * state.pressure / state.gap
    local = cells.distances / cells.distances.sum()
    velocity = state.temperature @ local + moving
    displacement = (state.temperature / stiffness) @ local + moved
    D, K = damping / np.minimum(velocity, 1), velocity / displacement
    return float(np.average((1 / D + D / K) / 2, weights=square[:, 0] * moved))
