from .simulation import simulate as simulate
from .start import given_start as given_start
