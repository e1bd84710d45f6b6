r"""Covariance h' of the displacements of neighbourhoods, which W_x has in place of h.

After one rod and pairs have agreed, the equation of :mod:`.fluctuations` is solved once more,
with three changes, which docs/gas.md derives. The velocities keep h.

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

from crazybilliards.kinetic.gas.cells import at_distance, of_cells
from crazybilliards.kinetic.gas.fixed_point import find_fixed_point
from crazybilliards.kinetic.gas.fluctuations import (
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
from crazybilliards.model.arrays import Array

_AGREEMENT = 1e-3  # of h_gg and ln tau; W_x changes by less than a tenth of it
_MOST_ITERATIONS = 40


def relaxing_pairs(
    problem: Problem, state: Background, collective: Array
) -> tuple[LinearResponse, PairCovariance]:
    """Return the linear response with the stress, and h'.

    ``collective``: K h_uu at all contacts, the variance of the collective velocities.
    """
    Theta, damping = state.temperature, problem.medium.damping
    T_f = Theta + state.shared - collective
    state = state._replace(
        density=state.pressure / T_f,
        temperature=T_f,
        strength=state.strength * np.sqrt(Theta / T_f),
        shared=collective,
    )
    loss, cooling = dissipation(problem, state), 2 * damping * T_f
    alpha = (loss / 2 + cooling) / (1.5 * loss + cooling)
    plain = linear_response(problem, state)
    known: list[tuple[LinearResponse, PairCovariance]] = []

    def image(unknown: Array) -> Array:
        excess = np.zeros(alpha.size)
        excess[problem.inner] = np.maximum(unknown[:-1], 0)
        excess *= alpha * (alpha + 1)
        relaxing = _with_stress(problem, state, plain, loss, excess, np.exp(unknown[-1]))
        known[:] = [(relaxing, pairs := covariances(problem, state, relaxing))]
        contacts = problem.cells.contacts
        gaps = at_distance(pairs.gap, contacts, contacts, 1.0)
        return np.append(gaps, np.log(_memory(problem, state, pairs)))

    find_fixed_point(image, np.zeros(problem.cells.rods.size), _AGREEMENT, _MOST_ITERATIONS)
    return known[0]


def _with_stress(
    problem: Problem,
    state: Background,
    plain: LinearResponse,
    loss: Array,
    excess: Array,
    tau: float,
) -> LinearResponse:
    """Return the response with the right source and with S, in units of P, at the contacts."""
    cells, apart, S = problem.cells, problem.distances, slice(len(plain.noise), None)
    K = apart.size
    (u, V, Th, _), scale, step = parts(problem), scales(problem, state), steps(problem)
    generator, noise = (np.pad(matrix, (0, K)) for matrix in plain[:2])
    if not problem.medium.walled:
        M = cells.rods.size
        below = np.tril(np.ones((M, M - 1)), -1) - cells.centres[:, None] / cells.rods.sum()
        source = of_cells(state.gap)[:, None] * below * loss
        noise[u, Th] = source / np.outer(scale[u], scale[Th])
        noise[Th, u] = noise[u, Th].T
    generator[V, S] = step.T * state.pressure / (cells.rods * scale[V])[:, None]
    generator[S, V] = -(excess / apart / state.gap)[:, None] * step * scale[V]
    generator[S, S] = -np.eye(K) / tau
    even, odd = plain.bases
    bases = block_diag(even, mirror_basis(K, 1)), block_diag(odd, mirror_basis(K, -1))
    return LinearResponse(generator, noise, bases)


def _memory(problem: Problem, state: Background, pairs: PairCovariance) -> float:
    """Return tau."""
    cells, size = problem.cells, problem.cells.rods.sum()
    q = np.arange(1, cells.rods.size)[:, None]
    waves = np.sqrt(2 / size) * np.cos(np.pi * q * cells.centres / size) * cells.rods
    moved, moving = (
        np.maximum(np.einsum("qi,ij,qj->q", waves, h, waves), np.finfo(float).tiny)
        for h in (pairs.displacement, pairs.velocity)
    )
    square = (2 * np.sin(np.pi * q / (2 * size))) ** 2
    inner = problem.inner
    P, gap, T = state.pressure[inner], state.gap[inner], state.temperature[inner]
    stiffness = state.stiffness.mean() + square * P / gap
    local = cells.distances / cells.distances.sum()
    velocity = T @ local + moving
    displacement = (T / stiffness) @ local + moved
    D, K = problem.medium.damping / np.minimum(velocity, 1), velocity / displacement
    return float(np.average((1 / D + D / K) / 2, weights=square[:, 0] * moved))
