"""The collision operators under one signature, and the choice between them.

An operator advances y and v over one step of free flight with collisions. It returns the number of
collisions (0 where rods are sorted), or -1 if there were too many. ``method="event-driven"`` gives
the result of one collision after the other: by sorting at e = 1, by isotonic regression at e = 0
(both in O(L)), and otherwise, or if every collision has to be counted, by taking them in their
order (``EVENTS``). ``method="contact-dynamics"`` solves all contacts of a step at once. ``EXACT``
is no operator: chains whose motion is known (``exact_flight.py``) need none.
"""

import math
from collections.abc import Set
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import WALLS_AND_MASSES, Chain
from crazybilliards.model.kernels import inlined
from crazybilliards.particles.laws import contact_dynamics, event_driven, isotonic, sort, walls
from crazybilliards.particles.laws.avalanche import Tally, make_tally
from crazybilliards.particles.laws.closed_contacts import Clusters, make_clusters
from crazybilliards.particles.laws.exact_flight import independent_rods
from crazybilliards.particles.laws.impacts import make_impacts
from crazybilliards.particles.laws.unequal import row_restitution
from crazybilliards.particles.noise import BLOCK

Method = Literal["event-driven", "contact-dynamics"]

SORT, ISOTONIC, EVENTS, CONTACTS, EXACT, TURN = range(6)
NAMES = (
    *("the sort", "isotonic regression", "event-driven", "contact-dynamics", "exact flight"),
    "exact flight between walls",
)

ENDLESS = 2**62  # collisions

# Parameters beside ``KNOWN`` with which an operator is right: {EVENTS: {"my_own"}}.
knows: dict[int, Set[str]] = {
    **dict.fromkeys((ISOTONIC, EVENTS, CONTACTS), WALLS_AND_MASSES),
    **dict.fromkeys((EXACT, TURN), WALLS_AND_MASSES - {"mass_ratio"}),
}


class Law(NamedTuple):
    """The collision law as plain numbers for the kernels."""

    operator: int
    restitution: float
    merge_speed: float  # speed of separation below which rods cluster until the end of the step
    most: int  # collisions in one step after which the chain counts as diverged
    pull: float = 0.0  # k/m if springs that meet may differ and are kicked in halves
    exponent: int = 2  # of the spring's potential
    low: float = -math.inf  # the walls in the reduced coordinate
    high: float = math.inf
    wall_restitution: float = 1.0
    unequal: bool = False  # masses differ, or there are walls
    row_restitution: float = 1.0  # of a rod that hits one that rests at a wall


class Scratch(NamedTuple):
    """Arrays the kernels work in, made once for each replica."""

    integers: NDArray[np.int64]  # (3, L)
    floats: NDArray[np.float64]  # (4, L), or with walls (4, L + 2)
    first: NDArray[np.int64]  # rods of the cluster at each rod in ``event_driven``, (L,)
    last: NDArray[np.int64]
    due: NDArray[np.float64]  # when contacts close there, (2 L,)
    following: NDArray[np.uint64]  # its lists of contacts
    preceding: NDArray[np.uint64]
    winner: NDArray[np.uint64]  # of every node of its tournament
    buckets: NDArray[np.int32]  # of each rod in ``sort``, (L,)
    counts: NDArray[np.int32]  # of the rods in each bucket
    clusters: Clusters  # rods in contact after the last drift, if the law needs them
    kicks: NDArray[np.float64]  # of the noise, for one step or several, one after the other
    kept: Tally  # a copy of what was recorded up to the last snapshot
    inverse: NDArray[np.float64]  # inverse masses, with the walls; empty: all 1, and no walls
    joint: NDArray[np.float64]  # the same of clusters, at their outermost rods
    patience: NDArray[np.int64]  # collisions after which a step is given up; Ctrl-C lowers it, (1,)


def make_scratch(
    rods: int,
    inverse: NDArray[np.float64] = np.zeros(0),  # noqa: B008
    patience: NDArray[np.int64] = np.full(1, ENDLESS),  # noqa: B008
) -> Scratch:
    """Return the scratch space for so many rods, with two walls or not: 220 bytes a rod."""
    size = max(rods, inverse.size)
    nodes = np.arange(2 * size, dtype=np.uint64)
    kept = make_tally(rods, contacts=True)
    return Scratch(
        np.zeros((3, size), dtype=np.int64),
        np.zeros((4, size)),
        np.arange(size),
        np.arange(size),
        np.zeros(2 * size),
        nodes,
        nodes.copy(),
        nodes.copy(),
        np.zeros(size, dtype=np.int32),
        np.zeros(sort.BUCKETS * size, dtype=np.int32),
        make_clusters(size),
        # The exact flight takes two numbers a rod.
        np.zeros(max(2, BLOCK // rods) * rods),
        kept._replace(impacts=make_impacts(rods), struck=np.zeros((2, 2))),
        inverse,
        inverse.copy(),
        patience,
    )


def choose_operator(
    chain: Chain, method: Method, *, counted: bool, halves: bool, struck: bool = False
) -> int:
    """Return the fastest operator that is right for the chain and knows all of its parameters.

    ``counted``: every collision has to be recorded. ``struck``: so has every impulse on a wall.
    ``halves``: springs kick before and after the drift. With a gap, collisions are then corrected
    one by one, so e = 1 cannot be sorted. If none knows a parameter this is a ValueError.
    """
    right = [CONTACTS if method == "contact-dynamics" else EVENTS]
    if method == "event-driven" and not counted and chain.box:
        if chain.restitution == chain.wall_restitution == 0 and not struck:
            right.insert(0, ISOTONIC)
        if halves and chain.wall_restitution == 1 and independent_rods(chain):
            right.insert(0, TURN if chain.stiffness > 0 or struck else EXACT)
    elif method == "event-driven" and not counted:
        corrected = halves and chain.restitution == 1 and chain.gap * chain.stiffness > 0
        if chain.restitution in (0, 1) and not corrected:
            right.insert(0, SORT if chain.restitution == 1 else ISOTONIC)
        if halves and independent_rods(chain):
            right.insert(0, EXACT)
    unknown = chain.unknown().keys()
    operator = next((n for n in right if unknown <= knows.get(n, set())), right[-1])
    chain.require_known(f"simulate ({NAMES[operator]})", knows.get(operator, ()))
    return operator


def make_law(
    chain: Chain, time_step: float, operator: int, merging: float, speed: float, *, halves: bool
) -> Law:
    """Return the law of the chain, in whose steps springs kick in ``halves`` or not.

    ``merging`` is in velocity kicks of one step's noise. With little or no noise 1e-9 of the
    typical ``speed`` is used, so that inelastic collapse stays finite.
    """
    pull = chain.stiffness / chain.mass if halves else 0.0
    kick = chain.amplitude / chain.mass * math.sqrt(time_step)
    inelastic = min(chain.restitution, chain.wall_restitution) < 1
    merge_speed = max(merging * kick, 1e-9 * speed) if inelastic else 0.0
    unequal = chain.box > 0 or chain.mass_ratio != 1
    if operator == EVENTS and chain.gap == 0 and not unequal:
        pull = 0.0  # rods with one anchor have the same acceleration where they meet
    # Collisions that bring in no energy come to an end, however many they are.
    gaining = pull > 0 or max(chain.restitution, chain.wall_restitution) > 1
    most = 1_000 * chain.size + 1_000_000 if gaining else ENDLESS
    from_row = row_restitution(chain.restitution, chain.wall_restitution)
    around = *chain.walls, chain.wall_restitution, unequal, from_row
    exponent = chain.potential_exponent
    return Law(operator, chain.restitution, merge_speed, most, pull, exponent, *around)


@inlined(once=True)
def drift(y, v, anchors, dt, law, scratch, tally):  # type: ignore[no-untyped-def]
    """Advance ``y`` and ``v`` in place by ``dt`` with the operator that ``law`` names."""
    if law.operator == SORT:
        sort.drift(y, v, dt, scratch)
        return 0
    if law.operator == TURN:
        walls.turn(y, v, dt, law.pull, law.low, law.high, tally.struck)
        sort.sort_pairs(y, v, scratch)
        return 0
    if law.operator == ISOTONIC:
        if law.unequal:
            return isotonic.stick(y, v, dt, law, scratch)
        return isotonic.drift(y, v, dt, scratch.integers[0], scratch.floats, scratch.clusters)
    if law.operator == CONTACTS:
        if law.unequal:
            return contact_dynamics.solve(y, v, anchors, dt, law, scratch)
        spring_and_scratch = law.pull, law.exponent, scratch.integers, scratch.floats
        return contact_dynamics.drift(y, v, anchors, dt, law.restitution, *spring_and_scratch)
    if law.high < np.inf:
        return walls.drift(y, v, anchors, dt, law, scratch, tally)
    return event_driven.drift(y, v, anchors, dt, law, scratch, tally)
