"""Contacts that are closed after a drift, and a correction of the noise that opens them.

At e = 0 two rods that have met stay in contact until a kick of the noise separates them, with one
kick per step longer than in the limit dt -> 0. The excess vanishes if the relative kick of a closed
contact is ``CLOSED_KICK`` times as strong (``studies/closed_contact.py``). Only deviations from the
mean kick of a cluster grow, which keeps the momentum. docs/particles.md has the sources, the
measured errors, and why the factor is taken up to the critical restitution.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.kernels import kernel

CLOSED_KICK = 1.224
CRITICAL_RESTITUTION = math.exp(-math.pi / math.sqrt(3))  # 0.163


class Clusters(NamedTuple):
    """Groups of two or more rods in contact: rods ``firsts`` to ``lasts`` - 1."""

    firsts: NDArray[np.int64]
    lasts: NDArray[np.int64]
    number: NDArray[np.int64]  # of the clusters, (1,)


def make_clusters(size: int) -> Clusters:
    """Return arrays for the clusters of ``size`` rods."""
    firsts, lasts = np.zeros((2, size), dtype=np.int64)
    return Clusters(firsts, lasts, np.zeros(1, dtype=np.int64))


@kernel
def find_clusters(y, clusters, low=-np.inf, high=np.inf):  # type: ignore[no-untyped-def]
    """Record the rods in contact with each other or a wall: those exactly at one coordinate."""
    number, first = 0, 0
    for i in range(1, y.size + 1):
        if i == y.size or y[i] != y[first]:
            if i - first > 1 or y[first] == low or y[first] == high:
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
