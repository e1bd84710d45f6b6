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

from crazybilliards.kinetic.exact.gibbs_measure import equilibrium
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_real, shown
from crazybilliards.model.memory import require_memory
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
        Output times [T], at least two, ascending from 0.
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

    Raises
    ------
    ValueError
        For another chain or a wrong argument, before any work; if the cloud collapses.
    """
    if chain.gap or chain.spring != "linear" or chain.restitution != 1:
        raise ValueError(
            "the breathing cloud needs linear springs, gap=0 and restitution=1, got "
            f"{chain.spring}, {chain.gap:g}, {chain.restitution:g}"
        )
    chain.require_steady_state()
    times = _check_times(times)
    stretch = check_real("stretch", stretch, positive=True)
    shift = check_real("shift", shift, signed=True)
    free = chain.free_velocity_width**2
    hot = free if variance is None else check_real("variance", variance, positive=True)
    require_memory("times", 32.0 * times.size * chain.size)
    order_statistics = equilibrium(chain).mean_displacement.values / chain.thermal_length
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

    s, W = chain.thermal_length, chain.free_velocity_width
    start = [shift, 0.0, stretch * s, 0.0, hot]
    smallest = 1e-12 * np.array([s, W, s, W, W**2])
    solution = solve_ivp(
        equations, (0.0, times[-1]), start, "DOP853", times, rtol=1e-11, atol=smallest
    )
    if not solution.success:
        raise ValueError(f"the cloud could not be followed: {solution.message}")
    place, _, width, _, heat = solution.y
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


def _check_times(times: ArrayLike) -> Array:
    try:
        checked = np.asarray(times, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"times must be numbers, got {shown(times)}") from error
    if checked.ndim != 1 or checked.size < 2 or checked[0] != 0 or not (np.diff(checked) > 0).all():
        raise ValueError(f"times must ascend from 0, at least two, got {shown(times)}")
    check_real("times", checked[-1], positive=True)
    return checked
