r"""The exact motion of equal elastic rods, which is that of single points.

In the reduced coordinate rods that collide exchange their velocities, as points do that pass
through one another. Relabelled when they collide, they are independent: each moves as if it were
alone, with the springs, the noise and the damping.

**The breathing cloud** of the linear chain without a gap. Every rod has the same anchor in the
reduced coordinate. A Gaussian cloud, rho_y = L Normal(y; Y(t), sigma(t)^2), stays Gaussian, with
the flow V = Y' + (sigma'/sigma)(y - Y):

    Y'' = -(k/m) Y - (gamma/m) Y',
    sigma'' = W^2/sigma - (k/m) sigma - (gamma/m) sigma'.

*Isothermal*, W^2 is constant. With an *evolving* temperature W^2 is uniform in space and

    (W^2)' = -2 W^2 sigma'/sigma - (2 gamma/m) W^2 + A^2/m^2,

which is the exact motion of the rods themselves.

**The gas of points** in a box without springs. A point that starts with a Maxwellian velocity has
moved, without walls, a distance with a Gaussian law of variance M(t). Walls fold this law, so that
every cosine of the density in the room l = X - 2RL decays by itself:

    n(y, t) = sum over q of a_q exp(-k_q^2 M(t)/2) cos(k_q (y + l/2)),      k_q = pi q/l,
    M(t) = 2 (W/G)^2 (G t - 1 + exp(-G t)),      G = gamma/m,

with the cosine coefficients a_q of the start. Points that start independently stay so, and
:func:`crazybilliards.kinetic.rod_by_rod` makes rods of them.
"""

import numpy as np
import xarray as xr
from scipy.fft import dct, idct
from scipy.integrate import solve_ivp

from crazybilliards.kinetic.exact.gibbs_measure import equilibrium
from crazybilliards.kinetic.requirements import output_times, require_chain
from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import check_real, require_memory
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, result

_CELLS = 4096  # of a gas of points, between the walls, and cosines


def breathing_cloud(
    chain: Chain,
    duration: float,
    *,
    every: float | None = None,
    stretch: float = 1.0,
    shift: float = 0.0,
    start_velocity_variance: float | None = None,
    evolving: bool = True,
) -> xr.Dataset:
    """Solve the equations of this module from a stretched and shifted stationary cloud at rest.

    Parameters
    ----------
    chain
        A chain with linear springs, no gap and restitution 1.
    duration
        Time to solve for [t_0].
    every
        Time between outputs [t_0]; None: a hundredth of the duration.
    stretch, shift
        How the stationary cloud is changed: sigma(0) = stretch s, Y(0) = shift [R].
    start_velocity_variance
        W^2 at the start [R^2/t_0^2]; None: the free value.
    evolving
        True: with the temperature equation, exact for the rods. False: isothermal.

    Returns
    -------
    xarray.Dataset
        ``centre``, ``cloud_width`` and ``velocity_variance`` over time, ``mean_displacement``
        over (time, particle): of rods if ``evolving`` (expected order statistics).

    Raises
    ------
    ValueError
        For another chain or a wrong argument, before any work; if the cloud collapses.
    """
    require_chain(chain, "the breathing cloud", elastic=True, linear=True, gapless=True)
    times = output_times(duration, every)
    stretch = check_real("stretch", stretch, positive=True)
    shift = check_real("shift", shift, signed=True)
    free = hot = chain.free_velocity_width**2
    if start_velocity_variance is not None:
        hot = check_real("start_velocity_variance", start_velocity_variance, positive=True)
    require_memory(f"every: {times.size} outputs", 32.0 * times.size * chain.size)
    order_statistics = equilibrium(chain).mean_displacement.values / chain.thermal_length
    # From here on lengths are in s and velocities in W, so that k/m is 1.
    s, W = chain.thermal_length, chain.free_velocity_width
    damping = chain.damping * s / (chain.mass * W)

    def rates(time: float, state: Array) -> list[float]:
        place, speed, width, rate, heat = state
        spreading = heat / width - width - damping * rate
        warming = -2 * heat * rate / width - 2 * damping * (heat - 1) if evolving else 0.0
        return [speed, -place - damping * speed, rate, spreading, warming]

    start = [shift / s, 0.0, stretch, 0.0, hot / free]
    scaled = times * W / s
    solution = solve_ivp(rates, (0, scaled[-1]), start, "DOP853", scaled, rtol=1e-11, atol=1e-12)
    if not solution.success:
        raise ValueError(f"the cloud could not be followed: {solution.message}")
    place, width, heat = s * solution.y[0], s * solution.y[2], free * solution.y[4]
    mean = place[:, np.newaxis] + width[:, np.newaxis] * order_statistics
    return result(
        chain,
        {
            "centre": ("time", place),
            "cloud_width": ("time", width),
            "velocity_variance": ("time", heat),
            "mean_displacement": (("time", "particle"), mean),
        },
        coordinates={"time": times},
        source="theory",
        method={"theory": "breathing cloud", "evolving": str(evolving)},
        end_time=times[-1],
    )


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
