"""Answers to the tasks of lesson 3, Collisions and restitution."""

import numpy as np

AFTER_THE_CRADLE = [0, 0, 1]  # one collision after the other
AFTER_ONE_BODY_HITS_TWO = [-1 / 3, 2 / 3, 2 / 3]  # all contacts at once


def collide(v1, v2, e):
    """Return the velocities of two rods of equal mass after their collision."""
    mean, closing = (v1 + v2) / 2, v1 - v2
    return mean - e / 2 * closing, mean + e / 2 * closing


def energy_taken(closing, e, m):
    """Return the kinetic energy that a collision takes from two rods of the mass m."""
    return (1 - e**2) / 4 * m * closing**2


def elastic(y, v, duration):
    """Return the positions of elastic points after a time, from left to right."""
    return np.sort(y + v * duration)


def pool_adjacent_violators(z):
    """Return the ascending row that is nearest to z: blocks, each at the mean of its members."""
    blocks = []  # mean and number of members
    for mean in z:
        members = 1
        while blocks and blocks[-1][0] > mean:
            left, others = blocks.pop()
            mean = (left * others + mean * members) / (others + members)
            members += others
        blocks.append((mean, members))
    return np.repeat([mean for mean, _ in blocks], [members for _, members in blocks])


def contact_dynamics(v, e):
    """Return the velocities after all contacts of rods in contact are solved at once."""
    B = np.concatenate([[0], np.cumsum(e * np.maximum(v[:-1] - v[1:], 0))])
    return pool_adjacent_violators(v - B) + B


def most_collisions(e):
    """Return how often three rods can collide, for e above 7 - 4 sqrt(3)."""
    return np.ceil(np.pi / np.arccos((1 + e) / (4 * np.sqrt(e))) - 1e-9)
