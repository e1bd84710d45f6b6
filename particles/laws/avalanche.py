"""Avalanches: waves of momentum that run along the chain from collision to collision.

A wave has an origin, the rod i that hit its right neighbour, and a front, which is i + 1 at first.
docs/physics/avalanches.md has the rules of the two counts: **triggered**, the paper's, with
N_c = front - origin - 1, and **pushes**, in which a push runs through a cluster to its far end.

Waves with the same front share their future. They are kept in a linked list that moves as a whole.
Each collision starts at most one wave, and each wave ends once, so one costs O(1) on average:

    collision of c and c+1    rightward: waves on c+1 end, those on c move to c+1, one starts at c
                              otherwise: waves on c and on c+1 end
                                         (triggered: and one starts at c)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.kernels import inlined, kernel
from crazybilliards.particles.laws.impacts import Speeds, make_impacts

Integers = NDArray[np.int64]


class Waves(NamedTuple):
    """Running waves and the sizes of ended ones. Arrays of length 0: waves are not counted."""

    heads: Integers  # first wave of each front, -1 without any, (L,)
    following: Integers  # next wave with the same front, or next unused place, -1 at the end
    origins: Integers  # of each wave
    unused: Integers  # first unused place, (1,)
    sizes: Integers  # waves ended, by origin and by front - origin - 1, (L, L)


class Tally(NamedTuple):
    """The record of single collisions. Arrays of length 0: there is no record."""

    contacts: Integers  # collisions at each contact, (L - 1,)
    pushes: Waves
    triggered: Waves
    impacts: NDArray[np.float64]  # see ``impacts.py``, (4, L - 1)
    speeds: Speeds
    struck: NDArray[np.float64]  # momentum on and collisions with each wall, (2, 2)


def make_waves(size: int) -> Waves:
    """Return empty waves for ``size`` rods (16 L^2 bytes); size 0: waves are not counted."""
    # A front p has at most one wave of each origin below it.
    places = size * (size - 1) // 2
    following = np.arange(1, places + 1, dtype=np.int64)
    following[-1:] = -1
    return Waves(
        np.full(size, -1, dtype=np.int64),
        following,
        np.zeros(places, dtype=np.int64),
        np.zeros(1, dtype=np.int64),
        np.zeros((size, size), dtype=np.int64),
    )


def make_tally(size: int, *, contacts: bool) -> Tally:
    """Return an empty tally for ``size`` rods, without waves and impacts."""
    counted = np.zeros(max(size - 1, 0) if contacts else 0, dtype=np.int64)
    speeds = Speeds(np.zeros(0), np.zeros((0, 0), dtype=np.int64))
    return Tally(counted, make_waves(0), make_waves(0), make_impacts(0), speeds, np.zeros((2, 0)))


@kernel
def _end(front, waves):  # type: ignore[no-untyped-def]
    """Count all waves of a front at their origins and give their places back."""
    wave = waves.heads[front]
    while wave >= 0:
        waves.sizes[waves.origins[wave], front - waves.origins[wave] - 1] += 1
        following = waves.following[wave]
        waves.following[wave] = waves.unused[0]
        waves.unused[0] = wave
        wave = following
    waves.heads[front] = -1


@kernel
def _start(origin, waves):  # type: ignore[no-untyped-def]
    """Start a wave; move it and all waves on its origin to the front right of the origin."""
    wave = waves.unused[0]
    waves.unused[0] = waves.following[wave]
    waves.origins[wave] = origin
    waves.following[wave] = waves.heads[origin]
    waves.heads[origin] = -1
    waves.heads[origin + 1] = wave


@inlined
def _push(contact, first, last, momentum, waves):  # type: ignore[no-untyped-def]
    """Record a collision of two clusters, which runs through the cluster that is pushed."""
    if momentum > 0:
        for pushed in range(contact, last):
            _end(pushed + 1, waves)
            _start(pushed, waves)
    else:
        for pushed in range(contact, first - 1, -1):
            _end(pushed + 1, waves)
            _end(pushed, waves)


@inlined
def _trigger(contact, momentum, waves):  # type: ignore[no-untyped-def]
    """Record a collision of two rods by the paper's rules."""
    _end(contact + 1, waves)
    if momentum <= 0:
        _end(contact, waves)
    _start(contact, waves)


@kernel
def record_collision(contact, first, last, v_left, v_right, tally):  # type: ignore[no-untyped-def]
    """Record a collision of the rods ``contact`` and ``contact + 1`` (counted from 0).

    ``first`` and ``last`` are the outermost rods of the two clusters that meet. ``v_left`` and
    ``v_right`` are the velocities of the clusters.
    """
    if tally.contacts.size > 0:
        tally.contacts[contact] += 1
    if tally.pushes.heads.size > 0:
        momentum = (contact - first + 1) * v_left + (last - contact) * v_right
        _push(contact, first, last, momentum, tally.pushes)
    if tally.triggered.heads.size > 0:
        _trigger(contact, v_left + v_right, tally.triggered)
