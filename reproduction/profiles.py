"""Profiles along the chain: centre and border, mirror images, the paper's two power laws."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.model import Array, chain_of
from crazybilliards.model.arrays import middle_tenth
from crazybilliards.reproduction.claims.verdicts import EYE, Estimate, furthest_in_plot, in_plot


def central_width(run: xr.Dataset, of: str = "velocity_width") -> float:
    """W_v in the centre, or W_x: root mean square over the middle tenth of the rods."""
    return float(np.sqrt((run[of].values[middle_tenth(run.sizes["particle"])] ** 2).mean()))


def border_width(run: xr.Dataset) -> float:
    """W_v of the first and the last rod: root mean square of the two."""
    return float(np.sqrt((run.velocity_width.values[[0, -1]] ** 2).mean()))


def mirrored(run: xr.Dataset) -> xr.Dataset:
    """Return the result with both widths and <dx> averaged over mirror images, with their errors.

    The mean of two independent rods has half the variance of one. Rods that are less than a quarter
    of the chain from their mirror image, twice the length over which velocities are correlated at
    e = 0, move with it: their errors become no smaller.
    """
    size = run.sizes["particle"]
    apart = np.abs(2 * run.particle.values - (size + 1)) > size / 4
    values = {}
    for name in ("velocity_width", "displacement_width", "mean_displacement"):
        own, error = run[name].values, run[f"{name}_error"].values
        image, image_error = own[::-1], error[::-1]
        mean = np.sqrt((own**2 + image**2) / 2) if "width" in name else (own - image) / 2
        both = np.where(apart, np.hypot(error, image_error), error + image_error) / 2
        values[name] = run[name].copy(data=mean)
        values[f"{name}_error"] = run[f"{name}_error"].copy(data=both)
    return run.assign(values)


def bulge(run: xr.Dataset) -> float:
    """Ln of the border's width over the centre's: positive for a convex profile."""
    return float(np.log(border_width(run) / central_width(run)))


def nu(run: xr.Dataset) -> float:
    """Return the exponent of the two power laws."""
    return fit_border_power_law(run).exponent


def beyond_the_eye(distances: Array, errors: Array) -> Estimate:
    """Return the distance in a plot that decides, as a share of the plotted range, less EYE."""
    return furthest_in_plot(distances, errors).minus(Estimate(EYE, 0.0))


def fits_in_plot(of_what: str, runs: Iterable[xr.Dataset]) -> dict[str, Any]:
    """Return what decides whether two power laws fit the widths in a logarithmic plot of all runs.

    Widths are averaged over mirror images, and the plotted range ends at the free rod's width.
    """
    runs = [mirrored(run) for run in runs]
    free = np.log(chain_of(runs[0]).free_velocity_width)
    lowest = np.log(min(float(run.velocity_width.min()) for run in runs))
    longest = np.log(max(run.sizes["particle"] for run in runs))
    ranges = {"x_range": (0.0, longest), "y_range": (lowest, free)}
    distances, errors, vertical = [], [], 0.0
    for run in runs:
        fit, i = fit_border_power_law(run), run.particle.values
        width, error = run.velocity_width.values, run.velocity_width_error.values
        fine = np.geomspace(1, i[-1], 2000)
        distances.append(distances_in_plot(*map(np.log, (i, width, fine, fit(fine))), **ranges))
        errors.append(error / width / (free - lowest))
        vertical = max(vertical, float(np.abs((fit(i) - width) / error).max()))
    return in_plot(
        f"{of_what}, rods averaged with their mirror images, and their fits, both axes logarithmic",
        furthest_in_plot(np.concatenate(distances), np.concatenate(errors)),
        vertical,
    )
