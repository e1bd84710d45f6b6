"""Avalanches: waves of momentum that run along the chain from collision to collision.

Whenever rod i hits its right neighbour while the momentum of the two points right, a wave starts
at the origin i with its front on i+1. The next collision of the front decides: if it is with its
own right neighbour and the momentum points right again, the front moves on; otherwise the wave
ends, having triggered N_c = front - origin collisions, and is counted at its origin.

Waves with the same front share their future. A front's waves are a linked list that moves as a
whole, so a collision costs O(1), and its waves' end what their starts have paid for:

    collision of c and c+1    rightward: waves on c+1 end, those on c move to c+1, one starts at c
                              otherwise: waves on c and on c+1 end

Rods that stick together pass a push on from one to the next, in no time: when clusters meet, the
collisions run on through the one that is pushed, to its far end.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model.kernels import kernel

Integers = NDArray[np.int64]


class Tally(NamedTuple):
    """What is kept of single collisions. Arrays of length 0: not kept."""

    contacts: Integers  # collisions at each contact, (L - 1,)
    heads: Integers  # first wave of each front, -1 without any, (L,)
    following: Integers  # next wave with the same front, or next unused place, -1 at the end
    origins: Integers  # of each wave
    unused: Integers  # first unused place, (1,)
    sizes: Integers  # waves ended, by origin and by N_c - 1, (L, L)


def make_tally(size: int, *, contacts: bool, waves: bool) -> Tally:
    """Return an empty tally for ``size`` rods; with ``waves`` it takes 16 L^2 bytes."""
    fronts = size if waves else 0
    # A front p has at most one wave of each origin below it.
    places = fronts * (fronts - 1) // 2
    following = np.arange(1, places + 1, dtype=np.int64)
    following[-1:] = -1
    return Tally(
        np.zeros(max(size - 1, 0) if contacts else 0, dtype=np.int64),
        np.full(fronts, -1, dtype=np.int64),
        following,
        np.zeros(places, dtype=np.int64),
        np.zeros(1, dtype=np.int64),
        np.zeros((fronts, fronts), dtype=np.int64),
    )


@kernel
def _end(front, tally):  # type: ignore[no-untyped-def]
    """Count all waves of a front at their origins and give their places back."""
    wave = tally.heads[front]
    while wave >= 0:
        tally.sizes[tally.origins[wave], front - tally.origins[wave] - 1] += 1
        following = tally.following[wave]
        tally.following[wave] = tally.unused[0]
        tally.unused[0] = wave
        wave = following
    tally.heads[front] = -1


@kernel
def record_collision(contact, first, last, momentum, tally):  # type: ignore[no-untyped-def]
    """Take down a collision of rods ``contact`` and ``contact + 1`` (counted from 0).

    ``first`` and ``last`` are the outermost rods of the two clusters that meet, ``momentum`` is
    theirs together.
    """
    if tally.contacts.size > 0:
        tally.contacts[contact] += 1
    if tally.heads.size == 0:
        return
    if momentum <= 0:
        for pushed in range(contact, first - 1, -1):
            _end(pushed + 1, tally)
            _end(pushed, tally)
        return
    for pushed in range(contact, last):
        _end(pushed + 1, tally)
        wave = tally.unused[0]
        tally.unused[0] = tally.following[wave]
        tally.origins[wave] = pushed
        tally.following[wave] = tally.heads[pushed]
        tally.heads[pushed] = -1
        tally.heads[pushed + 1] = wave
