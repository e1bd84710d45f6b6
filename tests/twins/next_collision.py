"""Event-driven collisions as one would write them down: look for the next one, take it, repeat.

The independent twin of the tournament: clusters are a list, and all contacts are looked through
for every collision. The arithmetic is the same, so that results must agree to the last bit.
"""

import math
from itertools import pairwise

from crazybilliards.model import spring
from crazybilliards.particles.laws.avalanche import record_collision
from crazybilliards.particles.laws.impacts import record_impact


def drift(y, v, anchors, dt, law, tally):
    """Positions, velocities, runs of rods in contact, and the collisions, or -1 if too many."""
    restitution, merge_speed = law.restitution, law.merge_speed
    bodies = [(float(y[i]), float(v[i]), i, i) for i in range(len(y))]  # first and last rod
    due = [meeting(*pair, 0.0, dt) for pair in pairwise(bodies)]
    collisions = 0
    while min(due, default=math.inf) < math.inf:
        speeds = [one[1] - other[1] for one, other in pairwise(bodies)]
        k = min(range(len(due)), key=lambda k: (due[k], -speeds[k]))  # of equal ones the leftmost
        now = due[k]
        y_left, v_left, first, middle = bodies[k]
        y_right, v_right, _, last = bodies[k + 1]
        collisions += 1
        if collisions > law.most:
            return None, None, None, -1
        record_collision(middle, first, last, v_left, v_right, tally)
        left, right = middle - first + 1, last - middle
        common = v_left + (v_right - v_left) * right / (left + right)
        e = min(restitution, 1.0) if now == 0 else restitution
        ahead = 0.0
        if left == right == 1:  # of what the springs have given so far
            here = y_left + v_left * now
            forces = [spring.force(here - anchors[i], law.exponent) for i in (middle, middle + 1)]
            ahead = law.pull * (forces[0] - forces[1]) * (now - dt / 2)
        closing = v_left - v_right - ahead
        rebound = e * closing
        separating = rebound if rebound > merge_speed else 0.0
        record_impact(middle, first, last, closing, separating, tally.impacts)
        if rebound <= merge_speed:
            bodies[k : k + 2] = [(y_left + (v_left - common) * now, common, first, last)]
            del due[k]
            changed = (k - 1, k)
        else:
            rebound = max(rebound - ahead, 0.0)  # no rod passes another
            new_left = common - rebound * right / (left + right)
            new_right = common + rebound * left / (left + right)
            bodies[k] = (y_left + (v_left - new_left) * now, new_left, first, middle)
            bodies[k + 1] = (y_right + (v_right - new_right) * now, new_right, middle + 1, last)
            due[k] = math.inf
            changed = (k - 1, k + 1)
        for contact in changed:
            if 0 <= contact < len(due):
                due[contact] = meeting(bodies[contact], bodies[contact + 1], now, dt)
    positions, velocities, clusters = [], [], []
    for position, velocity, first, last in bodies:
        end = max([position + dt * velocity, *positions[-1:]])
        positions += [end] * (last - first + 1)
        velocities += [velocity] * (last - first + 1)
        clusters += [(first, last + 1)] if last > first else []
    return positions, velocities, clusters, collisions


def meeting(left, right, now, dt):
    """When two neighbours meet next, infinity if not within the step."""
    gap, closing = right[0] - left[0], left[1] - right[1]
    return max(gap / closing, now) if closing > 0 and gap < dt * closing else math.inf
