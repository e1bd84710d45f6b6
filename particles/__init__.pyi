from . import observers as observers
from .scales import relaxation_time as relaxation_time
from .simulation import ShortRunWarning as ShortRunWarning, simulate as simulate
from .start import given_start as given_start
