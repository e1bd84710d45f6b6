from .arrays import Array as Array
from .chain import Chain as Chain
from .parameters import WALLS_AND_MASSES as WALLS_AND_MASSES
from .storage import load as load, save as save
from .vocabulary import chain_of as chain_of
from .warn import DivergedError as DivergedError, DivergedWarning as DivergedWarning
