"""The simulation: collision operators, time stepping, observers, and :func:`simulate`."""

from crazybilliards.particles.simulation import simulate

__all__ = ["simulate"]
