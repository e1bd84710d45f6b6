"""Answers to the tasks of lesson 8, When is a gas a fluid?"""

import numpy as np

RELEASED = "spread"
KURTOSIS_OF_ONE_MASS = 1.0
LARGEST_FRICTION = 2.0


def mirrored(y, low, high):
    """Return the place of a point between two mirrors, from where it would be without them."""
    room = high - low
    way = np.mod(y - low, 2 * room)
    return low + np.minimum(way, 2 * room - way)


def wave_matrix(friction, heat):
    """Return the matrix of density, velocity and temperature of a wave; rates in kappa W."""
    return np.array([[0, -1, 0], [1, -friction, 1], [0, -2, -2 * heat]])


def collision(v1, v2, m1, m2):
    """Return both velocities after an elastic collision."""
    centre = (m1 * v1 + m2 * v2) / (m1 + m2)
    return 2 * centre - v1, 2 * centre - v2


def speed(time, room):
    """Return the speed of sound, if the longest wave has its first minimum at this time."""
    return room / time
