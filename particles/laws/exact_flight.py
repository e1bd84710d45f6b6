r"""Elastic rods on linear springs with one common anchor: their exact motion over any time.

Elastic rods move as if they passed through each other and swapped names (``sort.py``). On equal
springs they are then independent oscillators, and sorting them by their positions gives the chain,
exactly, however often they have met. For a linear spring the position and the velocity after a time
t are jointly normal,

    (y, v)(t) = E (y, v)(0) + noise of covariance Sigma,
    E = exp(B t),   B = [[0, 1], [-k/m, -gamma/m]],
    Sigma = int_0^t exp(B s) diag(0, A^2/m^2) exp(B' s) ds,

so a step of any length has no error but rounding: with strong damping 1e-16 gamma^2/km, and of the
phase of a swing 1e-16 of the turns in a step. The same holds for a single rod at any e, and for
elastic rods without springs.

E and Sigma of a short time come from one exponential of a matrix (C. F. Van Loan, IEEE Trans.
Autom. Control 23, 395, 1978). They are doubled from there, Sigma <- Sigma + E Sigma E', E <- E E,
so that no damping, and no stiffness, is a special case. Squares would let rods that swing n times
in a step gain or lose 1e-16 n of their energy, so E of rods that swing comes from cos(w t).
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from crazybilliards.model import Array, Chain
from crazybilliards.model.kernels import kernel


class Propagator(NamedTuple):
    """E and the triangular root of Sigma for one step, as plain numbers."""

    y_from_y: float
    y_from_v: float  # [t_0]
    v_from_y: float  # [1/t_0]
    v_from_v: float
    noise: float  # standard deviation of v [R/t_0]
    shared_noise: float  # the part of y that follows the noise of v [R]
    own_noise: float  # the part of y that does not [R]


def independent_rods(chain: Chain) -> bool:
    """Return whether the rods are independent linear oscillators that swap names."""
    alike = chain.restitution == 1 and (chain.gap == 0 or chain.stiffness == 0)
    return chain.spring == "linear" and (alike or chain.size == 1)


def make_propagator(chain: Chain, duration: float) -> Propagator:
    """Return the numbers of a step of this duration [t_0]."""
    square, damping = chain.stiffness / chain.mass, chain.damping / chain.mass
    turns = duration * max(math.sqrt(square), damping)
    doublings = max(math.ceil(math.log2(turns)), 0) if turns > 0 else 0
    # With h as the unit of time all entries are pure numbers of order 1.
    h = duration / 2**doublings
    b = np.array([[0.0, 1.0], [-square * h**2, -damping * h]])
    rate = square * h**2 - (damping * h / 2) ** 2  # of a swing, squared
    heat = np.diag([0.0, 1.0])
    both = expm(np.block([[-b, heat], [np.zeros((2, 2)), b.T]]))
    e = both[2:, 2:].T
    sigma = e @ both[:2, 2:]
    for doubled in range(doublings):
        sigma = sigma + e @ sigma @ e.T
        e = e @ e if rate <= 0 else _swing(b, math.sqrt(rate), 2.0 ** (doubled + 1))
    kick = chain.amplitude / chain.mass * math.sqrt(h)
    root = math.sqrt(sigma[1, 1])
    shared = sigma[0, 1] / root
    own = math.sqrt(max(sigma[0, 0] - shared**2, 0.0))
    (yy, yv), (vy, vv) = e.tolist()
    return Propagator(yy, yv * h, vy / h, vv, kick * root, kick * h * float(shared), kick * h * own)


def _swing(b: Array, w: float, time: float) -> Array:
    """Return exp(B t) of a damped oscillator of the frequency w."""
    half = b[1, 1] / 2
    swing = math.cos(w * time) * np.eye(2) + math.sin(w * time) / w * (b - half * np.eye(2))
    return np.asarray(math.exp(half * time) * swing)


@kernel
def propagate(y, v, kicks, step):  # type: ignore[no-untyped-def]
    """Move every rod as if it were alone; ``kicks``: normal numbers, shape (2 L,)."""
    n = y.size
    first, second = kicks[:n], kicks[n:]
    for i in range(n):
        y_i, v_i = y[i], v[i]
        noise = step.shared_noise * first[i] + step.own_noise * second[i]
        y[i] = step.y_from_y * y_i + step.y_from_v * v_i + noise
        v[i] = step.v_from_y * y_i + step.v_from_v * v_i + step.noise * first[i]
