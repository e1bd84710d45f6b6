from .accuracy import UnmeasuredWarning as UnmeasuredWarning
from .gas.steady_state import steady_state as steady_state
from .correlations.stationary import correlated_phase_space as correlated_phase_space
from .exact.breathing import breathing_cloud as breathing_cloud
from .exact.gibbs_measure import (
    equilibrium as equilibrium,
    equilibrium_states as equilibrium_states,
)
from .fluids.equations import hydrodynamics as hydrodynamics
from .kinetic_equation.criticality import critical_size as critical_size
from .kinetic_equation.relaxation import relax_phase_space as relax_phase_space
from .kinetic_equation.stationary import phase_space as phase_space
from .rods.fluids import rod_by_rod as rod_by_rod
from .starts import compressed as compressed, displaced as displaced
from .statics.balance import force_balance as force_balance
