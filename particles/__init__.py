"""The simulation: collision operators, time stepping, observers, and :func:`simulate`."""

from crazybilliards.particles.simulation import simulate
from crazybilliards.particles.start import given_start

__all__ = ["given_start", "simulate"]
