"""The theory: exact equilibrium, force balance, hydrodynamics, kinetic equation."""

from crazybilliards.kinetic.breathing_cloud import breathing_cloud
from crazybilliards.kinetic.critical_size import (
    critical_damping,
    critical_restitution,
    critical_size,
)
from crazybilliards.kinetic.equilibrium import equilibrium, equilibrium_states
from crazybilliards.kinetic.force_balance import force_balance
from crazybilliards.kinetic.hydrodynamics import hydrodynamics
from crazybilliards.kinetic.phase_space import phase_space
from crazybilliards.kinetic.phase_space_relaxation import relax_phase_space
from crazybilliards.kinetic.starts import compressed, displaced, two_clumps

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
