"""Answers to the tasks of lesson 9, Beyond restitution 1."""

import numpy as np


def share_lost(e):
    """Return the share of the relative velocity that a point loses when it passes another one."""
    return (1 - e) / 2


def gain(v, u, e):
    """Return the kinetic energy over m that two rods gain in a collision."""
    return (e**2 - 1) / 4 * (v - u) ** 2


def pairs(size):
    """Return the number of pairs of rods."""
    return size * (size - 1) // 2


def critical_size(chain):
    """Return the largest number of rods that has a steady state, by the balance of energy."""
    excess = chain.restitution - 1
    return np.pi * chain.damping / (excess * np.sqrt(chain.stiffness * chain.mass))
