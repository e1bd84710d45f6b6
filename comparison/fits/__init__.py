"""The fits of the paper, with uncertainties."""

from crazybilliards.comparison.fits.fit import Fit
from crazybilliards.comparison.fits.laws import (
    fit_exponential,
    fit_growth,
    fit_scaling,
    fit_singularity,
)
from crazybilliards.comparison.fits.profile import fit_arctanh, fit_border_power_law
from crazybilliards.comparison.fits.tails import fit_avalanches, tail_length

__all__ = [
    "Fit",
    "fit_arctanh",
    "fit_avalanches",
    "fit_border_power_law",
    "fit_exponential",
    "fit_growth",
    "fit_scaling",
    "fit_singularity",
    "tail_length",
]
