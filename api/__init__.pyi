from crazybilliards.comparison import *
from crazybilliards.kinetic import *
from crazybilliards.model import *
from crazybilliards.particles import *

__version__: str
