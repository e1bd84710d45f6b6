r"""Covariance h' of the displacements of neighbourhoods, which W_x has in place of h.

After one rod and pairs have agreed, the equation of :mod:`.fluctuations` is solved once more,
with three changes. The velocities keep h.

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

import numpy as np

from crazybilliards.kinetic.gas.cells import at_distance, means
from crazybilliards.kinetic.gas.fixed_point import find_fixed_point
from crazybilliards.kinetic.gas.fluctuations import (
    Background,
    LinearResponse,
    PairCovariance,
    covariances,
    linear_response,
)
from crazybilliards.model.arrays import Array

_AGREEMENT = 1e-3  # of h_gg and ln tau; W_x changes by less than a tenth of it


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

    return find_fixed_point(image, np.zeros(contacts.size + 1), _AGREEMENT).state


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
