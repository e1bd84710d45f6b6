"""The theory: exact equilibrium at e = 1 and the gas-kinetic force balance."""

from crazybilliards.kinetic.equilibrium import equilibrium, equilibrium_states
from crazybilliards.kinetic.force_balance import force_balance

__all__ = ["equilibrium", "equilibrium_states", "force_balance"]
