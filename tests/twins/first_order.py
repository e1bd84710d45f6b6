r"""Pair correlations of point rods on linear springs to first order in 1 - e, exactly.

At e = 1 rods that exchange their names at collisions are independent, and each obeys the Kramers
equation of an oscillator, d_t f = A f. To first order in 1 - e the correlation G of two of them is
what collisions make of independent ones,

    A_1 G + A_2 G + S = 0,      S = delta(y_1 - y_2) |v_1 - v_2| ( (f f)* - f f ),

f being the Gaussian of equilibrium and * the velocities after a collision. In normalised Hermite
functions of y and of v, A is a rotation among those of one total order, with damping, and S is an
integral over y times one over v. The result has no error but rounding: no field, no closure and no
lattice. In units of the free rod, for many rods.
"""

import math

import numpy as np
from numpy.polynomial.hermite_e import hermegauss, hermeval
from scipy.linalg import solve_continuous_lyapunov


def hermite(order, x):
    """Return a Hermite polynomial, normalised: its mean square over a Gaussian is 1."""
    return hermeval(x, [0] * order + [1]) / math.sqrt(math.factorial(order))


def mode_variances(restitution, damping, number):
    """Return those of displacement, velocity and temperature, shape (3, number).

    A field at the place y is sum_n c_n hermite(n, y), and these are the <c_n^2> of what rods have
    in common. A place moves by what is missing of the rods below it, over their density.
    """
    modes = [(n, total - n) for total in range(1, number + 3) for n in range(total, -1, -1)]
    at = {mode: index for index, mode in enumerate(modes)}
    found = solve_continuous_lyapunov(_kramers(at, damping), -_source(modes, restitution))
    variance = {mode: found[index, index] for mode, index in at.items()}
    return np.array(
        [
            [variance[n + 1, 0] / (n + 1) for n in range(number)],
            [variance[n, 1] for n in range(number)],
            [2 * variance[n, 2] for n in range(number)],
        ]
    )


def displacement_source(restitution, number):
    """Return what collisions make between displacement and temperature, shape (number, number)."""
    modes = [(n + 1, 0) for n in range(number)] + [(n, 2) for n in range(number)]
    made = _source(modes, restitution)[:number, number:]
    return made * math.sqrt(2) / np.sqrt(np.arange(1, number + 1))[:, None]


def _kramers(at, damping):
    """d_t f = -v d_y f + y d_v f + friction and noise, between the orders (n, m) of y and v."""
    A = np.zeros((len(at), len(at)))
    for (n, m), i in at.items():
        A[i, i] = -damping * m
        if m:
            A[at[n + 1, m - 1], i] = math.sqrt((n + 1) * m)
        if n:
            A[at[n - 1, m + 1], i] = -math.sqrt(n * (m + 1))
    return A


def _source(modes, restitution):
    n, m = np.array(modes).T
    x, weights = hermegauss(40)
    # The density squared is a Gaussian of half the variance, with the integral 1/(2 sqrt(pi)).
    there = np.array([hermite(order, x / math.sqrt(2)) for order in range(n.max() + 1)])
    overlap = (there * weights) @ there.T / math.sqrt(2 * math.pi) / (2 * math.sqrt(math.pi))
    return overlap[np.ix_(n, n)] * _made_by_a_collision(m.max() + 1, restitution)[np.ix_(m, m)]


def _made_by_a_collision(orders, restitution):
    """Return <|v - u| (psi(v*) phi(u*) - psi(v) phi(u))> over Gaussians, between orders."""
    t, t_weights = np.polynomial.laguerre.laggauss(40)  # R exp(-R^2/2) dR = exp(-t) dt
    S, S_weights = hermegauss(40)
    R = np.concatenate([np.sqrt(2 * t), -np.sqrt(2 * t)])  # (v - u)/sqrt(2)
    weights = np.outer(S_weights, np.tile(t_weights, 2)) / (math.pi * math.sqrt(2))
    v, u = (S[:, None] + R) / math.sqrt(2), (S[:, None] - R) / math.sqrt(2)
    share = (1 - restitution) / 2
    before = np.array([[hermite(k, each) for k in range(orders)] for each in (v, u)])
    after = v - share * (v - u), u + share * (v - u)
    after = np.array([[hermite(k, each) for k in range(orders)] for each in after])
    return np.einsum("st,jst,kst->jk", weights, *after) - np.einsum(
        "st,jst,kst->jk", weights, *before
    )
