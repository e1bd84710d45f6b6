r"""Fluctuations of the gas about its steady state: stationary covariances of pairs of rods.

For uniform granular fluids driven by noise see T. P. C. van Noije and others
(arXiv:cond-mat/9810251) and, with friction, G. Gradenigo and others (arXiv:1103.0166).

The equations of :mod:`crazybilliards.kinetic.gas`, linear in small deviations: displacement u and
velocity V of a place, relative temperature Theta and third moment q of the velocities about V. With
n rods per length where they collide, n = P/Theta, the mean gap g and the stiffness K of a spring,

    u' = V,
    V' = -Gamma V - K u - d_l dPi,     dPi = P (dTheta/Theta - dg/g),   dg = d_l u,
    dTheta' = -2 P d_l V - d_l (n q) - 2 Gamma dTheta - Lambda (1.5 dTheta/Theta - dg/g),
    q' = -3 n Theta d_l dTheta - (3 Gamma + b c n sqrt(Theta)) q:

rods that pass freely, with <c^4> closed as that of a Gaussian, springs, damping and cooling. c is
``decay`` of :mod:`.collision_moments` and b the strength of collisions. There are no forces beyond
open ends. A wall is a contact with a neighbour that does not move, without loss and noise. For
quadratic springs K is the mean slope 2 <|x|> at each rod. Written x' = M x, the covariance of all
fields is a local part, that of independent rods (Theta delta(l - l') for
velocities, g^2 delta(l - l') for gaps), plus h, and

    M h + h M^T + Q = 0.

Q is what collisions do to two independent rods, [psi, phi] of :mod:`.collision_moments`:

    V V:            2 Gamma h_c, and Lambda between the two      q q:  b [H3, H3] n Theta^(7/2)
    V q:            b [v, H3] n Theta^(5/2)             Theta Theta:  b [H2, H2] n Theta^(5/2)
    g Theta:        Lambda g, as rods that are close by chance collide, and cool, more often.

**The noise of the velocities** is exact in its sum. Noise feeds the total momentum with 2 Gamma W^2
per rod, collisions with nothing. The local part holds Theta of it, which damping takes out at the
rate 2 Gamma Theta. What feeds h is the rest, 2 Gamma (W^2 - Theta), and with the energy of all
rods, Gamma sum (W^2 - T) = sum Lambda/2, and Theta = T - h_c, that is Lambda + 2 Gamma h_c. The
centre of mass then has the variance W^2/L whatever e is, as it must.

**Where it sits.** A collision makes the covariance <v_i v_{i+1}> of two rods and takes from <v_i^2>
and <v_{i+1}^2>, which the local part holds. So Lambda stands beside the diagonal: a contact adds
half of it to (i, i + 1) and half to (i + 1, i). For waves that is the same as on the diagonal, at
the border it is not.
"""

from __future__ import annotations

import warnings
from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag, eigvals, solve_continuous_lyapunov

from crazybilliards.kinetic.gas.cells import Cells, of_cells
from crazybilliards.kinetic.gas.collision_moments import CollisionMoments, moments_of_collisions
from crazybilliards.kinetic.gas.mean_state import Medium, NoSteadyStateError
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array


class Problem(NamedTuple):
    """A chain in the units of the gas, its cells, and what a collision does."""

    medium: Medium
    cells: Cells
    moments: CollisionMoments

    @classmethod
    def of(cls, chain: Chain, cells: Cells) -> Problem:
        """Make the problem of a chain."""
        return cls(Medium.of(chain), cells, moments_of_collisions(chain.restitution))

    @property
    def distances(self) -> Array:
        """Rods across the K contacts: M - 1 of cells, and two at walls."""
        return self.cells.all_distances(self.medium.walled)

    @property
    def inner(self) -> slice:
        """Which of all contacts lie between two cells."""
        return slice(1, -1) if self.medium.walled else slice(None)


class Background(NamedTuple):
    """The steady state that pairs fluctuate about, at all K contacts; ``stiffness`` at cells."""

    density: Array  # n, rods per length where they collide, P/Theta
    gap: Array  # g, the mean gap of two rods
    temperature: Array  # Theta
    pressure: Array  # P
    strength: Array  # b, 0 at walls
    shared: Array  # h_c, the covariance of neighbours' velocities
    stiffness: Array  # K, (M,)


class PairCovariance(NamedTuple):
    """Stationary covariances h between M cells or M - 1 contacts."""

    velocity: Array  # of cells
    displacement: Array  # of cells
    gap: Array  # of contacts, relative to the mean gaps
    gap_temperature: Array  # of contacts, relative to both means
    temperature: Array  # of contacts, relative to the means


class LinearResponse(NamedTuple):
    """M and Q for a chain, in even and odd halves under its mirror image."""

    generator: Array
    noise: Array
    bases: tuple[Array, Array]  # columns: even, odd

    def stationary(self) -> Array:
        """Return h."""
        h = np.zeros_like(self.noise)
        for basis in self.bases:
            generator, noise = (basis.T @ matrix @ basis for matrix in (self.generator, self.noise))
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)  # rates too far apart for doubles
                try:
                    half = solve_continuous_lyapunov(generator, -noise)
                except RuntimeWarning as problem:
                    raise NoSteadyStateError(f"its fluctuations: {problem}") from problem
            h += basis @ ((half + half.T) / 2) @ basis.T
        return h

    def largest_growth(self) -> float:
        """Return the largest rate at which a deviation grows; negative: all of them decay."""
        return max(float(eigvals(b.T @ self.generator @ b).real.max()) for b in self.bases)


def dissipation(problem: Problem, state: Background) -> Array:
    """Return Lambda at all contacts."""
    energy = problem.moments.energy
    return np.asarray(state.strength * energy * state.density * state.temperature**1.5)


def covariances(problem: Problem, state: Background, response: LinearResponse) -> PairCovariance:
    """Return what is stationary, of a response that may have more fields."""
    scale, inner = scales(problem, state), problem.inner
    h = response.stationary()[: scale.size, : scale.size] * np.outer(scale, scale)
    u, V, Th, _ = parts(problem)
    relative = (steps(problem) / _mean_gaps(problem, state)[:, None])[inner]
    Theta = state.temperature[inner]
    return PairCovariance(
        velocity=h[V, V],
        displacement=h[u, u],
        gap=relative @ h[u, u] @ relative.T,
        gap_temperature=relative @ h[u, Th][:, inner] / Theta,
        temperature=h[Th, Th][inner, inner] / np.outer(Theta, Theta),
    )


def linear_response(problem: Problem, state: Background) -> LinearResponse:
    """Return M and Q, every field in units of its own size, which keeps them well conditioned."""
    M, scale = problem.cells.rods.size, scales(problem, state)
    generator = _generator(problem, state) * scale / scale[:, None]
    noise = _noise(problem, state) / np.outer(scale, scale)
    _, _, Th, q = parts(problem)
    # u, V and q change sign in the mirror.
    fields = ((M, -1), (M, -1), (Th.stop - Th.start, 1), (q.stop - q.start, -1))
    even, odd = (
        block_diag(*(mirror_basis(size, parity * sign) for size, sign in fields))
        for parity in (1, -1)
    )
    return LinearResponse(generator, noise, (even, odd))


def _generator(problem: Problem, state: Background) -> Array:
    medium, cells, moments = problem
    M, apart, step = cells.rods.size, problem.distances, steps(problem)
    n, Theta, P, gaps = state.density, state.temperature, state.pressure, _mean_gaps(problem, state)
    loss, damping = dissipation(problem, state), medium.damping
    u, V, Th, q = parts(problem)
    A = np.zeros((q.stop, q.stop))
    force = step.T / cells.rods[:, None]  # minus the difference of the pressures on both sides
    A[u, V] = np.eye(M)
    A[V, V] = -damping * np.eye(M)
    A[V, u] = -np.diag(state.stiffness) - force @ (step * (P / gaps)[:, None])
    A[V, Th] = force * (P / Theta)
    A[Th, V] = -2 * (P / apart)[:, None] * step
    A[Th, u] = (loss / gaps)[:, None] * step
    A[Th, Th] = -np.diag(2 * damping + 1.5 * loss / Theta)
    n, Theta, b = (_means(values) for values in (n, Theta, state.strength))
    some = _with_flux(problem)
    A[Th, q] = -step[:, some] * n / apart[:, None]
    across = np.diff(np.eye(apart.size), axis=0)
    A[q, Th] = -3 * (n * Theta / cells.rods[some])[:, None] * across
    A[q, q] = -np.diag(3 * damping + b * moments.decay * n * np.sqrt(Theta))
    return A


def _noise(problem: Problem, state: Background) -> Array:
    medium, cells, moments = problem
    N, inner, some = cells.rods, problem.inner, _with_flux(problem)
    n, Theta, b = state.density, state.temperature, state.strength
    loss = dissipation(problem, state)
    u, V, Th, q = parts(problem)
    Q = np.zeros((q.stop, q.stop))
    kept = 2 * medium.damping * _at_cells(problem, state.shared) / N
    # Of the contacts that one between cells stands for, the others lie within the two.
    within = (1 - 1 / cells.distances) * loss[inner]
    between = loss[inner] / (2 * N[1:] * N[:-1])
    Q[V, V] = np.diag(_of_cell_means(cells, within) + kept)
    Q[V, V] += np.diag(between, 1) + np.diag(between, -1)
    Q[u, Th] = _displacements(problem) * (loss * state.gap)
    Q[Th, u] = Q[u, Th].T
    Q[Th, Th] = np.diag(b * moments.temperature * n * Theta**2.5 / problem.distances)
    of_flux = np.diag(_of_cell_means(cells, (b * moments.velocity_heat * n * Theta**2.5)[inner]))
    Q[V, q] = of_flux[:, some]
    Q[q, V] = Q[V, q].T
    Q[q, q] = np.diag(_of_cell_means(cells, (b * moments.heat * n * Theta**3.5)[inner])[some])
    return Q


def _displacements(problem: Problem) -> Array:
    """Return the displacements of cells, (M, K), for a unit that each gap is longer.

    Without walls the centre of mass is at rest. Between walls the other gaps give way evenly, by
    the smallest change that keeps their sum.
    """
    if problem.medium.walled:
        return np.asarray(np.linalg.pinv(steps(problem)))
    N = problem.cells.rods
    sums = np.tril(np.ones((N.size, N.size - 1)), -1)
    return np.asarray(sums - N @ sums / N.sum())


def _of_cell_means(cells: Cells, strength: Array) -> Array:
    """Return the noise of cells' means: a contact gives each of its two sides one half."""
    halves = cells.distances * strength / 2
    return np.asarray((np.append(halves, 0.0) + np.append(0.0, halves)) / cells.rods**2)


def _at_cells(problem: Problem, at_contacts: Array) -> Array:
    return _means(at_contacts) if problem.medium.walled else of_cells(at_contacts)


def _with_flux(problem: Problem) -> slice:
    """Return which cells have a heat flux of their own: all but the last at open ends."""
    return slice(None) if problem.medium.walled else slice(1, -1)


def parts(problem: Problem) -> tuple[slice, slice, slice, slice]:
    """Return the places of u, V (cells), Theta (contacts) and q (cells but those at open ends)."""
    M, K = problem.cells.rods.size, problem.distances.size
    return (
        slice(0, M),
        slice(M, 2 * M),
        slice(2 * M, 2 * M + K),
        slice(2 * M + K, 2 * M + 2 * K - 1),
    )


def steps(problem: Problem) -> Array:
    """Return the matrix from cells to contacts: the next cell minus this one, a wall being 0."""
    M = problem.cells.rods.size
    whole = np.diff(np.eye(M + 2)[:, 1:-1], axis=0)
    return whole if problem.medium.walled else whole[1:-1]


def _mean_gaps(problem: Problem, state: Background) -> Array:
    return problem.distances * state.gap


def _means(at_contacts: Array) -> Array:
    return (at_contacts[1:] + at_contacts[:-1]) / 2


def scales(problem: Problem, state: Background) -> Array:
    """Return the size of every field."""
    M, Theta = problem.cells.rods.size, state.temperature
    gap = np.full(M, _mean_gaps(problem, state).mean())
    return np.concatenate([gap, np.full(M, np.sqrt(Theta.mean())), Theta, _means(Theta) ** 1.5])


def mirror_basis(size: int, sign: int) -> Array:
    """Return the orthonormal basis of vectors whose mirror image is ``sign`` times themselves."""
    half = size // 2
    basis = np.zeros((size, half + (size % 2 if sign == 1 else 0)))
    rows = np.arange(half)
    basis[rows, rows] = np.sqrt(0.5)
    basis[size - 1 - rows, rows] = sign * np.sqrt(0.5)
    if basis.shape[1] > half:
        basis[half, half] = 1.0
    return basis
