"""Answers to the tasks of lesson 10, Flippers."""

import numpy as np


def growth_rate(chain):
    """Return the rate at which the energy grows on linear springs, by the balance of energy."""
    half_period = np.pi * np.sqrt(chain.mass / chain.stiffness)
    gain = (chain.restitution**2 - 1) / 2 * chain.size / half_period
    return gain - chain.damping / chain.mass


def period_factor(energy_factor):
    """Return by which factor the period of a rod on a quadratic spring changes with its energy."""
    return energy_factor ** (-1 / 6)


def energy_factor(L, e):
    """Return the factor of a fast rod's energy after it has crossed L - 1 rods at rest."""
    return ((1 + e) / 2) ** (2 * (L - 1))
