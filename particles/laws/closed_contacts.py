r"""Contacts that a drift has left closed: which they are, and the noise that opens them again.

At e = 0 two rods that have met stay in contact until a kick of the noise separates them. The
continuous chain leaves a closed contact at once: its relative motion is that of a randomly
accelerated particle at a wall where it sticks (McKean, J. Math. Kyoto Univ. 2, 227, 1963; Bertoin,
Ann. Probab. 35, 2021, 2007). With a kick a step it lingers. In units of steps the times between
successive closings have the tail P(>n) ~ C n^(-1/4), and

    D = lim [ sum_(k <= n) P(>k) - (4/3) C n^(3/4) ]

is how much longer each takes than in the continuous chain. There are ~ dt^(-1/4) of them per
time, so this delay costs the velocity widths ~ dt^(3/4). It vanishes if the relative kick of a
closed contact is ``CLOSED_KICK`` times as strong. The number follows from a single contact and
holds for every chain at e = 0; ``benchmarks/closed_contact.py`` computes it.

The same factor is taken up to the critical restitution exp(-pi/sqrt 3) = 0.163 (Cornell, Swift and
Bray, Phys. Rev. Lett. 81, 1142, 1998), below which a contact still collapses onto the wall. There
D(e) vanishes only for much stronger kicks, but this limit of small steps is far away: in chains at
e = 0.1 and practical steps the factor of e = 0 takes most of the error out, and a stronger one adds
more than it takes. Above, contacts do not collapse, and no factor helps.

The deviations of the kicks from the mean of their cluster are made stronger, which leaves the
momentum alone. A kick split into two halves by a snapshot has the same law as a whole one if its
second half is made stronger by ``second_half``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.kernels import kernel

CLOSED_KICK = 1.224
CRITICAL_RESTITUTION = math.exp(-math.pi / math.sqrt(3))  # 0.163


class Clusters(NamedTuple):
    """Runs of two and more rods in contact: rods ``firsts`` to ``lasts`` - 1."""

    firsts: NDArray[np.int64]
    lasts: NDArray[np.int64]
    number: NDArray[np.int64]  # of the clusters, (1,)


def make_clusters(size: int) -> Clusters:
    """Return room for the clusters of ``size`` rods."""
    firsts, lasts = np.zeros((2, size), dtype=np.int64)
    return Clusters(firsts, lasts, np.zeros(1, dtype=np.int64))


def second_half(strength: float, decay: float) -> float:
    """Strength of a half kick so that both halves make a whole one of ``strength``.

    The velocity decays by ``decay`` with every half. Its noise has the variances c^2 h^2 + h^2 of
    two halves; strength^2 times that is shared out as c^2 h^2, the first half as it is, and the
    rest.
    """
    return math.sqrt(strength**2 + decay**2 * (strength**2 - 1))


@kernel
def find_clusters(y, clusters):  # type: ignore[no-untyped-def]
    """Take down the rods in contact: those at the same reduced coordinate, to the bit."""
    number, first = 0, 0
    for i in range(1, y.size + 1):
        if i == y.size or y[i] != y[first]:
            if i - first > 1:
                clusters.firsts[number], clusters.lasts[number] = first, i
                number += 1
            first = i
    clusters.number[0] = number


@kernel
def strengthen(kicks, clusters, strength):  # type: ignore[no-untyped-def]
    """Multiply the deviations of the kicks from their clusters' means by ``strength``."""
    for k in range(clusters.number[0]):
        first, last = np.uint64(clusters.firsts[k]), np.uint64(clusters.lasts[k])
        second = first + np.uint64(1)
        if last - first == np.uint64(2):
            half = 0.5 * (strength - 1) * (kicks[second] - kicks[first])
            kicks[first] -= half
            kicks[second] += half
            continue
        total = 0.0
        for i in range(first, last):
            total += kicks[i]
        mean = total / float(last - first)
        for i in range(first, last):
            kicks[i] = mean + strength * (kicks[i] - mean)
