r"""Stationary covariances of pairs of rods: fluctuating hydrodynamics in the frame of labels.

For uniform granular fluids driven by noise see T. P. C. van Noije and others
(arXiv:cond-mat/9810251) and, with friction, G. Gradenigo and others (arXiv:1103.0166).

Rods carry slow fields along the chain: displacement u and velocity V of a place, relative
temperature Theta and third moment q = <c^3> of the velocities about V. With n(l) rods per length
and the mean gap g(l) at label l, Lambda what collisions at a contact take from the sum of v^2 per
time, P the force between neighbours over the mass, all in units of the free rod (k/m = 1, W = 1,
Gamma its damping), small deviations from the steady state obey

    u' = V,
    V' = -Gamma V - u - d_l dPi,       dPi = P (dTheta/Theta - dg/g),   dg = d_l u,
    dTheta' = -2 P d_l V - d_l (n q) - 2 Gamma dTheta - Lambda (1.5 dTheta/Theta - dg/g),
    q' = -3 n Theta d_l dTheta - (3 Gamma + b c n sqrt(Theta)) q:

rods that pass freely, with <c^4> closed as that of a Gaussian, springs, damping and cooling. c is
``decay`` of :mod:`.collision_moments` and b the strength of collisions. There are no forces beyond
the ends. Written x' = M x, the covariance of all fields is a local part, that of independent rods
(Theta delta(l - l') for velocities, g^2 delta(l - l') for gaps), plus h, and

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

from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag, eigvals, solve_continuous_lyapunov

from crazybilliards.kinetic.gas.cells import Cells, make_cells, of_cells
from crazybilliards.kinetic.gas.collision_moments import CollisionMoments, moments_of_collisions
from crazybilliards.kinetic.kinetic_equation.continuation import free_units
from crazybilliards.kinetic.kinetic_equation.weak_form import coefficients
from crazybilliards.model import Chain
from crazybilliards.model.arrays import Array


class Problem(NamedTuple):
    """A chain, its cells, what a collision does, and the damping in free units."""

    chain: Chain
    cells: Cells
    moments: CollisionMoments
    damping: float

    @classmethod
    def of(cls, chain: Chain) -> Problem:
        """Make the problem of a chain."""
        moments = moments_of_collisions(chain.restitution)
        damping = coefficients(chain, free_units(chain), 2).damping
        return cls(chain, make_cells(chain.size), moments, damping)

    def on_whole_cells(self) -> Problem:
        """Return the problem with cells none of which is shorter than a rod."""
        return self._replace(cells=make_cells(self.chain.size, whole=True))


class Background(NamedTuple):
    """The steady state that pairs fluctuate about, at the M - 1 contacts, in free units."""

    density: Array  # n, rods per length where they collide, P/Theta
    gap: Array  # g, the mean gap of two rods
    temperature: Array  # Theta
    pressure: Array  # P
    strength: Array  # b
    shared: Array  # h_c, the covariance of neighbours' velocities


class PairCovariance(NamedTuple):
    """Stationary covariances h between M cells or M - 1 contacts, in free units."""

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
            generator, noise = (basis.T @ each @ basis for each in (self.generator, self.noise))
            half = solve_continuous_lyapunov(generator, -noise)
            h += basis @ ((half + half.T) / 2) @ basis.T
        return h

    def largest_growth(self) -> float:
        """Return the largest rate at which a deviation grows; negative: all of them decay."""
        return max(float(eigvals(b.T @ self.generator @ b).real.max()) for b in self.bases)


def dissipation(problem: Problem, state: Background) -> Array:
    """Return Lambda at the contacts."""
    energy = problem.moments.energy
    return np.asarray(state.strength * energy * state.density * state.temperature**1.5)


def solve_pairs(problem: Problem, state: Background) -> PairCovariance:
    """Solve the Lyapunov equation of this module."""
    return covariances(problem.cells, state, linear_response(problem, state))


def covariances(cells: Cells, state: Background, response: LinearResponse) -> PairCovariance:
    """Return what is stationary, of a response that may have more fields."""
    scale = scales(cells, state)
    h = response.stationary()[: scale.size, : scale.size] * np.outer(scale, scale)
    u, V, Th, _ = parts(cells.rods.size)
    relative = steps(cells) / _mean_gaps(cells, state)[:, None]
    return PairCovariance(
        velocity=h[V, V],
        displacement=h[u, u],
        gap=relative @ h[u, u] @ relative.T,
        gap_temperature=relative @ h[u, Th] / state.temperature,
        temperature=h[Th, Th] / np.outer(state.temperature, state.temperature),
    )


def linear_response(problem: Problem, state: Background) -> LinearResponse:
    """Return M and Q, every field in units of its own size, which keeps them well conditioned."""
    M, scale = problem.cells.rods.size, scales(problem.cells, state)
    generator = _generator(problem, state) * scale / scale[:, None]
    noise = _noise(problem, state) / np.outer(scale, scale)
    fields = ((M, -1), (M, -1), (M - 1, 1), (M - 2, -1))  # u, V and q change sign in the mirror
    even, odd = (
        block_diag(*(mirror_basis(size, parity * sign) for size, sign in fields))
        for parity in (1, -1)
    )
    return LinearResponse(generator, noise, (even, odd))


def _generator(problem: Problem, state: Background) -> Array:
    _, cells, moments, damping = problem
    M, N, apart, step = cells.rods.size, cells.rods, cells.distances, steps(cells)
    n, Theta, P, gaps = state.density, state.temperature, state.pressure, _mean_gaps(cells, state)
    energy = dissipation(problem, state)
    u, V, Th, q = parts(M)
    A = np.zeros((4 * M - 3, 4 * M - 3))
    force = step.T / N[:, None]  # minus the difference of the pressures on both sides
    A[u, V] = np.eye(M)
    A[V, V] = -damping * np.eye(M)
    A[V, u] = -np.eye(M) - force @ (step * (P / gaps)[:, None])
    A[V, Th] = force * (P / Theta)
    A[Th, V] = -2 * (P / apart)[:, None] * step
    A[Th, u] = (energy / gaps)[:, None] * step
    A[Th, Th] = -np.diag(2 * damping + 1.5 * energy / Theta)
    inner_n, inner_Theta, inner_b = (_means(each) for each in (n, Theta, state.strength))
    A[Th, q] = -step[:, 1:-1] * inner_n / apart[:, None]
    across = np.diff(np.eye(M - 1), axis=0)
    A[q, Th] = -3 * (inner_n * inner_Theta / N[1:-1])[:, None] * across
    A[q, q] = -np.diag(3 * damping + inner_b * moments.decay * inner_n * np.sqrt(inner_Theta))
    return A


def _noise(problem: Problem, state: Background) -> Array:
    _, cells, moments, damping = problem
    M, N = cells.rods.size, cells.rods
    n, Theta, b = state.density, state.temperature, state.strength
    energy = dissipation(problem, state)
    u, V, Th, q = parts(M)
    Q = np.zeros((4 * M - 3, 4 * M - 3))
    kept = 2 * damping * of_cells(state.shared) / N
    # Of the contacts that one between cells stands for, the others lie within the two.
    within = 1 - 1 / cells.distances
    between = energy / (2 * N[1:] * N[:-1])
    Q[V, V] = np.diag(_of_cell_means(cells, within * energy) + kept)
    Q[V, V] += np.diag(between, 1) + np.diag(between, -1)
    # Displacements as sums of gaps, the centre of mass at rest.
    sums = np.tril(np.ones((M, M - 1)), -1)
    Q[u, Th] = (sums - N @ sums / N.sum()) * (energy * state.gap)
    Q[Th, u] = Q[u, Th].T
    Q[Th, Th] = np.diag(b * moments.temperature * n * Theta**2.5 / cells.distances)
    velocity_heat = np.diag(_of_cell_means(cells, b * moments.velocity_heat * n * Theta**2.5))
    Q[V, q] = velocity_heat[:, 1:-1]
    Q[q, V] = Q[V, q].T
    Q[q, q] = np.diag(_of_cell_means(cells, b * moments.heat * n * Theta**3.5)[1:-1])
    return Q


def _of_cell_means(cells: Cells, strength: Array) -> Array:
    """Return the noise of cells' means: a contact gives each of its two sides one half."""
    halves = cells.distances * strength / 2
    return np.asarray((np.append(halves, 0.0) + np.append(0.0, halves)) / cells.rods**2)


def parts(M: int) -> tuple[slice, slice, slice, slice]:
    """Return the places of u, V (cells), Theta (contacts) and q (cells but those at the ends)."""
    return (slice(0, M), slice(M, 2 * M), slice(2 * M, 3 * M - 1), slice(3 * M - 1, 4 * M - 3))


def steps(cells: Cells) -> Array:
    """Return the matrix from cells to contacts: the next cell minus this one."""
    return np.diff(np.eye(cells.rods.size), axis=0)


def _mean_gaps(cells: Cells, state: Background) -> Array:
    return cells.distances * state.gap


def _means(at_contacts: Array) -> Array:
    return (at_contacts[1:] + at_contacts[:-1]) / 2


def scales(cells: Cells, state: Background) -> Array:
    """Return the size of every field."""
    gap = np.full(cells.rods.size, _mean_gaps(cells, state).mean())
    inner = _means(state.temperature)
    return np.concatenate(
        [gap, np.sqrt(of_cells(state.temperature)), state.temperature, inner**1.5]
    )


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
