from .vanishing_step.limit import simulate_limit as simulate_limit
from .simulation import simulate as simulate
from .start import given_start as given_start
