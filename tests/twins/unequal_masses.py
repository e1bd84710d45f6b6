"""Collisions of unequal masses between walls, as one would write them down.

The slow twin of ``laws/unequal.py`` and ``laws/walls.py``: bodies are a list, with their inverse
masses, 0 for a wall and for what rests at one. All contacts are looked through for every collision.
The arithmetic of a collision is the same, so that results must agree to the last bit.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from next_collision import meeting

from crazybilliards.model import spring
from crazybilliards.particles.laws.law import EVENTS, Law


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
    clusters: list[tuple[int, int]]  # of rods: the first one and the one after the last


def drift(y, v, masses, anchors, dt, law):
    """Move the rods of a chain; ``law.pull`` is that of a mass of 1."""
    size = len(y)
    bodies = [Body(float(y[i]), float(v[i]), float(1 / masses[i]), (i,)) for i in range(size)]
    if law.high < math.inf:
        ends = Body(law.low, 0.0, 0.0, (-1,)), Body(law.high, 0.0, 0.0, (size,))
        bodies = [ends[0], *bodies, ends[1]]
    contacts, impulses, hits = [0] * (size - 1), [0.0, 0.0], [0, 0]
    due = [meeting(*pair, 0.0, dt) for pair in pairwise(bodies)]
    while min(due, default=math.inf) < math.inf:
        speeds = [one.v - other.v for one, other in pairwise(bodies)]
        k = min(range(len(due)), key=lambda k: (due[k], -speeds[k]))
        left, right, now = bodies[k], bodies[k + 1], due[k]
        new, impulse = collided(left, right, masses, anchors, now, dt, law)
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
    ends = np.zeros((2, size))
    for body in bodies:
        own = [rod for rod in body.rods if 0 <= rod < size]
        ends[0, own], ends[1, own] = body.y + dt * body.v, body.v
    merged = [body.rods for body in bodies if len(body.rods) > 1]
    clusters = [(max(rods[0], 0), min(rods[-1] + 1, size)) for rods in merged]
    return Drifted(*ends, contacts, impulses, hits, clusters)


def moved(chain, state, dt, steps):
    """Positions, velocities and the collisions of rods and with walls after steps without noise."""
    masses = np.resize([chain.mass, chain.mass * chain.mass_ratio], chain.size)
    anchors, high = chain.reduced_anchors, chain.box / 2 - chain.radius * chain.size
    springs = chain.stiffness, chain.potential_exponent, -high, high, chain.wall_restitution
    law = Law(EVENTS, chain.restitution, 0.0, 0, *springs)
    decay = np.exp(-chain.damping / masses * dt / 2)

    def pull(y):
        forces = [spring.force(each, law.exponent) for each in y - anchors]
        return chain.stiffness / masses * forces * dt / 2

    (y, v), contacts, hits = state, 0, 0
    for _ in range(steps):
        step = drift(y, decay * v - pull(y), masses, anchors, dt, law)
        contacts, hits = contacts + sum(step.contacts), hits + sum(step.hits)
        y, v = step.y, decay * (step.v - pull(step.y))
    return y, v, contacts, hits


def collided(left, right, masses, anchors, now, dt, law):
    """Return the one or two bodies after a collision, and the impulse that they exchange."""
    ahead = 0.0
    if len(left.rods) == len(right.rods) == 1 and law.pull > 0:
        here, since = left.y + left.v * now, now - dt / 2
        a, b = (acceleration(each, here, anchors, law) for each in (left, right))
        ahead = -a * since + b * since
    meet = left.rods[-1], right.rods[0]
    at_wall = meet[0] == -1 or meet[1] == len(masses)
    e = law.wall_restitution if at_wall else law.restitution
    e = min(e, 1.0) if now == 0 else e
    closing = left.v - right.v - ahead
    rebound = e * closing
    kicks = sum(1 / masses[rod] for rod in meet if 0 <= rod < len(masses))
    both = left.inverse + right.inverse
    shares = left.inverse / both, right.inverse / both
    merges = rebound <= (law.merge_speed * kicks / 2 if e < 1 else 0.0)
    apart = 0.0 if merges else max(rebound - ahead, 0.0)
    change = left.v - right.v + apart
    after = [left.v - shares[0] * change, right.v + shares[1] * change]
    if apart == 0:
        after = [after[0] if shares[0] < shares[1] else after[1]] * 2
    places = [body.y + (body.v - v) * now for body, v in zip((left, right), after, strict=True)]
    if merges:
        merged = left.rods + right.rods
        return [Body(places[0], after[0], shares[0] * right.inverse, merged)], change / both
    new = zip((left, right), places, after, strict=True)
    return [body._replace(y=y, v=v) for body, y, v in new], change / both


def acceleration(body, here, anchors, law):
    """Return the acceleration of a single rod by its spring."""
    (rod,) = body.rods
    if not 0 <= rod < len(anchors):
        return 0.0
    return -law.pull * body.inverse * spring.force(here - anchors[rod], law.exponent)
