"""Answers to the tasks of lesson 8, Beyond restitution 1."""

import numpy as np
from scipy.linalg import solve_banded

HEAT_FLOWS = "from the ends to the centre"
QUADRATIC_GROWTH = "bent up"


def gain(v, u, e):
    """Return the kinetic energy over m that two rods gain in a collision."""
    return (e**2 - 1) / 4 * (v - u) ** 2


def loss(n, T, e):
    """Return what collisions take from <v^2> of a point, per time."""
    return 2 / np.sqrt(np.pi) * (1 - e**2) * n * T**1.5


def conduction(n, T, e, Gamma):
    """Return the heat conductivity along labels."""
    c = 9 / (2 * np.sqrt(np.pi)) * (1 - e**2)
    return 3 * n**2 * T / (3 * Gamma + c * n * np.sqrt(T))


def temperatures(loss, conduction, Gamma):
    """Return T of all rods from their rates of loss and the conduction of all contacts."""
    diagonal = 2 * Gamma + loss + np.append(conduction, 0) + np.append(0, conduction)
    bands = [np.append(0, -conduction), diagonal, np.append(-conduction, 0)]
    return solve_banded((1, 1), bands, np.full(loss.size, 2 * Gamma))


def change_of_product(v, u, e):
    """Return by how much the product of the velocities of two rods changes in a collision."""
    return (1 - e**2) / 4 * (v - u) ** 2


def critical_size(chain):
    """Return the largest number of rods that has a steady state, by the balance of energy."""
    excess = chain.restitution - 1
    return np.pi * chain.damping / (excess * np.sqrt(chain.stiffness * chain.mass))


def period_factor(energy_factor):
    """Return by which factor the period of a rod on a quadratic spring changes with its energy."""
    return energy_factor ** (-1 / 6)
