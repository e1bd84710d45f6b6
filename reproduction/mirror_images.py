"""Averages over a rod and its mirror image, where the paper's figure is symmetric.

Both ends of a chain have the same averages, apart from the sign of displacements. The mean of two
independent rods has half the variance of one.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

_SIGNS = {"velocity_width": 1, "displacement_width": 1, "mean_displacement": -1}
# Of the chain: rods closer to their mirror image than this are not taken as independent. It is
# twice the length over which velocities of rods are correlated at e = 0.
_CLOSE = 0.25


def mirrored(run: xr.Dataset) -> xr.Dataset:
    """Return the result with both widths and <dx> averaged over mirror images, with their errors.

    Rods near the centre move with their mirror image: their errors become no smaller.
    """
    size = run.sizes["particle"]
    apart = np.abs(2 * run.particle.values - (size + 1)) > _CLOSE * size
    values = {}
    for name, sign in _SIGNS.items():
        own, error = run[name].values, run[f"{name}_error"].values
        image, image_error = own[::-1], error[::-1]
        mean = np.sqrt((own**2 + image**2) / 2) if sign > 0 else (own - image) / 2
        both = np.where(apart, np.hypot(error, image_error), error + image_error) / 2
        values[name] = run[name].copy(data=mean)
        values[f"{name}_error"] = run[f"{name}_error"].copy(data=both)
    return run.assign(values)
