"""Answers to the task of The analytics section in sixty lines."""


def speed_of_sound(free, radius):
    """Return the speed of sound over W_v where the density per free length is ``free``."""
    return 1 + 2 * radius * free
