"""Answers to the tasks of lesson 6, The pressure on a wall."""

import numpy as np

TWICE_THE_MASS = "equal"


def force_of_a_point(v, room, mass):
    """Return the mean force of a point that flies between two walls at the distance ``room``."""
    return mass * v**2 / room


def pressure(box, rods, temperature, radius):
    """Return the pressure of hard rods in a box."""
    return rods * temperature / (box - 2 * radius * rods)


def rod_length(boxes, pressures, rods):
    """Return the length of a rod, where the straight line 1/P against X meets the axis."""
    slope, start = np.polyfit(boxes, 1 / np.asarray(pressures), 1)
    return -start / slope / rods


def density_at_the_wall(box, rods, radius):
    """Return the density of the first rod where it touches the wall, in units of L/X."""
    return box / (box - 2 * radius * rods)


def places(uniform, box, radius):
    """Return the positions of rods from independent numbers between 0 and 1."""
    rods = len(uniform)
    y = (box - 2 * radius * rods) * (np.sort(uniform) - 0.5)
    return y + 2 * radius * (np.arange(rods) - (rods - 1) / 2)
