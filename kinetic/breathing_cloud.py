r"""The breathing cloud: the exact solution in time of the linear chain without gap.

Without gap every rod has the same anchor in the reduced coordinate. A Gaussian cloud,
rho_y = L Normal(y; Y(t), sigma(t)^2), stays Gaussian, with the flow V = Y' + (sigma'/sigma)(y - Y):

    Y'' = -(k/m) Y - (gamma/m) Y',
    sigma'' = W^2/sigma - (k/m) sigma - (gamma/m) sigma'.

*Isothermal* fluid: W^2 is constant. *Evolving* temperature, W^2 uniform in space,

    (W^2)' = -2 W^2 sigma'/sigma - (2 gamma/m) W^2 + A^2/m^2:

then this is also the exact motion of the rods themselves at restitution 1, which, relabelled, are
independent damped oscillators (their covariance obeys the same equations).
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

from crazybilliards.kinetic.equilibrium import equilibrium
from crazybilliards.model import Chain
from crazybilliards.model.vocabulary import result

Array = NDArray[np.float64]


def breathing_cloud(
    chain: Chain,
    times: ArrayLike,
    *,
    stretch: float = 1.0,
    shift: float = 0.0,
    variance: float | None = None,
    evolving: bool = True,
) -> xr.Dataset:
    """Solve the equations of this module from a stationary cloud, stretched and shifted, at rest.

    Parameters
    ----------
    chain
        A chain with linear springs, no gap and restitution 1.
    times
        Output times [T], ascending from 0.
    stretch, shift
        Of the stationary cloud at the start: sigma(0) = stretch s, Y(0) = shift [R].
    variance
        W^2 at the start [R^2/T^2]; None: the free value.
    evolving
        With the temperature equation (exact for the rods) or isothermal.

    Returns
    -------
    xarray.Dataset
        ``centre``, ``cloud_width`` and ``velocity_variance`` over time, ``mean_displacement``
        over (time, particle): of rods if ``evolving`` (expected order statistics).
    """
    if chain.gap or chain.spring != "linear" or chain.restitution != 1:
        raise ValueError(
            "the breathing cloud needs linear springs, gap=0 and restitution=1, got "
            f"{chain.spring}, {chain.gap:g}, {chain.restitution:g}"
        )
    chain.require_steady_state()
    free = chain.free_velocity_width**2
    damping, pull = chain.damping / chain.mass, chain.stiffness / chain.mass

    def equations(time: float, state: Array) -> list[float]:
        place, speed, width, rate, heat = state
        warming = -2 * heat * rate / width - 2 * damping * (heat - free) if evolving else 0.0
        return [
            speed,
            -pull * place - damping * speed,
            rate,
            heat / width - pull * width - damping * rate,
            warming,
        ]

    times = np.asarray(times, dtype=float)
    start = [
        shift,
        0.0,
        stretch * chain.thermal_length,
        0.0,
        free if variance is None else variance,
    ]
    solution = solve_ivp(
        equations, (0.0, times[-1]), start, "DOP853", times, rtol=1e-11, atol=1e-12
    )
    place, _, width, _, heat = solution.y
    order_statistics = equilibrium(chain).mean_displacement.values / chain.thermal_length
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
