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
per rod, collisions with nothing. Damping takes 2 Gamma Theta out of the local part. What feeds h
is the rest, 2 Gamma (W^2 - Theta), and with the energy of all rods, Gamma sum (W^2 - T) =
sum Lambda/2, and Theta = T - h_c, that is Lambda + 2 Gamma h_c. The centre of mass then has the
variance W^2/L whatever e is. A collision makes the covariance <v_i v_{i+1}> of two rods. So Lambda
stands beside the diagonal: a contact adds half of it to (i, i + 1) and half to (i + 1, i).
"""

import warnings
from collections.abc import Iterator
from typing import NamedTuple, Self

import numpy as np
from scipy.linalg import block_diag, eigvals, solve_continuous_lyapunov

from crazybilliards.kinetic.gas.cells import Cells, means
from crazybilliards.kinetic.gas.mean_state import Medium, NoSteadyStateError
from crazybilliards.model import Array


class Background(NamedTuple):
    """The steady state that pairs fluctuate about, at all K contacts; ``stiffness`` at cells."""

    medium: Medium
    cells: Cells
    density: Array  # n, rods per length where they collide
    gap: Array  # g, the mean gap of two rods
    temperature: Array  # Theta
    pressure: Array  # P
    strength: Array  # b, 0 at walls
    shared: Array  # h_c, the covariance of neighbours' velocities
    collective: Array  # K h_uu, the variance of the velocities of neighbourhoods
    stiffness: Array  # K, (M,)

    @property
    def loss(self) -> Array:
        """Lambda."""
        energy = self.medium.moments.energy
        return np.asarray(self.strength * energy * self.density * self.temperature**1.5)

    @property
    def mean_gaps(self) -> Array:
        """Distances of neighbouring cells, and of the outermost ones from walls."""
        return self.cells.all_distances * self.gap

    @property
    def parts(self) -> tuple[slice, slice, slice, slice]:
        """Places of u, V (cells), Theta (contacts) and q (cells but those at open ends)."""
        M, K = self.cells.rods.size, self.gap.size
        Th = slice(2 * M, 2 * M + K)
        return slice(0, M), slice(M, 2 * M), Th, slice(Th.stop, Th.stop + K - 1)

    @property
    def steps(self) -> Array:
        """The matrix from cells to contacts: the next cell minus this one, a wall being 0."""
        whole = np.eye(self.cells.rods.size)
        return np.diff(np.pad(whole, ((1, 1), (0, 0))) if self.cells.walled else whole, axis=0)

    @property
    def with_flux(self) -> slice:
        """Which cells have a heat flux of their own: all but the last at open ends."""
        return slice(None) if self.cells.walled else slice(1, -1)

    def on(self, cells: Cells) -> Self:
        """Return the state on other cells."""
        old, new = self.cells.all_labels, cells.all_labels
        fields = {name: np.interp(new, old, getattr(self, name)) for name in self._fields[2:-1]}
        stiffness = np.interp(cells.centres, self.cells.centres, self.stiffness)
        return self._replace(cells=cells, **fields, stiffness=stiffness)


class PairCovariance(NamedTuple):
    """Stationary covariances h between M cells or M - 1 contacts."""

    cells: Cells
    velocity: Array  # of cells
    displacement: Array  # of cells
    gap: Array  # of contacts, relative to the mean gaps
    gap_temperature: Array  # of contacts, relative to both means
    temperature: Array  # of contacts, relative to the means


class LinearResponse(NamedTuple):
    """M and Q for a chain."""

    generator: Array
    noise: Array
    scale: Array  # the size of every unknown, which keeps the equations well conditioned
    fields: tuple[tuple[int, int], ...]  # number of unknowns, sign in the mirror image

    def halves(self) -> Iterator[tuple[Array, Array, Array]]:
        """Return scaled M and Q in the even and the odd half, and the basis of the half."""
        for parity in (1, -1):
            basis = block_diag(*(_mirror_basis(size, parity * sign) for size, sign in self.fields))
            to, back = basis / self.scale[:, None], basis * self.scale[:, None]
            yield to.T @ self.generator @ back, to.T @ self.noise @ to, back

    def stationary(self) -> Array:
        """Return h."""
        h = np.zeros_like(self.noise)
        for generator, noise, basis in self.halves():
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
        return max(float(eigvals(generator).real.max()) for generator, *_ in self.halves())


def covariances(state: Background, response: LinearResponse) -> PairCovariance:
    """Return what is stationary, of a response that may have more fields."""
    h, inner, (u, V, Th, _) = response.stationary(), state.cells.inner, state.parts
    relative = (state.steps / state.mean_gaps[:, None])[inner]
    Theta = state.temperature[inner]
    return PairCovariance(
        state.cells,
        velocity=h[V, V],
        displacement=h[u, u],
        gap=relative @ h[u, u] @ relative.T,
        gap_temperature=relative @ h[u, Th][:, inner] / Theta,
        temperature=h[Th, Th][inner, inner] / np.outer(Theta, Theta),
    )


def linear_response(state: Background) -> LinearResponse:
    """Return M and Q."""
    M, Theta, (_, _, Th, q) = state.cells.rods.size, state.temperature, state.parts
    sizes = state.mean_gaps.mean(), np.sqrt(Theta.mean())
    scale = np.concatenate([np.repeat(sizes, M), Theta, means(Theta) ** 1.5])
    # u, V and q change sign in the mirror.
    fields = (M, -1), (M, -1), (Th.stop - Th.start, 1), (q.stop - q.start, -1)
    return LinearResponse(_generator(state), _noise(state), scale, fields)


def _generator(state: Background) -> Array:
    medium, cells = state.medium, state.cells
    apart, step, some = cells.all_distances, state.steps, state.with_flux
    Theta, P, gaps, loss = state.temperature, state.pressure, state.mean_gaps, state.loss
    u, V, Th, q = state.parts
    A = np.zeros((q.stop, q.stop))
    force = step.T / cells.rods[:, None]  # minus the difference of the pressures on both sides
    A[u, V] = np.eye(cells.rods.size)
    A[V, V] = -medium.damping * np.eye(cells.rods.size)
    A[V, u] = -np.diag(state.stiffness) - force @ (step * (P / gaps)[:, None])
    A[V, Th] = force * (P / Theta)
    A[Th, V] = -2 * (P / apart)[:, None] * step
    A[Th, u] = (loss / gaps)[:, None] * step
    A[Th, Th] = -np.diag(2 * medium.damping + 1.5 * loss / Theta)
    n, Theta, b = (means(values) for values in (state.density, Theta, state.strength))
    A[Th, q] = -step[:, some] * n / apart[:, None]
    A[q, Th] = -3 * (n * Theta / cells.rods[some])[:, None] * np.diff(np.eye(apart.size), axis=0)
    A[q, q] = -np.diag(3 * medium.damping + b * medium.moments.decay * n * np.sqrt(Theta))
    return A


def _noise(state: Background) -> Array:
    cells, moments, some = state.cells, state.medium.moments, state.with_flux
    N, inner, loss, Theta = cells.rods, cells.inner, state.loss, state.temperature
    collisions = state.strength * state.density
    u, V, Th, q = state.parts
    Q = np.zeros((q.stop, q.stop))
    shared = means(state.shared if cells.walled else np.pad(state.shared, 1, mode="edge"))
    # Of the contacts that one between cells stands for, the others lie within the two.
    within = _of_cell_means(cells, (1 - 1 / cells.distances) * loss[inner])
    between = loss[inner] / (2 * N[1:] * N[:-1])
    Q[V, V] = np.diag(within + 2 * state.medium.damping * shared / N)
    Q[V, V] += np.diag(between, 1) + np.diag(between, -1)
    Q[u, Th] = _displacements(state) * (loss * state.gap)
    Q[Th, u] = Q[u, Th].T
    Q[Th, Th] = np.diag(moments.temperature * collisions * Theta**2.5 / cells.all_distances)
    of_flux = _of_cell_means(cells, (moments.velocity_heat * collisions * Theta**2.5)[inner])
    Q[V, q] = np.diag(of_flux)[:, some]
    Q[q, V] = Q[V, q].T
    of_flux = _of_cell_means(cells, (moments.heat * collisions * Theta**3.5)[inner])
    Q[q, q] = np.diag(of_flux[some])
    return Q


def _displacements(state: Background) -> Array:
    """Return the displacements of cells, (M, K), for a unit that each gap is longer."""
    if state.cells.walled:  # the other gaps give way evenly
        return np.asarray(np.linalg.pinv(state.steps))
    N = state.cells.rods
    sums = np.tril(np.ones((N.size, N.size - 1)), -1)  # the centre of mass stays at rest
    return np.asarray(sums - N @ sums / N.sum())


def _of_cell_means(cells: Cells, strength: Array) -> Array:
    """Return the noise of cells' means: a contact gives each of its two sides one half."""
    return np.asarray(means(np.pad(cells.distances * strength, 1)) / cells.rods**2)


def _mirror_basis(size: int, sign: int) -> Array:
    """Return the orthonormal basis of vectors whose mirror image is ``sign`` times themselves."""
    half, whole = size // 2, np.eye(size)
    basis = ((whole + sign * whole[::-1]) * np.sqrt(0.5))[:, : size - half if sign == 1 else half]
    basis[half, half:] = 1.0  # the middle one of an odd number
    return np.asarray(basis)
