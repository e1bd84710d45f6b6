"""Densities as a simulation would report them, and the order of panels."""

import numpy as np
import xarray as xr


def simulated(x, density, error=1e-4):
    """Return a density over x as a simulation would report it."""
    units = {"units": "1/R", "long_name": "density"}
    return xr.Dataset(
        {"density": ("x", density, units), "density_error": ("x", np.full(x.size, error), units)},
        coords={"x": ("x", x, {"units": "R", "long_name": "position x"})},
        attrs={"source": "simulation"},
    )


def columns_without_numbers(figure):
    """Return the columns of panels whose lowest has no numbers or no name below it."""
    figure.draw_without_rendering()
    lowest = {ax.get_subplotspec().colspan.start: ax for ax in figure.axes if ax.get_title("left")}
    below = {
        column: [each.get_text() for each in ax.get_xticklabels() if each.get_visible()]
        for column, ax in lowest.items()
        if ax.get_xlabel()
    }
    return [column for column in lowest if not any(below.get(column, []))]
