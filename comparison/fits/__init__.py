"""Fits along a chain, as the paper makes them, with uncertainties."""

from crazybilliards.comparison.fits.fit import Fit
from crazybilliards.comparison.fits.profile import fit_arctanh, fit_border_power_law

__all__ = ["Fit", "fit_arctanh", "fit_border_power_law"]
