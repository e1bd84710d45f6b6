"""Fits that the paper makes to points: growing energies, scaling, exponents, and tails."""

from crazybilliards.reproduction.fits.laws import (
    fit_exponential,
    fit_growth,
    fit_scaling,
    fit_singularity,
)
from crazybilliards.reproduction.fits.tails import fit_avalanches, tail_length

__all__ = [
    "fit_avalanches",
    "fit_exponential",
    "fit_growth",
    "fit_scaling",
    "fit_singularity",
    "tail_length",
]
