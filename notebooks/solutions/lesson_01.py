"""Answers to the tasks of lesson 1, One noisy oscillator."""

import numpy as np
from scipy.special import erfc

FACTORS_OF_TWICE_THE_MASS = (1 / np.sqrt(2), 1.0)  # of W and of s = A / sqrt(2 gamma k)
SHARE_BEYOND_TWO_WIDTHS = erfc(np.sqrt(2))  # of a Gaussian variable, on both sides


def euler_step(x, v, dt, zeta, chain):
    """Return position and velocity after a step: first the velocity changes, then the position."""
    forces = -chain.stiffness * x - chain.damping * v
    v = v + dt / chain.mass * forces + chain.amplitude / chain.mass * np.sqrt(dt) * zeta
    return x + dt * v, v


def damping_and_noise(v, dt, zeta, chain):
    """Return the velocity after damping and noise have acted for the time dt, exactly."""
    c = np.exp(-chain.damping * dt / chain.mass)
    return c * v + chain.free_velocity_width * np.sqrt(1 - c**2) * zeta


def with_other_sign(step):
    """Return a step that uses -zeta instead of zeta, which is equally probable."""
    return lambda *state: step(*state[:-1], -state[-1])
