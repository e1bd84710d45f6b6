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
    from crazybilliards.comparison.fits import ArctanhFit as ArctanhFit
    from crazybilliards.comparison.fits import AvalancheFit as AvalancheFit
    from crazybilliards.comparison.fits import ExponentialFit as ExponentialFit
    from crazybilliards.comparison.fits import GrowthFit as GrowthFit
    from crazybilliards.comparison.fits import PowerLawFit as PowerLawFit
    from crazybilliards.comparison.fits import ScalingFit as ScalingFit
    from crazybilliards.comparison.fits import SingularityFit as SingularityFit
    from crazybilliards.comparison.fits import fit_arctanh as fit_arctanh
    from crazybilliards.comparison.fits import fit_avalanches as fit_avalanches
    from crazybilliards.comparison.fits import fit_border_power_law as fit_border_power_law
    from crazybilliards.comparison.fits import fit_exponential as fit_exponential
    from crazybilliards.comparison.fits import fit_growth as fit_growth
    from crazybilliards.comparison.fits import fit_scaling as fit_scaling
    from crazybilliards.comparison.fits import fit_singularity as fit_singularity
    from crazybilliards.comparison.fits import tail_length as tail_length
    from crazybilliards.comparison.studies.animation_page import standalone_page as standalone_page
    from crazybilliards.comparison.studies.elastic_chain import compare_elastic as compare_elastic
    from crazybilliards.comparison.studies.relaxation import (
        compare_relaxation as compare_relaxation,
    )
    from crazybilliards.comparison.studies.relaxation_figures import animate as animate
    from crazybilliards.comparison.studies.restitutions import (
        compare_restitutions as compare_restitutions,
    )
    from crazybilliards.comparison.studies.restitutions import width_deviations as width_deviations
    from crazybilliards.comparison.sweeps import load_sweep as load_sweep

_HOMES = {
    "ArctanhFit": "fits",
    "AvalancheFit": "fits",
    "ExponentialFit": "fits",
    "GrowthFit": "fits",
    "PowerLawFit": "fits",
    "ScalingFit": "fits",
    "SingularityFit": "fits",
    "fit_arctanh": "fits",
    "fit_avalanches": "fits",
    "fit_border_power_law": "fits",
    "fit_exponential": "fits",
    "fit_growth": "fits",
    "fit_scaling": "fits",
    "fit_singularity": "fits",
    "tail_length": "fits",
    "animate": "studies.relaxation_figures",
    "Deviation": "distances",
    "compare_elastic": "studies.elastic_chain",
    "compare_relaxation": "studies.relaxation",
    "compare_restitutions": "studies.restitutions",
    "coverage_density": "coverage",
    "deviation": "distances",
    "load_sweep": "sweeps",
    "overlay": "drawing",
    "smooth": "coverage",
    "standalone_page": "studies.animation_page",
    "width_deviations": "studies.restitutions",
}

__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
