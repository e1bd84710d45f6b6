"""The fits of the paper, with uncertainties."""

from crazybilliards.comparison.fits.displacement import ArctanhFit, fit_arctanh
from crazybilliards.comparison.fits.growth import (
    GrowthFit,
    SingularityFit,
    fit_growth,
    fit_singularity,
)
from crazybilliards.comparison.fits.profile import PowerLawFit, fit_border_power_law
from crazybilliards.comparison.fits.scaling import (
    ExponentialFit,
    ScalingFit,
    fit_exponential,
    fit_scaling,
)
from crazybilliards.comparison.fits.tails import AvalancheFit, fit_avalanches, tail_length

__all__ = [
    "ArctanhFit",
    "AvalancheFit",
    "ExponentialFit",
    "GrowthFit",
    "PowerLawFit",
    "ScalingFit",
    "SingularityFit",
    "fit_arctanh",
    "fit_avalanches",
    "fit_border_power_law",
    "fit_exponential",
    "fit_growth",
    "fit_scaling",
    "fit_singularity",
    "tail_length",
]
