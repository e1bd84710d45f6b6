"""Event-driven collisions as one would write them down: look for the next one, take it, repeat.

The independent twin of the tournament, of ``laws/unequal.py`` and of ``laws/walls.py``: bodies are
a list, with their inverse masses, 0 for a wall and for what rests at one. All contacts are looked
through for every collision. The arithmetic of a collision is the same, so that results must agree
to the last bit, but for the order in which masses and their inverses are multiplied.
"""

import math
from itertools import pairwise
from typing import NamedTuple

from crazybilliards.model import spring
from crazybilliards.particles.laws.avalanche import record_collision
from crazybilliards.particles.laws.impacts import record_impact


class Body(NamedTuple):
    y: float  # where it would have been at the beginning of the step, with its velocity
    v: float
    inverse: float  # mass
    rods: tuple[int, ...]  # counted from 0; -1 is the left wall, L the right one


class Drifted(NamedTuple):
    y: list[float]
    v: list[float]
    contacts: list[int]  # collisions
    impulses: list[float]  # on the walls
    hits: list[int]


def drift(y, v, masses, anchors, dt, law, tally=None):
    """Move the rods of a chain, unless they collide too often; ``law.pull`` is that of a mass of 1.

    With a tally of all collisions, the masses are alike and there are no walls.
    """
    size = len(y)
    bodies = [Body(float(y[i]), float(v[i]), float(1 / masses[i]), (i,)) for i in range(size)]
    if law.high < math.inf:
        ends = Body(law.low, 0.0, 0.0, (-1,)), Body(law.high, 0.0, 0.0, (size,))
        bodies = [ends[0], *bodies, ends[1]]
    contacts, impulses, hits = [0] * (size - 1), [0.0, 0.0], [0, 0]
    due = [meeting(*pair, 0.0, dt) for pair in pairwise(bodies)]
    while min(due, default=math.inf) < math.inf:
        if sum(contacts) + sum(hits) == law.most:
            return None
        speeds = [one.v - other.v for one, other in pairwise(bodies)]
        k = min(range(len(due)), key=lambda k: (due[k], -speeds[k]))  # of equal ones the leftmost
        left, right, now = bodies[k], bodies[k + 1], due[k]
        if tally is None:
            new, impulse = collided(left, right, masses, anchors, now, dt, law)
        else:
            new, impulse = collided_alike(left, right, anchors, now, dt, law, tally), 0.0
        if 0 <= left.rods[-1] < size - 1:
            contacts[left.rods[-1]] += 1
        else:
            hits[left.rods[-1] >= 0] += 1
        for side, body in enumerate((left, right)):
            impulses[side] += impulse if body.inverse == 0 else 0.0
        bodies[k : k + 2] = new
        due[k : k + 1] = [math.inf] * (len(new) - 1)
        for contact in {k - 1, k + len(new) - 1}:
            if 0 <= contact < len(due):
                due[contact] = meeting(*bodies[contact : contact + 2], now, dt)
    places, speeds = [], []
    for body in bodies:
        own = [rod for rod in body.rods if 0 <= rod < size]
        places += [max([body.y + dt * body.v, *places[-1:]])] * len(own)
        speeds += [body.v] * len(own)
    return Drifted(places, speeds, contacts, impulses, hits)


def meeting(left, right, now, dt):
    """When two neighbours meet next, infinity if not within the step."""
    gap, closing = right.y - left.y, left.v - right.v
    return max(gap / closing, now) if closing > 0 and gap < dt * closing else math.inf


def collided_alike(left, right, anchors, now, dt, law, tally):
    """Return the one or two bodies after a collision of rods of the mass 1."""
    first, middle, last = left.rods[0], left.rods[-1], right.rods[-1]
    record_collision(middle, first, last, left.v, right.v, tally)
    number, other = len(left.rods), len(right.rods)
    common = left.v + (right.v - left.v) * other / (number + other)
    e = min(law.restitution, 1.0) if now == 0 else law.restitution
    ahead = 0.0
    if number == other == 1:  # of what the springs have given so far
        here = left.y + left.v * now
        forces = [spring.force(here - anchors[i], law.exponent) for i in (middle, middle + 1)]
        ahead = law.pull * (forces[0] - forces[1]) * (now - dt / 2)
    closing = left.v - right.v - ahead
    rebound = e * closing
    merges = rebound <= law.merge_speed or (rebound <= ahead and e < 1)
    record_impact(middle, first, last, closing, 0.0 if merges else rebound, tally.impacts)
    if merges:
        place = left.y + (left.v - common) * now
        return [Body(place, common, 1 / (number + other), left.rods + right.rods)]
    rebound = max(rebound - ahead, 0.0)  # no rod passes another
    new_left = common - rebound * other / (number + other)
    new_right = common + rebound * number / (number + other)
    return [
        left._replace(y=left.y + (left.v - new_left) * now, v=new_left),
        right._replace(y=right.y + (right.v - new_right) * now, v=new_right),
    ]


def collided(left, right, masses, anchors, now, dt, law):
    """Return the one or two bodies after a collision, and the impulse that they exchange."""
    ahead = 0.0
    if len(left.rods) == len(right.rods) == 1 and law.pull > 0:
        here, since = left.y + left.v * now, now - dt / 2
        a, b = (acceleration(each, here, anchors, law) for each in (left, right))
        ahead = -a * since + b * since
    meet = left.rods[-1], right.rods[0]
    rests = left.inverse * right.inverse == 0  # one of the two, if it is no wall
    e = law.row_restitution if rests else law.restitution
    e = law.wall_restitution if meet[0] == -1 or meet[1] == len(masses) else e
    e = min(e, 1.0) if now == 0 else e
    closing = left.v - right.v - ahead
    rebound = e * closing
    kicks = sum(1 / masses[rod] for rod in meet if 0 <= rod < len(masses))
    both = left.inverse + right.inverse
    shares = left.inverse / both, right.inverse / both
    merges = rebound <= (law.merge_speed * kicks / 2 if e < 1 or rests else 0.0)
    merges = merges or (rebound <= ahead and e < 1)
    apart = 0.0 if merges else max(rebound - ahead, 0.0)
    change = left.v - right.v + apart
    after = [left.v - shares[0] * change, right.v + shares[1] * change]
    if apart == 0:
        after = [after[0] if shares[0] < shares[1] else after[1]] * 2
    places = [body.y + (body.v - v) * now for body, v in zip((left, right), after, strict=True)]
    if merges:
        merged = left.rods + right.rods
        place = (law.low if left.inverse == 0 else law.high) if rests else places[0]
        return [Body(place, after[0], shares[0] * right.inverse, merged)], change / both
    new = zip((left, right), places, after, strict=True)
    return [body._replace(y=y, v=v) for body, y, v in new], change / both


def acceleration(body, here, anchors, law):
    """Return the acceleration of a single rod by its spring."""
    (rod,) = body.rods
    if not 0 <= rod < len(anchors):
        return 0.0
    return -law.pull * body.inverse * spring.force(here - anchors[rod], law.exponent)
