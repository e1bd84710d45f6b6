"""Answers to the tasks of lesson 9, Beyond restitution 1."""

import numpy as np


def gain(v, u, e):
    """Return the kinetic energy over m that two rods gain in a collision."""
    return (e**2 - 1) / 4 * (v - u) ** 2


def loss(n, T, e):
    """Return what collisions take from <v^2> of a point, per time."""
    return 2 / np.sqrt(np.pi) * (1 - e**2) * n * T**1.5


def change_of_product(v, u, e):
    """Return by how much the product of the velocities of two rods changes in a collision."""
    return (1 - e**2) / 4 * (v - u) ** 2


def pairs(size):
    """Return the number of pairs of rods."""
    return size * (size - 1) // 2


def critical_size(chain):
    """Return the largest number of rods that has a steady state, by the balance of energy."""
    excess = chain.restitution - 1
    return np.pi * chain.damping / (excess * np.sqrt(chain.stiffness * chain.mass))


def wall_force(chain, widths):
    """Return the force on a wall of a box without springs, by the virial theorem."""
    room = chain.box - 2 * chain.radius * chain.size
    return chain.mass * np.sum(widths**2) / room
