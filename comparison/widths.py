"""Velocity widths in the centre and at the border of a chain, and how far a theory is from them."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from crazybilliards.model import WALLS_AND_MASSES, Chain, chain_of
from crazybilliards.model.arrays import middle_tenth

_LEAST_INNER = 7  # rods from which on the two at each border are left out of the largest deviation


def displacement_unit(chain: Chain) -> tuple[str, float]:
    """Symbol and value [R] of a unit of length: s, without springs half the points' room h."""
    return ("s", chain.thermal_length) if chain.stiffness else ("h", chain.walls[1])


class WidthDeviation(NamedTuple):
    """Relative deviations of velocity widths, theory minus simulation."""

    largest: float  # over the particles 3 to L - 2
    centre: float  # of the middle tenth of the rods
    border: float  # of the first and the last rod
    error: float  # typical standard error of a rod's simulated width
    border_error: float  # that of the border's
    largest_in_errors: float  # over all particles, in standard errors of each


def central_width(run: xr.Dataset, of: str = "velocity_width") -> float:
    """W_v in the centre, or W_x: root mean square over the middle tenth of the rods."""
    return float(np.sqrt((run[of].values[middle_tenth(run.sizes["particle"])] ** 2).mean()))


def border_width(run: xr.Dataset) -> float:
    """W_v of the first and the last rod: root mean square of the two."""
    return float(np.sqrt((run.velocity_width.values[[0, -1]] ** 2).mean()))


def width_deviation(run: xr.Dataset, theory: xr.Dataset) -> WidthDeviation:
    """Compare the velocity widths of a simulation and a theory of the same chain.

    Both ends of a chain have the same averages, if their rods have the same mass. Simulated widths
    are then averaged over a rod and its mirror image, but not for ``largest_in_errors``.
    """
    chain = chain_of(run)
    chain.require_known("the mean over mirror images", WALLS_AND_MASSES)
    size = chain.size
    square = run.velocity_width.values**2
    if chain.mass_ratio == 1 or size % 2:
        square = (square + square[::-1]) / 2
    expected = theory.velocity_width.values**2
    inner = slice(2, size - 2) if size >= _LEAST_INNER else slice(None)

    def relative(part: slice | list[int]) -> float:
        return float(np.sqrt(expected[part].mean() / square[part].mean()) - 1)

    each = np.sqrt(expected / square) - 1
    in_errors = (theory.velocity_width.values - run.velocity_width) / run.velocity_width_error
    relative_error = (run.velocity_width_error / run.velocity_width).values
    return WidthDeviation(
        largest=float(np.abs(each[inner]).max()),
        centre=relative(middle_tenth(size)),
        border=relative([0, -1]),
        error=float(np.median(relative_error)),
        border_error=float(np.hypot(relative_error[0], relative_error[-1]) / 2),
        largest_in_errors=float(np.abs(in_errors).max()),
    )
