from . import comparison as comparison, kinetic as kinetic, model as model, particles as particles
from .comparison import (
    Sweep as Sweep,
    combine as combine,
    compare as compare,
    compare_relaxation as compare_relaxation,
    coverage_density as coverage_density,
    deviation as deviation,
    film as film,
    load_sweep as load_sweep,
    overlay as overlay,
    process_pool as process_pool,
    run_cases as run_cases,
    smooth as smooth,
)
from .kinetic import (
    breathing_cloud as breathing_cloud,
    compressed as compressed,
    critical_size as critical_size,
    displaced as displaced,
    equilibrium as equilibrium,
    equilibrium_states as equilibrium_states,
    force_balance as force_balance,
    hydrodynamics as hydrodynamics,
    rod_by_rod as rod_by_rod,
    steady_state as steady_state,
)
from .model import Chain as Chain, chain_of as chain_of, load as load, save as save
from .particles import (
    given_start as given_start,
    observers as observers,
    relaxation_time as relaxation_time,
    simulate as simulate,
)

__version__: str
