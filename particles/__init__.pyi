from .observers.avalanches import (
    Avalanches as Avalanches,
    TriggeredCollisions as TriggeredCollisions,
)
from .observers.collisions import Collisions as Collisions
from .observers.covariances import Covariances as Covariances
from .observers.density import Density as Density
from .observers.energy import Energy as Energy
from .observers.impacts import Impacts as Impacts
from .observers.modes import Modes as Modes
from .observers.raw import Raw as Raw
from .observers.time_correlations import TimeCorrelations as TimeCorrelations
from .observers.velocities import Velocities as Velocities
from .observers.walls import Walls as Walls
from .observers.widths import Widths as Widths
from .scales import relaxation_time as relaxation_time
from .simulation import ShortRunWarning as ShortRunWarning, simulate as simulate
from .start import given_start as given_start
