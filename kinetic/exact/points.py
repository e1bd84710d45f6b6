r"""The exact motion of equal elastic rods in a box without springs, which is that of single points.

In the reduced coordinate rods that collide exchange their velocities, as points do that pass
through one another. Each point therefore moves as if it were alone, from wall to wall, with the
noise and the damping. A point that starts with a Maxwellian velocity has moved, without walls, a
distance with a Gaussian law of variance M(t). Walls fold this law, so that every cosine of the
density in the room l = X - 2RL decays by itself:

    n(y, t) = sum over q of a_q exp(-k_q^2 M(t)/2) cos(k_q (y + l/2)),      k_q = pi q/l,
    M(t) = 2 (W/G)^2 (G t - 1 + exp(-G t)),      G = gamma/m,

with the cosine coefficients a_q of the start. Points that start independently stay so, and
:func:`crazybilliards.kinetic.rod_by_rod` makes rods of them.
"""

import numpy as np
import xarray as xr
from scipy.fft import dct, idct

from crazybilliards.kinetic.requirements import output_times
from crazybilliards.model import Array, Chain
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, result

_CELLS = 4096  # between the walls, and cosines


def gas_of_points(chain: Chain, start: xr.Dataset, duration: float, every: float) -> xr.Dataset:
    """Return ``density`` [1/R] and ``label`` over (time, x) by the law of this module.

    ``start`` has a ``label`` over x, and the chain's temperature. Times are in t_0.
    """
    times = output_times(duration, every)
    y = np.linspace(*chain.walls, _CELLS + 1)
    k = np.pi * np.arange(_CELLS) / (y[-1] - y[0])
    # How many points are in each cell: of these numbers, too, every cosine decays by itself.
    held = np.diff(np.interp(y, *points_of(chain, start)))
    x, fields = position_grid(chain), []
    for variance in free_spread(chain, times):
        points = np.maximum(idct(dct(held) * np.exp(-(k**2) * variance / 2)), 0.0)
        label = np.append(0.0, points.cumsum()) * (chain.size / points.sum())
        fields.append(fields_of_points(chain, x, y, label))
    density, labels = np.swapaxes(fields, 0, 1)
    return result(
        chain,
        {"density": (("time", "x"), density), "label": (("time", "x"), labels)},
        coordinates={"x": x, "time": times},
        source="theory",
        method={"theory": "gas of points"},
        end_time=times[-1],
    ).assign_attrs(density_of=OF_FLUID)


def free_spread(chain: Chain, times: Array) -> Array:
    """Return M(t), the variance of the way of a point with a Maxwellian velocity [R^2]."""
    W, G = chain.free_velocity_width, chain.damping / chain.mass
    return np.asarray(2 * (W / G) ** 2 * (G * times + np.expm1(-G * times)))


def fields_of_points(chain: Chain, x: Array, y: Array, label: Array) -> tuple[Array, Array]:
    """Return density and label over x of points, whose labels are known at y from wall to wall."""
    R, n = chain.radius, np.diff(label) / np.diff(y)
    at = y + 2 * R * (label - chain.size / 2)
    density = np.interp(x, (at[1:] + at[:-1]) / 2, n / (1 + 2 * R * n))
    return np.where(np.abs(x) <= chain.box / 2, density, 0.0), np.interp(x, at, label)


def points_of(chain: Chain, start: xr.Dataset) -> tuple[Array, Array]:
    """Return where the points of a start in a box are, and the labels there: the inverse."""
    label = start.label.values
    y = start.x.values - 2 * chain.radius * (label - chain.size / 2)
    return np.clip(y, *chain.walls), label
