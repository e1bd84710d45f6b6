"""The theory: exact equilibrium at e = 1, the gas-kinetic force balance, hydrodynamics."""

from crazybilliards.kinetic.equilibrium import equilibrium, equilibrium_states
from crazybilliards.kinetic.force_balance import force_balance
from crazybilliards.kinetic.hydrodynamics import hydrodynamics
from crazybilliards.kinetic.starts import compressed, displaced, two_clumps

__all__ = [
    "compressed",
    "displaced",
    "equilibrium",
    "equilibrium_states",
    "force_balance",
    "hydrodynamics",
    "two_clumps",
]
