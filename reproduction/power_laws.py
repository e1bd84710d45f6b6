"""The paper's fit of two power laws: its parameters, and how it looks in plots of widths."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from crazybilliards.comparison.distances import distances_in_plot
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.model import chain_of
from crazybilliards.reproduction.claims.verdicts import Estimate, furthest_in_plot
from crazybilliards.reproduction.mirror_images import mirrored


def nu(run: xr.Dataset) -> float:
    """Return the exponent."""
    return fit_border_power_law(run).exponent


def fits_in_plot(runs: Iterable[xr.Dataset]) -> tuple[Estimate, float]:
    """Compare the fits with the widths in a plot of all runs, both axes logarithmic.

    Widths are averaged over mirror images. Returns the distance that decides as a share of the
    plotted range, which ends at the free rod's width, and the largest vertical one in standard
    errors.
    """
    runs = [mirrored(run) for run in runs]
    free = np.log(chain_of(runs[0]).free_velocity_width)
    lowest = np.log(min(float(run.velocity_width.min()) for run in runs))
    longest = np.log(max(run.sizes["particle"] for run in runs))
    deviations, errors, vertical = [], [], 0.0
    for run in runs:
        fit = fit_border_power_law(run)
        i, width = run.particle.values, run.velocity_width.values
        error = run.velocity_width_error.values
        fine = np.geomspace(1, i[-1], 2000)
        off = distances_in_plot(
            np.log(i),
            np.log(width),
            np.log(fine),
            np.log(fit(fine)),
            x_range=(0.0, longest),
            y_range=(lowest, free),
        )
        deviations.append(off)
        errors.append(error / width / (free - lowest))
        vertical = max(vertical, float(np.abs((fit(i) - width) / error).max()))
    return furthest_in_plot(*map(np.concatenate, (deviations, errors))), vertical
