"""Answers to the tasks of lesson 4, The elastic chain is exactly solvable."""

import numpy as np
from scipy.special import comb

# Velocity width of an outer rod over that of a free one: without a gap, with one, soft springs.
WIDTHS_OF_OUTER_RODS = [1, 1, 1]


def rods_from(numbers, chain):
    """Return positions of rods from Gaussian numbers of the variance 1, one row for each draw."""
    points = np.sort(chain.thermal_length * numbers, axis=1)
    return points + 2 * chain.radius * chain.rank


def ordered_density(u, i, L):
    """Return the probability density at u of the i-th smallest of L numbers, uniform in (0, 1)."""
    return L * comb(L - 1, i - 1) * u ** (i - 1) * (1 - u) ** (L - i)


def push_of_the_others(i, L):
    """Return the force on plane i of L planes, in units of that between two of them."""
    return (i - 1) - (L - i)
