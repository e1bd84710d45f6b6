"""Simulation and theory side by side: binned densities, fits, deviations, overlays, commands.

The names load when first used, so that the command line can answer ``--help`` at once.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

# A function is never named like its module: importing the module would then hide the function.
if TYPE_CHECKING:
    from crazybilliards.comparison.coverage import coverage_density as coverage_density
    from crazybilliards.comparison.coverage import smooth as smooth
    from crazybilliards.comparison.distances import Deviation as Deviation
    from crazybilliards.comparison.distances import deviation as deviation
    from crazybilliards.comparison.drawing import overlay as overlay
    from crazybilliards.comparison.elastic_chain import compare_elastic as compare_elastic
    from crazybilliards.comparison.fits import ArctanhFit as ArctanhFit
    from crazybilliards.comparison.fits import PowerLawFit as PowerLawFit
    from crazybilliards.comparison.fits import fit_arctanh as fit_arctanh
    from crazybilliards.comparison.fits import fit_border_power_law as fit_border_power_law
    from crazybilliards.comparison.relaxation import compare_relaxation as compare_relaxation
    from crazybilliards.comparison.relaxation_figures import animate as animate
    from crazybilliards.comparison.restitutions import compare_restitutions as compare_restitutions
    from crazybilliards.comparison.restitutions import width_deviations as width_deviations

_HOMES = {
    "animate": "relaxation_figures",
    "ArctanhFit": "fits",
    "Deviation": "distances",
    "PowerLawFit": "fits",
    "compare_elastic": "elastic_chain",
    "compare_relaxation": "relaxation",
    "compare_restitutions": "restitutions",
    "coverage_density": "coverage",
    "deviation": "distances",
    "fit_arctanh": "fits",
    "fit_border_power_law": "fits",
    "overlay": "drawing",
    "smooth": "coverage",
    "width_deviations": "restitutions",
}

__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
