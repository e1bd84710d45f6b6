r"""The breathing cloud: the exact solution in time of the linear chain without a gap.

Without a gap every rod has the same anchor in the reduced coordinate. A Gaussian cloud,
rho_y = L Normal(y; Y(t), sigma(t)^2), stays Gaussian, with the flow V = Y' + (sigma'/sigma)(y - Y):

    Y'' = -(k/m) Y - (gamma/m) Y',
    sigma'' = W^2/sigma - (k/m) sigma - (gamma/m) sigma'.

*Isothermal*, W^2 is constant. With an *evolving* temperature W^2 is uniform in space and

    (W^2)' = -2 W^2 sigma'/sigma - (2 gamma/m) W^2 + A^2/m^2.

This is also the exact motion of the rods themselves at restitution 1: relabelled when they collide,
they are independent damped oscillators.
"""

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from crazybilliards.kinetic.exact.gibbs_measure import equilibrium
from crazybilliards.kinetic.requirements import output_times, require_chain
from crazybilliards.model import Array, Chain
from crazybilliards.model.checks import check_real, require_memory
from crazybilliards.model.vocabulary import result


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
