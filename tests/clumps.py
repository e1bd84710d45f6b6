"""A start of two clumps: the stationary state cut in half, each half moved outwards."""

import numpy as np

from crazybilliards.kinetic import displaced


def two_clumps(chain, distance, speed):
    """Return clumps that are ``distance`` apart and approach one another, each with ``speed``."""
    whole = displaced(chain, 0.0)
    start = displaced(chain, distance / 2)  # its grid holds both
    x, half = start.x.values, chain.size / 2
    inside = np.maximum(np.abs(x) - distance / 2, 0.0)
    density = np.where(np.abs(x) < distance / 2, 0.0, np.interp(inside, whole.x, whole.density))
    label = half + np.sign(x) * (np.interp(inside, whole.x, whole.label) - half)
    velocity = -np.sign(x) * speed
    return start.assign(density=("x", density), label=("x", label), flow_velocity=("x", velocity))
