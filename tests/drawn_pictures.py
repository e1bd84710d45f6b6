"""Densities as a simulation would report them, and what pictures of them and of others show."""

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


def drawn(ax):
    """Return the symbols' places, the lined nodes' places, and how far the picture is off."""
    symbols = [each.lines[0].get_xydata() for each in ax.containers]
    lines = [line.get_xydata() for line in ax.lines if line.get_linestyle() != "None"]
    lines = [line[np.isfinite(line[:, 1])] for line in lines]
    empty = np.empty((0, 2))
    points = np.concatenate([empty, *symbols, *lines])
    points = points[points[:, 0].argsort()]
    return (
        np.concatenate([empty, *symbols])[:, 0],
        np.concatenate([empty, *lines])[:, 0],
        lambda x: np.interp(x, *points.T),
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


def share_of_the_axis(ax, values):
    """Return how much of the height of a picture these values take."""
    low, high = ax.get_ylim()
    return np.ptp(values) / (high - low)


X = np.arange(-1400, 1401) * 0.1
WAVES = 0.4 + 0.03 * np.cos(2 * np.pi * X / 2.5)
