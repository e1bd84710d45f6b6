"""The theory: exact equilibrium, force balance, hydrodynamics, kinetic equation."""

from crazybilliards.kinetic.exact.breathing import breathing_cloud
from crazybilliards.kinetic.exact.gibbs_measure import equilibrium, equilibrium_states
from crazybilliards.kinetic.fluids.equations import hydrodynamics
from crazybilliards.kinetic.kinetic_equation.criticality import (
    critical_damping,
    critical_restitution,
    critical_size,
)
from crazybilliards.kinetic.kinetic_equation.relaxation import relax_phase_space
from crazybilliards.kinetic.kinetic_equation.stationary import phase_space
from crazybilliards.kinetic.starts import compressed, displaced, two_clumps
from crazybilliards.kinetic.statics.balance import force_balance

__all__ = [
    "breathing_cloud",
    "compressed",
    "critical_damping",
    "critical_restitution",
    "critical_size",
    "displaced",
    "equilibrium",
    "equilibrium_states",
    "force_balance",
    "hydrodynamics",
    "phase_space",
    "relax_phase_space",
    "two_clumps",
]
