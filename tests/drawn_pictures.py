"""Densities as a simulation would report them, and what a picture of one shows."""

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


X = np.arange(-1400, 1401) * 0.1
WAVES = 0.4 + 0.03 * np.cos(2 * np.pi * X / 2.5)
