from .combining import combine as combine
from .coverage import coverage_density as coverage_density, smooth as smooth
from .distances import Deviation as Deviation, deviation as deviation
from .drawing import overlay as overlay
from .films import Player as Player, film as film
from .fits import (
    Fit as Fit,
    fit_arctanh as fit_arctanh,
    fit_border_power_law as fit_border_power_law,
)
from .side_by_side.grid import compare as compare
from .side_by_side.relaxation import compare_relaxation as compare_relaxation
from .sweeps import (
    Sweep as Sweep,
    load_sweep as load_sweep,
    process_pool as process_pool,
    run_cases as run_cases,
)
