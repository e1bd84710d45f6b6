from .combining import combine as combine
from .coverage import coverage_density as coverage_density, smooth as smooth
from .distances import Deviation as Deviation, deviation as deviation
from .drawing import overlay as overlay
from .encoding import Player as Player
from .rod_film import film as film
from .fits import (
    Fit as Fit,
    fit_arctanh as fit_arctanh,
    fit_avalanches as fit_avalanches,
    fit_border_power_law as fit_border_power_law,
    fit_exponential as fit_exponential,
    fit_growth as fit_growth,
    fit_scaling as fit_scaling,
    fit_singularity as fit_singularity,
    tail_length as tail_length,
)
from .side_by_side.animation_page import standalone_page as standalone_page
from .side_by_side.grid import (
    compare_elastic as compare_elastic,
    compare_restitutions as compare_restitutions,
)
from .side_by_side.grid_deviations import width_deviations as width_deviations
from .side_by_side.relaxation import compare_relaxation as compare_relaxation
from .side_by_side.relaxation_figures import animate as animate
from .stationary_theories import best_theory as best_theory, theories as theories
from .sweeps import (
    Sweep as Sweep,
    load_sweep as load_sweep,
    process_pool as process_pool,
    run_cases as run_cases,
)
