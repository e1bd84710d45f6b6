"""Answers to the tasks of lesson 2, The dissipative chain."""

import numpy as np

SLOWEST_OF_THREE = "middle"  # it is hit from both sides
EXPONENT_OF_THE_CENTRE = -0.38  # of the central width against the number of rods


def share_of_collisions(width, W):
    """Return the share of the noise's power that collisions take from a rod of this width."""
    return 1 - (width / W) ** 2


def width_of_block(n, W):
    """Return the velocity width of n rods that move as one."""
    return W / np.sqrt(n)
