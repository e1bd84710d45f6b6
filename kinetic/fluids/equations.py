r"""Hydrodynamics: the density rho(x, t) and the flow velocity V(x, t) of the chain in time.

The continuity and the velocity equation of the paper (arXiv:1404.7460, ``eq9`` in its appendix and
``modeleq``, there also ``continuity_helbing``). The paper uses them at rest only. Here they have
the mass m and any spring:

    rho_t + (rho V)_x = 0,
    V_t + V V_x = -(1/rho) (rho W^2/(1 - 2 R rho))_x - F(<dx>)/m - (gamma/m) V,

with the pressure of hard rods and the springs' force at the mean displacement.

**Displacement.** By labels, which the flow carries: N_t + V N_x = 0 and
<dx> = x - (2R + g)(N - L/2); nothing is put in. Or a frozen profile <dx>(x), such as the one that
the paper fits in the steady state.

**Velocity variance.** The paper writes W_v(r, t), has no equation for it, and takes it constant in
the steady state at restitution 1. *Isothermal*: W^2 is the free value at all times. That is right
in the steady state and wrong in a transient at the reference damping, where heat is exchanged more
slowly than the chain moves. *Evolving*: the velocity variance has an equation of its own,

    (W^2)_t + V (W^2)_x = -2 W^2 V_x/(1 - 2 R rho) - (2 gamma/m) (W^2 - A^2/(2 m gamma)),

adiabatic compression of a gas with one degree of freedom plus exchange with the noise, no heat
flux: without gap exact for Gaussian clouds at restitution 1. *Prescribed*: a profile W^2(x) at all
times.

**Boundary conditions.** Nothing outside: the density falls to zero, no rods enter or leave.

Two independent solvers: on labels (:mod:`.label_frame`), and on a grid of positions
(:mod:`.eulerian_frame`).
"""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from crazybilliards.kinetic.fluids.eulerian_frame import solve_on_positions
from crazybilliards.kinetic.fluids.flow_fields import FlowFields
from crazybilliards.kinetic.fluids.label_frame import solve_on_labels
from crazybilliards.kinetic.starts import read_start
from crazybilliards.kinetic.statics.profiles import (
    Prescribed,
    Profile,
    displacement_profile,
    variance_profile,
)
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_choice, check_integer, check_real, shown
from crazybilliards.model.grid import position_grid
from crazybilliards.model.memory import require_memory
from crazybilliards.model.vocabulary import result

Array = NDArray[np.float64]

Frame = Literal["label", "eulerian"]
Temperature = Literal["isothermal", "evolving"]

_OUTPUTS = 100
_MOST_CELLS = 100_000
_BYTES_PER_NODE = 100  # and output: the fields while they are computed, and in the result


def hydrodynamics(
    chain: Chain,
    initial: xr.Dataset,
    duration: float,
    *,
    frame: Frame = "label",
    closure: Literal["label"] | Prescribed = "label",
    temperature: Temperature | Prescribed = "isothermal",
    every: float | None = None,
    cells: int | None = None,
    progress: bool = True,
) -> xr.Dataset:
    """Solve the hydrodynamic equations of this module from a start.

    Parameters
    ----------
    chain
        The chain, any gap, both springs; with restitution 1 unless the temperature is prescribed.
    initial
        The start: a result with ``density`` over x and, if wanted, ``label``, ``flow_velocity``
        and ``velocity_variance``. ``force_balance`` of another chain (a quench), or ``displaced``,
        ``compressed`` and ``two_clumps`` of this one.
    duration
        Time to solve for [T]; 12 relaxation times 2m/gamma come within 1e-5 of the steady state.
    frame
        ``"label"``: exact mass, no grid of positions, milliseconds to a second. ``"eulerian"``:
        the paper's equations on a grid of positions, an independent check.
    closure
        ``"label"``: displacements carried by the flow. Or a frozen <dx>(x), in any form that
        ``force_balance`` takes; in the eulerian frame.
    temperature
        ``"isothermal"`` (wrong in transients) or ``"evolving"``. Or a prescribed
        W^2(x), in any form that ``force_balance`` takes; in the eulerian frame.
    every
        Time between outputs [T]; None: a hundredth of the duration. Each output takes 100 bytes
        for each node of its grid x (21 or more in a rod length) and for each rod.
    cells
        Number of cells; None: chosen from the chain's scales.
    progress
        Show a progress bar, if standard error is a terminal.

    Returns
    -------
    xarray.Dataset
        ``density``, ``flow_velocity``, ``velocity_variance``, ``displacement`` and ``label`` over
        (time, x); ``mean_displacement`` and ``mean_velocity`` over (time, particle); over time
        ``rods`` (their number), ``centre``, ``cloud_width`` and ``unsteadiness``,
        whose last value is ``attrs["residual"]``. ``attrs["status"]`` is ``interrupted`` if Ctrl-C
        ended it: the result then has the times before.

    Raises
    ------
    ValueError
        For a wrong argument or start, before any work; if the equations could not be solved,
        with the reason.

    Examples
    --------
    >>> from crazybilliards.kinetic import displaced
    >>> chain = Chain(size=20)
    >>> flow = hydrodynamics(chain, displaced(chain, 3.0), duration=100, progress=False)
    >>> flow.centre.values[[0, -1]].round(3) + 0.0
    array([3., 0.])
    """
    check_choice("frame", frame, get_args(Frame))
    variance, frozen = _prescribed(chain, temperature, closure)
    if frame == "label" and (variance or frozen):
        raise ValueError("a prescribed closure or temperature needs frame='eulerian'")
    chain.require_steady_state()
    if chain.restitution != 1 and variance is None:
        raise ValueError(
            "hydrodynamics holds for restitution=1 unless temperature is a profile W^2(x), got "
            f"restitution={chain.restitution:g}"
        )
    times = _output_times(duration, every)
    if cells is not None:
        cells = check_integer("cells", cells, least=8)
        if cells > _MOST_CELLS:
            raise ValueError(f"cells must be at most {_MOST_CELLS}, got {cells}")
    start = read_start(chain, initial)
    nodes = position_grid(chain, float(np.abs(start.x).max())).size + chain.size
    require_memory(f"every: {times.size} outputs", _BYTES_PER_NODE * float(nodes) * times.size)
    thermal = isinstance(temperature, str) and temperature == "evolving"
    if frame == "label":
        fields = solve_on_labels(chain, start, times, cells, thermal=thermal, progress=progress)
    else:
        fields = solve_on_positions(
            chain,
            start,
            times,
            cells,
            variance=variance,
            displacement=frozen,
            thermal=thermal,
            progress=progress,
        )
    method = {
        "frame": frame,
        "closure": "prescribed" if frozen else "label",
        "temperature": temperature if isinstance(temperature, str) else "prescribed",
        "cells": fields.cells,
    }
    return _result(chain, fields, times, method)


def _prescribed(
    chain: Chain, temperature: Temperature | Prescribed, closure: str | Prescribed
) -> tuple[Profile | None, Profile | None]:
    """Return the profiles of W^2 and <dx>, None where the equations find them themselves."""
    variance = frozen = None
    if isinstance(temperature, str):
        if temperature not in get_args(Temperature):
            raise ValueError(
                f"temperature must be one of {get_args(Temperature)} or a profile W^2(x), got "
                f"{shown(temperature)}"
            )
    else:
        variance = variance_profile(chain, temperature)
    if isinstance(closure, str):
        if closure != "label":
            raise ValueError(f"closure must be 'label' or a profile <dx>(x), got {shown(closure)}")
    else:
        frozen = displacement_profile(chain, closure)
    return variance, frozen


def _output_times(duration: float, every: float | None) -> Array:
    duration = check_real("duration", duration, positive=True)
    every = duration / _OUTPUTS if every is None else check_real("every", every, positive=True)
    if every > duration * (1 + 1e-9):
        raise ValueError(f"every must be at most the duration {duration:g}, got {every:g}")
    count = np.ceil(duration / every - 1e-9)
    if count > 1e6:
        raise ValueError(f"every = {every:g} asks for {count:.1g} outputs")
    return every * np.arange(count + 1)


def _result(
    chain: Chain, fields: FlowFields, times: Array, method: dict[str, str | int]
) -> xr.Dataset:
    """Put the fields into the common vocabulary, with the sums that tell how good they are."""
    along, particles = ("time", "x"), ("time", "particle")
    reached = len(fields.density)
    interrupted, times = reached < times.size, times[:reached]
    x, label = fields.x, fields.label
    rods = label[:, -1] - label[:, 0]
    reduced = x - 2 * chain.radius * (label - chain.size / 2)
    mean, square = (trapezoid(fields.density * reduced**n, x) / rods for n in (1, 2))
    return result(
        chain,
        {
            "density": (along, fields.density),
            "flow_velocity": (along, fields.velocity),
            "velocity_variance": (along, fields.variance),
            "displacement": (along, reduced - chain.gap * (label - chain.size / 2)),
            "label": (along, label),
            "mean_displacement": (particles, fields.rods - chain.anchors),
            "mean_velocity": (particles, fields.rod_velocities),
            "rods": ("time", rods),
            "centre": ("time", trapezoid(fields.density * x, x) / rods),
            "cloud_width": ("time", np.sqrt(square - mean**2)),
            "unsteadiness": ("time", fields.unsteadiness),
        },
        coordinates={"x": x, "time": times},
        source="theory",
        method={"theory": "hydrodynamics", **method},
        status="interrupted" if interrupted else "completed",
        end_time=times[-1],
        residual=fields.unsteadiness[-1],
    )
