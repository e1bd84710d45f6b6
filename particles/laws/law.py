"""The collision operators under one signature, and the choice between them.

An operator advances y and v over one step of free flight with collisions. It returns the number of
collisions, or -1 if there were too many. ``method="event-driven"`` gives the result of one
collision after the other: by sorting at e = 1, by isotonic regression at e = 0 (both in O(L)), and
by taking the collisions in their order (``EVENTS``) otherwise, or if every collision has to be
counted at its contact. ``method="contact-dynamics"`` solves all contacts of a step at once.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.model.kernels import kernel
from crazybilliards.particles.laws import contact_dynamics, event_driven, isotonic, sort
from crazybilliards.particles.laws.closed_contacts import Clusters, make_clusters
from crazybilliards.particles.noise import BLOCK

Method = Literal["event-driven", "contact-dynamics"]

SORT, ISOTONIC, EVENTS, CONTACTS = range(4)


class Law(NamedTuple):
    """The collision law as plain numbers for the kernels."""

    operator: int
    restitution: float
    merge_speed: float  # speed of separation below which rods cluster until the end of the step
    most: int  # collisions in one step after which the chain counts as diverged
    pull: float = 0.0  # k/m if springs that meet may differ and are kicked in halves
    exponent: int = 2  # of the spring's potential


class Scratch(NamedTuple):
    """Arrays the kernels work in, made once for each replica."""

    integers: NDArray[np.int64]
    floats: NDArray[np.float64]
    clusters: Clusters  # rods in contact after the last drift, if the law needs them
    kicks: NDArray[np.float64]  # of the noise, for one step or several, (steps, L)


def make_scratch(size: int) -> Scratch:
    """Return the scratch space for ``size`` rods: 88 bytes a rod."""
    return Scratch(
        np.zeros((4, size), dtype=np.int64),
        np.zeros((4, size)),
        make_clusters(size),
        np.zeros((max(1, BLOCK // size), size)),
    )


def make_law(
    chain: Chain,
    time_step: float,
    method: Method,
    merging: float,
    speed: float,
    *,
    counted: bool = False,
    halves: bool = True,
) -> Law:
    """Choose the operator for the chain.

    ``merging`` is in velocity kicks of one step's noise. With little or no noise 1e-9 of the
    typical ``speed`` is used, so that inelastic collapse stays finite. ``counted``: every collision
    has to be recorded. ``halves``: springs kick before and after the drift. With a gap, collisions
    are then corrected one by one, so chains with e = 1 cannot be sorted.
    """
    pull = chain.stiffness / chain.mass if halves else 0.0
    if method == "contact-dynamics":
        operator = CONTACTS
    elif counted or (chain.restitution == 1 and chain.gap * pull > 0):
        operator = EVENTS
    else:
        operator = {1.0: SORT, 0.0: ISOTONIC}.get(chain.restitution, EVENTS)
    kick = chain.amplitude / chain.mass * math.sqrt(time_step)
    merge_speed = max(merging * kick, 1e-9 * speed) if chain.restitution < 1 else 0.0
    if operator == EVENTS and chain.gap == 0:
        pull = 0.0  # rods with one anchor have the same acceleration where they meet
    most = 1_000 * chain.size + 1_000_000
    return Law(operator, chain.restitution, merge_speed, most, pull, chain.potential_exponent)


@kernel
def drift(y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt`` with the operator that ``law`` names."""
    if law.operator == SORT:
        return sort.drift(y, v, dt, scratch.floats[0], scratch.floats[1])
    if law.operator == ISOTONIC:
        return isotonic.drift(y, v, dt, scratch.integers[0], scratch.floats, scratch.clusters)
    if law.operator == CONTACTS:
        spring_and_scratch = law.pull, law.exponent, scratch.integers, scratch.floats
        return contact_dynamics.drift(y, v, anchors, dt, law.restitution, *spring_and_scratch)
    return event_driven.drift(
        y,
        v,
        dt,
        law.restitution,
        law.merge_speed,
        law.most,
        anchors,
        law.pull,
        law.exponent,
        scratch.integers,
        scratch.floats,
        scratch.clusters,
        tally,
    )
