r"""Chains with e > 1 on linear springs: the density of points in phase space.

Collisions make the fast faster. Velocities then have heavy tails, and fast rods reach the ends of
the chain, which a closure of moments does not know. The density f(y, v) of relabelled points does.
Points pass through each other, and each of the two loses the share lambda = (1 - e)/2 of their
relative velocity. If points that meet are independent, f obeys to first order in lambda

    v f_y - y f_v = Gamma d_v (v f + tau f_v) + kappa d_v (f I),

    I(y, v) = int |v - u| (v - u) f(y, u) du,      int f = 1,      kappa = -L ln(1 - lambda).

For uniform granular media such a drag is that of D. Benedetto, E. Caglioti and M. Pulvirenti (RAIRO
Modél. Math. Anal. Numér. 31, 615, 1997). A point that meets L slow ones has its velocity multiplied
by (1 - lambda)^L, as by the drag with this kappa. To first order that is lambda L, with which 10
rods are too hot beside simulations. The noise of random encounters is left out: a fast point meets
each other point exactly once on its way through the cloud.

**Units.** Velocities are in units of their own rms value S, as a multiple of the free W, and
lengths in units of S s. The drag does not depend on the units, and the noise has the factor
tau = 1/S^2. So tau is an unknown beside f, and the condition that belongs to it is <v^2> = 1. At
e = 1 f is a Gaussian and tau is 1. At the critical size tau is 0. With weak damping f remains a
Gaussian, and tau = 1 - kappa/kappa_c with kappa_c = -(pi/2) Gamma, where Newton's method starts.

**Grid.** Sinc functions on y and v = sinh(a X), with X on an even grid. The errors of derivatives,
sums and running integrals fall exponentially with the number of points (F. Stenger, Numerical
Methods Based on Sinc and Analytic Functions, Springer 1993). f is the same at (-y, -v), so that
only y > 0 is solved for. The stretch a and the reach of v grow with Gamma, as the tails do. W_v is
within 0.1 % of that on finer grids for Gamma <= 2 up to 0.85 of the critical size, and within 0.3 %
for Gamma = 3, 0.9 % at the first of 300 rods.
"""

import math
from typing import NamedTuple, Self

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import solve
from scipy.special import ndtri, sici

from crazybilliards.kinetic.gas.mean_state import NoSteadyStateError
from crazybilliards.model import Array, Chain

_PLACES, _VELOCITIES = 24, 28  # points of half an axis
_HEAVIEST = 3.0  # Gamma, from which on the grid is the same
_MOST_STEPS, _SAME = 12, 1e-7  # the last step, relative to max f
_RAN_AWAY = 3.0  # a step relative to max f
_NEGATIVE = 1e-3  # f relative to its maximum
_FEWEST = 1e-6  # share of the points beyond the farthest place that is read


class DrivenPoints(NamedTuple):
    """Fields of the points at ascending places, in units of s and W."""

    score: Array  # normal score of the share of the points below
    temperature: Array  # <v^2>
    flux: Array  # int f v^3 dv, of one point
    residual: float  # points that the grid makes per time, over Gamma

    def at(self, score: Array) -> tuple[Array, Array]:
        """Return temperature and flux at normal scores, constant beyond the farthest place."""
        inside = np.clip(score, self.score[0], self.score[-1])
        fields = self.temperature, self.flux
        temperature, flux = (CubicSpline(self.score, field)(inside) for field in fields)
        return temperature, flux


class _Axis(NamedTuple):
    """Points, symmetric about 0, with weights and matrices of sums and derivatives."""

    points: Array
    weights: Array
    below: Array  # the integral from the left end to each point
    slope: Array
    curvature: Array

    @classmethod
    def of(cls, half: int, reach: float, stretch: float) -> Self:
        """Make an axis of twice ``half`` points, the last ones near ``reach``."""
        h = 1 / half
        X = h * (np.arange(2 * half) - half + 0.5)
        x = reach * np.sinh(stretch * X) / math.sinh(stretch)
        dx = reach * stretch * np.cosh(stretch * X) / math.sinh(stretch)
        k = np.subtract.outer(np.arange(2 * half), np.arange(2 * half))
        sign, other = np.where(k % 2, -1.0, 1.0), np.where(k == 0, 1, k)
        first = np.where(k == 0, 0.0, sign / other) / h
        second = np.where(k == 0, -(math.pi**2) / 3, -2 * sign / other**2) / h**2
        bent = stretch**2 * x / dx**3
        return cls(
            points=x,
            weights=h * dx,
            below=(0.5 + sici(math.pi * k)[0] / math.pi) * h * dx,
            slope=first / dx[:, None],
            curvature=second / dx[:, None] ** 2 - bent[:, None] * first,
        )


class _Equation:
    """The equation on a grid of y > 0 and all v; f has the shape (places, velocities)."""

    def __init__(self, damping: float, drag: float) -> None:
        tails = min(damping, _HEAVIEST)
        self.y = y = _Axis.of(_PLACES, 9 + tails / 2, 2 + tails / 2)
        self.v = v = _Axis.of(_VELOCITIES, 9 + 3 * tails, 2 + tails / 2)
        self.damping, self.drag = damping, drag
        places = y.points[_PLACES:]
        self.gaussian = np.exp(-np.add.outer(places**2, v.points**2) / 2) / (2 * math.pi)
        self.number = np.outer(2 * y.weights[_PLACES:], v.weights)
        self.energy = self.number * v.points**2
        # At -y lies what is at y with the opposite velocity.
        right, left = y.slope[_PLACES:, _PLACES:], y.slope[_PLACES:, _PLACES - 1 :: -1]
        moved = np.kron(right, np.diag(v.points)) + np.kron(left, np.diag(v.points)[:, ::-1])
        pulled = np.kron(np.diag(places), v.slope)
        self.fixed = moved - pulled - damping * np.kron(np.eye(_PLACES), v.slope * v.points)
        apart = np.subtract.outer(v.points, v.points)
        self.kernel = np.abs(apart) * apart * v.weights

    def newton_step(self, f: Array, tau: float, made: float) -> tuple[Array, float, float]:
        """Return the changes of f, of tau, and of the points made.

        The grid loses or makes a few points. One equation follows from the others, and the strength
        of a source in the shape of the Gaussian is the unknown in its place.
        """
        v, cells = self.v, f.size
        push = f @ self.kernel.T
        noise = self.damping * (f @ v.curvature.T)
        collisions = self.drag * ((f * push) @ v.slope.T)
        transport = (self.fixed @ f.ravel()).reshape(f.shape)
        off = transport - tau * noise - collisions - made * self.gaussian
        A = np.zeros((cells + 2, cells + 2))
        A[:cells, :cells] = self.fixed
        for i in range(_PLACES):
            own = slice(i * v.points.size, (i + 1) * v.points.size)
            change = np.diag(push[i]) + f[i][:, None] * self.kernel
            A[own, own] -= tau * self.damping * v.curvature + self.drag * (v.slope @ change)
        A[:cells, cells], A[:cells, cells + 1] = -noise.ravel(), -self.gaussian.ravel()
        A[cells, :cells], A[cells + 1, :cells] = self.number.ravel(), self.energy.ravel()
        missing = [1 - (self.number * f).sum(), 1 - (self.energy * f).sum()]
        step = solve(A, np.append(-off.ravel(), missing), overwrite_a=True, check_finite=False)
        return step[:cells].reshape(f.shape), float(step[cells]), float(step[cells + 1])

    def points(self, f: Array, tau: float, made: float) -> DrivenPoints:
        """Return the fields of f in the units of a free rod."""
        n, energy, flux = (f @ (self.v.weights * self.v.points**k) for k in (0, 2, 3))
        # n is even in y: the points below -y are as many as those beyond y.
        beyond = (self.y.below @ np.append(n[::-1], n))[_PLACES - 1 :: -1]
        good = (n > 0) & (energy > 0) & (np.diff(beyond, prepend=0.5) < 0) & (beyond > _FEWEST)
        read = slice(None if good.all() else int(np.argmin(good)))
        score, T, flux = -ndtri(beyond[read]), (energy[read] / n[read]) / tau, flux[read] / tau
        return DrivenPoints(
            np.append(-score[::-1], score),
            np.append(T[::-1], T),
            np.append(-flux[::-1], flux),
            abs(made) / self.damping,
        )


def driven_points(chain: Chain) -> DrivenPoints:
    """Solve for the points, or raise NoSteadyStateError if the grid resolves no steady state."""
    damping, e = chain.relative_damping, chain.restitution
    share = (e - 1) * chain.size / (math.pi * damping)
    if share >= 1:
        raise NoSteadyStateError(
            f"collisions give more than damping takes: its size is {share:.3g} of the critical one"
        )
    equation = _Equation(damping, -chain.size * math.log((1 + e) / 2))
    f, tau, made = equation.gaussian, 1 - share, 0.0
    for _ in range(_MOST_STEPS):
        change, more_noise, more_made = equation.newton_step(f, tau, made)
        f, tau, made = f + change, tau + more_noise, made + more_made
        size = np.abs(change).max() / f.max()
        if size < _SAME and tau > 0 and f.min() > -_NEGATIVE * f.max():
            return equation.points(f, tau, made)
        if not size < _RAN_AWAY:
            break
    raise NoSteadyStateError(
        f"with gamma/sqrt(k m) = {damping:.3g} and {share:.3g} of the critical size the tails of "
        "its velocities are too heavy for the grid, which resolves those up to 3 and 0.85"
    )
