r"""How much stronger the kicks of closed contacts must be: the constant of ``closed_contacts.py``.

    python -m studies.closed_contact [--millions 40]

The relative motion of two rods with e = 0: a position x >= 0 and a velocity u, a kick of variance 1
a step, then x + u; a rod that would end below 0 is at rest at 0. The continuous counterpart is the
randomly accelerated particle, dx = u dt, du = dW, that sticks at 0. A cycle, from closing to
closing, takes a time with infinite mean, tail C t^(-1/4). Its renormalised mean,

    g(x, u) = lim [ E min(t, T) - (4/3) C(x, u) T^(3/4) ],    T -> infinity,

solves u dg/dx + (1/2) d^2g/du^2 = -1 with g(0, u < 0) = 0, and scales like u^2. So

    g = -u^2 + x^(2/3) F(u/x^(1/3)),    F(y) = -(1/2) (9/2)^(2/3) U(-2/3, 2/3, 2 y^3/9),

U being Tricomi's function (real for y < 0 as well). It is the solution that does not grow
exponentially for u > 0, and F(y) ~ y^2 for y -> -infinity satisfies the boundary condition.

The cycle of the discrete walk has D = E[k] in the same sense: k steps if it has ended within n
steps, else n + g at the place reached. There g is averaged over half a kick, which makes kick and
flight symmetric in time, and half a step is added, since a walk that meets the wall within a step
ends with the step. What is left is small in 1/n: compare the rows. The continuous cycle from (0, 0)
has D = 0. The kick that opens the contact is made stronger until the walk has D = 0 as well.
"""

import numpy as np
from scipy.special import gamma, hyp1f1, hyperu

from crazybilliards.reproduction.claims.study import error_of_mean
from studies.common import Table, options, print_table

STRENGTHS = np.array([1.0, 1.15, 1.2, 1.25, 1.3])
STEPS = (8, 16, 32)
BATCH = 100_000
_Y = np.linspace(-8, 8, 8001)  # beyond, F(y) is y^2 - 1/y and -y^2/2 - 1/(2 y)


def similarity(y: np.ndarray) -> np.ndarray:
    """F(y), see above."""
    z = 2 * y**3 / 9
    ahead = hyperu(-2 / 3, 2 / 3, np.maximum(z, 0))
    behind = gamma(1 / 3) / gamma(-1 / 3) * hyp1f1(-2 / 3, 2 / 3, np.minimum(z, 0))
    behind += gamma(-1 / 3) / gamma(-2 / 3) * np.cbrt(np.minimum(z, 0)) * hyp1f1(-1 / 3, 4 / 3, z)
    return -0.5 * 4.5 ** (2 / 3) * np.where(z >= 0, ahead, behind)


_F = similarity(_Y)
_SECOND = np.gradient(np.gradient(_F, _Y), _Y)


def remaining(x: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Renormalised mean of the steps left at x > 0, before a kick: g + g_uu/4 + 1/2."""
    y = u / np.cbrt(x)
    far = np.where(y > 0, -(y**2) / 2 - 0.5 / y, y**2 - 1 / y)
    shape = np.where(np.abs(y) < _Y[-1], np.interp(y, _Y, _F), far)
    second = np.interp(y, _Y[2:-2], _SECOND[2:-2])
    return np.cbrt(x) ** 2 * shape - u**2 + (second - 2) / 4 + 0.5


def delay(strength: float, kicks: np.ndarray) -> float:
    """D of walks with these kicks, shape (steps, walks), the first ``strength`` times as strong."""
    x, u = np.zeros((2, kicks.shape[1]))
    total = 0.0
    for k, kick in enumerate(kicks):
        u = u + (strength * kick[: u.size] if k == 0 else kick[: u.size])
        x = x + u
        total += x.size  # one more step for each that was under way
        x, u = x[x > 0], u[x > 0]
    return (total + remaining(x, u).sum()) / kicks.shape[1]


def table(batches: int) -> Table:
    yield "steps n", "D without correction", "strength where D = 0"
    for steps in STEPS:
        generator = np.random.default_rng(steps)
        found = np.empty((batches, STRENGTHS.size))
        for batch in found:
            kicks = generator.standard_normal((steps, BATCH))
            batch[:] = [delay(strength, kicks) for strength in STRENGTHS]
        # The root of the mean curve; its error from roots of eight parts.
        roots = []
        for part in (found, *np.array_split(found, 8)):
            curve = np.polyfit(STRENGTHS[1:], part.mean(axis=0)[1:], 2)
            roots.append(min(np.roots(curve).real, key=lambda root: abs(root - 1.2)))
        delays, strength = found[:, 0], f"{roots[0]:.4f} ± {error_of_mean(roots[1:]):.4f}"
        yield steps, f"{delays.mean():.4f} ± {error_of_mean(delays):.4f}", strength


if __name__ == "__main__":
    print_table(table(round(options(__doc__, millions=40.0).millions * 1e6 / BATCH)))
