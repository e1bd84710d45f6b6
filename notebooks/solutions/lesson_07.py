"""Answers to the tasks of lesson 7, When is a gas a fluid?"""

import numpy as np

OVERSHOOTS = "isothermal"
RELEASED = "spread"


def heat_rate(sigma, sigma_rate, heat, chain):
    """Return the change of W^2 in time in a cloud of width sigma."""
    exchanged = 2 * chain.damping / chain.mass * (heat - chain.free_velocity_width**2)
    return -2 * heat * sigma_rate / sigma - exchanged


def mirrored(y, low, high):
    """Return the place of a point between two mirrors, from where it would be without them."""
    room = high - low
    way = np.mod(y - low, 2 * room)
    return low + np.minimum(way, 2 * room - way)


def wave_matrix(damping, heat):
    """Return the matrix of density, velocity and temperature of a wave; rates in kappa W."""
    return np.array([[0, -1, 0], [1, -damping, 1], [0, -2, -2 * heat]])


def collision(v1, v2, m1, m2):
    """Return both velocities after an elastic collision."""
    centre = (m1 * v1 + m2 * v2) / (m1 + m2)
    return 2 * centre - v1, 2 * centre - v2


def damped_wave(t, omega, beta):
    """Return a damped wave that begins at 1 with the slope 0."""
    return np.exp(-beta * t) * (np.cos(omega * t) + beta / omega * np.sin(omega * t))
