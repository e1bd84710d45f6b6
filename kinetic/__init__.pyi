from .accuracy import UnmeasuredWarning as UnmeasuredWarning
from .exact.motion import breathing_cloud as breathing_cloud
from .exact.gibbs_measure import (
    equilibrium as equilibrium,
    equilibrium_states as equilibrium_states,
)
from .fluids.equations import hydrodynamics as hydrodynamics
from .gas.criticality import critical_size as critical_size
from .gas.stationary import steady_state as steady_state
from .rods import rod_by_rod as rod_by_rod
from .starts import compressed as compressed, displaced as displaced
from .statics.balance import force_balance as force_balance
