"""Answers to the tasks of lesson 1, One noisy oscillator."""

import numpy as np


def euler_step(x, v, dt, zeta, chain):
    """Return position and velocity after a step: first the velocity changes, then the position."""
    forces = -chain.stiffness * x - chain.damping * v
    v = v + dt / chain.mass * forces + chain.amplitude / chain.mass * np.sqrt(dt) * zeta
    return x + dt * v, v


def friction_and_noise(v, dt, zeta, chain):
    """Return the velocity after friction and noise have acted for the time dt, exactly."""
    c = np.exp(-chain.damping * dt / chain.mass)
    return c * v + chain.free_velocity_width * np.sqrt(1 - c**2) * zeta


def with_other_sign(step):
    """Return a step that uses -zeta instead of zeta, which is equally probable."""
    return lambda *state: step(*state[:-1], -state[-1])
