r"""Hydrodynamics: the density rho(x, t) and the flow velocity V(x, t) of the chain in time.

These are the continuity and the velocity equation of the paper (arXiv:1404.7460, ``eq9`` in its
appendix and ``modeleq``), which uses them for V = 0 only. Here they have the mass m and any spring:

    rho_t + (rho V)_x = 0,
    V_t + V V_x = -(1/rho) (rho W^2/(1 - 2 R rho))_x - F(<dx>)/m - (gamma/m) V,

with the pressure of hard rods and the springs' force at the mean displacement, which for a
non-linear spring is an approximation of the mean force.

**Displacement.** By labels, which the flow carries along, N_t + V N_x = 0, and then
<dx> = x - (2R + g)(N - L/2) without an input. Or a frozen profile <dx>(x), such as the one that the
paper fits in the steady state.

**Velocity variance.** The paper has no equation for it, and takes it as constant in the steady
state at restitution 1. *Isothermal*: W^2 is the free value at all times. This is wrong in a
transient at the reference damping, where heat is exchanged more slowly than the chain moves.
*Evolving*: W^2 and the third moment q = <(v - V)^3> have their own equations. In the reduced
coordinate, with D = d/dt + V d/dx, d/dy = (1 - 2 R rho)^-1 d/dx, n = rho/(1 - 2 R rho),

    D W^2 = -2 W^2 V_y - (n q)_y/n - 2 Gamma_T (W^2 - A^2/(2 m gamma)) - a zeta n W^3,
    D q   = -3 W^2 (W^2)_y - 3 q V_y - (3 Gamma_T + a c n W) q.

The first terms are the adiabatic compression of a gas with one degree of freedom, closed by the
fourth moment of a Gaussian, <(v - V)^4> = 3 W^4. The noise exchanges heat at the rate
Gamma_T = gamma/m. What collisions take from the heat, zeta, and from the third moment, c, are
``energy`` and ``decay`` of :mod:`crazybilliards.kinetic.gas.collision_moments`. A rod meets the
L - 1 others only, a = 1 - 1/L. Without a gap and at restitution 1 this is exact for Gaussian
clouds, in which q = 0. *Prescribed*: a number, or a profile W^2(x), at all times.

**Limits of the closure.** q cannot follow a gradient that is shorter than the flight of a rod. Its
decay has one more term, |(W^2)_y|/W, and where |q| > W^3 the flux is n W^3. The solution ends with
an error where more than half of the rods carry such a flux, or where the fluid collapses. Rods are
independent of one another here: at e < 1 the energy is therefore too small, by up to 6 % where
L (1 - e) = 10, and with a gap, whose anchors hold the rods apart, by up to 14 %.

**Two masses.** The fluid has their mean m, and W^2 = T/m. Flow and heat relax at different rates,
gamma/m and Gamma_T = gamma <1/m>, because light rods exchange more heat with the noise. At
restitution 1 collisions of unequal rods damp q. Other restitutions are refused.

**Boundary conditions.** The density falls to zero outside, and no rods enter or leave. In a box
V = q = 0 at x = -X/2 and X/2. Walls are elastic.

Two independent solvers step the equations with py-pde: on labels (:mod:`.label_frame`, the default)
and on a grid of positions (:mod:`.eulerian_frame`), which is for restitution 1 and has q = 0.
"""

from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from scipy.integrate import trapezoid

from crazybilliards.kinetic.fluids.eulerian_frame import MOST_CELLS, solve_on_positions
from crazybilliards.kinetic.fluids.label_frame import exchange_of, solve_on_labels
from crazybilliards.kinetic.fluids.pde_solver import FlowFields
from crazybilliards.kinetic.fluids.stated_errors import errors_to_state
from crazybilliards.kinetic.requirements import output_times, require_chain
from crazybilliards.kinetic.starts import check_start, read_start
from crazybilliards.kinetic.statics.profiles import (
    Prescribed,
    Profile,
    read_displacement,
    read_velocity_variance,
)
from crazybilliards.model import WALLS_AND_MASSES, Array, Chain
from crazybilliards.model.checks import check_choice, check_integer, require_memory, shown
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import OF_FLUID, require, result

Frame = Literal["label", "eulerian"]
Evolving = Literal["evolving"]

_BYTES_PER_NODE = 100  # and output: the fields while they are computed, and in the result


def hydrodynamics(
    chain: Chain,
    start: xr.Dataset | None = None,
    duration: float | None = None,
    *,
    displacement: Prescribed | None = None,
    velocity_variance: Evolving | float | Prescribed | None = None,
    frame: Frame = "label",
    every: float | None = None,
    cells: int | None = None,
    progress: bool = True,
) -> xr.Dataset:
    """Solve the hydrodynamic equations of this module from a start.

    Parameters
    ----------
    chain
        The chain. Its restitution must be 1 unless ``velocity_variance`` is a number, a profile
        or, in the label frame, ``"evolving"``.
    start
        A result with ``density`` over x and optionally ``label``, ``flow_velocity`` and
        ``velocity_variance``, such as ``force_balance`` of another chain (a quench), or
        ``displaced`` and ``compressed`` of this one.
    duration
        Time to solve for [t_0]; 12 relaxation times 2m/gamma come within 1e-5 of the steady state.
    displacement
        None: by labels, which the flow carries along. Or, in the eulerian frame, a frozen <dx>(x)
        [R], in any form that ``force_balance`` takes.
    velocity_variance
        None: isothermal at the free W^2 (wrong in transients). ``"evolving"``: with the equations
        of temperature and, in the label frame, heat flux. Or a prescribed W^2 [R^2/t_0^2] in any
        form that ``force_balance`` takes: a number, or in the eulerian frame a profile W^2(x).
    frame
        ``"label"``: conserves the number of rods exactly, and takes milliseconds to a second.
        ``"eulerian"``: the paper's equations on a grid of positions, without heat flux, as an
        independent check. It refuses rods that the springs make too fast for its cells. Starts
        with a vacuum at a wall are refused by the other frame if the temperature evolves.
    every
        Time between outputs [t_0]; None: a hundredth of the duration. Each output takes 100 bytes
        for each node of its grid x (21 or more in a rod length) and for each rod.
    cells
        Number of cells; None: chosen from the chain's scales. In the eulerian frame a cell may be
        at most half a thermal length wide, which gives errors of up to 3 % of this length in
        positions, and is a tenth of it by default. Both are less if the rods, or the waves of a
        steep start, are short against the thermal length.
    progress
        Show a progress bar, on a terminal or in a notebook, elsewhere a line every half minute.

    Returns
    -------
    xarray.Dataset
        ``density``, ``flow_velocity``, ``velocity_variance``, ``displacement`` and ``label`` over
        (time, x); ``mean_displacement`` and ``mean_velocity`` over (time, particle); over time
        ``rods`` (their number), ``centre``, ``cloud_width``, ``kinetic_energy`` of flow and heat of
        all rods, and ``unsteadiness``, whose last value is ``attrs["residual"]``. With a heat flux
        ``heat_flux``, (m/2) n q, over (time, x).

        With an evolving temperature ``attrs["kinetic_energy_model_error"]`` is the relative error
        of ``kinetic_energy`` at any time. It was measured for 20 to 100 rods, gaps of up to a
        thermal length s, quadratic springs without a gap, L (1 - e) from -1 to 10,
        gamma s/(m W) from 0.3 to 1.5, and the equilibrium at e = 1 stretched by 0.8 to 1.3 or moved
        by up to 2 s. It is 0 where Gaussian clouds are exact, and NaN for others, at e != 1 with
        an ``UnmeasuredWarning``. For equal elastic rods without springs in a box,
        ``attrs["wave_model_error"]`` is the largest error of the slowest wave of density, in units
        of its first height. For these, and on linear springs without a gap,
        ``attrs["label_model_error"]`` is the largest error of ``label``, over the number of rods,
        at 20 of the times, for others NaN. A warning says if it is above 0.15, as where two streams
        meet, which a fluid does not let through each other.

        ``attrs["status"]`` is ``diverged`` if flow and heat have a thousand times the energy of the
        start, and ``interrupted`` after Ctrl-C. The result then has the times before.

    Raises
    ------
    ValueError
        For a missing or wrong argument or start, before any work; if the equations could not be
        solved, with the reason and, in the label frame, the time.

    Examples
    --------
    >>> from crazybilliards.kinetic import displaced
    >>> chain = Chain(size=20)
    >>> flow = hydrodynamics(chain, displaced(chain, 3.0), duration=100, progress=False)
    >>> flow.centre.values[[0, -1]].round(3) + 0.0
    array([3., 0.])
    """
    start = check_start(start)
    check_choice("frame", frame, get_args(Frame))
    chain, frozen, variance, kind = _read_closure(chain, displacement, velocity_variance, frame)
    if frame == "label" and (variance or frozen):
        raise ValueError(
            "a profile of displacement or velocity_variance needs frame='eulerian'; a number as "
            "velocity_variance does not"
        )
    times = output_times(duration, every)
    if cells is not None:
        cells = check_integer("cells", cells, least=8)
        if cells > MOST_CELLS:
            raise ValueError(f"cells must be at most {MOST_CELLS}, got {shown(cells)}")
    initial = read_start(chain, start)
    nodes = position_grid(chain, float(np.abs(initial.x).max())).size + chain.size
    require_memory(f"every: {times.size} outputs", _BYTES_PER_NODE * float(nodes) * times.size)
    fluid, exchange = chain.replace(mass=chain.mean_mass, mass_ratio=1.0), exchange_of(chain)
    how: Any = {"thermal": kind == "evolving", "progress": progress}
    if frame == "label":
        fields = solve_on_labels(fluid, initial, times, cells, exchange=exchange, **how)
    else:
        how |= {"variance": variance, "displacement": frozen, "exchange": exchange.noise}
        fields = solve_on_positions(fluid, initial, times, cells, **how)
    method = {
        "frame": frame,
        "displacement": "prescribed" if frozen else "by labels",
        "velocity_variance": kind,
        "cells": fields.cells,
    }
    errors = errors_to_state(chain, initial, fields, times, thermal=kind == "evolving")
    found = _result(chain, fields, times, method).assign_attrs(errors)
    require(found, (), "hydrodynamics")
    return found


def _read_closure(
    chain: Chain,
    displacement: Prescribed | None,
    velocity_variance: Evolving | float | Prescribed | None,
    frame: Frame,
) -> tuple[Chain, Profile | None, Profile | None, str]:
    """Return the chain (of a number W^2: the elastic one), <dx>(x), W^2(x), and the kind of W^2."""
    frozen = read_displacement(chain, displacement)
    variance, kind = None, "isothermal"
    if isinstance(velocity_variance, str):
        if velocity_variance != "evolving":
            raise ValueError(
                "velocity_variance must be None, 'evolving', a number or a profile W^2(x), got "
                f"{shown(velocity_variance)}"
            )
        kind = "evolving"
    elif velocity_variance is not None:
        chain, variance = read_velocity_variance(chain, velocity_variance)
        kind = "prescribed"
    any_restitution = kind == "prescribed" or (kind == "evolving" and frame == "label")
    require_chain(
        chain,
        "hydrodynamics",
        elastic=not any_restitution,
        elastic_walls=kind == "evolving",
        knows=WALLS_AND_MASSES,
        remedy="; velocity_variance='evolving' in frame='label' takes others, and a number or a "
        "profile prescribes their temperature",
    )
    if kind == "evolving" and chain.mass_ratio != 1 != chain.restitution:
        raise ValueError(
            "hydrodynamics does not know the heat of rods of two masses in inelastic collisions: "
            f"mass_ratio or restitution must be 1, got {chain.mass_ratio:g} and "
            f"{chain.restitution:g}"
        )
    return chain, frozen, variance, kind


def _result(chain: Chain, fields: FlowFields, times: Array, method: dict[str, Any]) -> xr.Dataset:
    """Put the fields into the common vocabulary, with sums that show their accuracy."""
    along, particles = ("time", "x"), ("time", "particle")
    reached = len(fields.density)
    status = "completed" if reached == times.size else "interrupted"
    status, times = "diverged" if fields.diverged else status, times[:reached]
    x, label, flux = fields.x, fields.label, fields.heat_flux
    rods = label[:, -1] - label[:, 0]
    reduced = x - 2 * chain.radius * (label - chain.size / 2)
    mean = trapezoid(fields.density * reduced, x) / rods
    square = trapezoid(fields.density * (reduced - mean[:, None]) ** 2, x) / rods
    return result(
        chain,
        {
            "density": (along, fields.density),
            "flow_velocity": (along, fields.velocity),
            "velocity_variance": (along, fields.variance),
            "displacement": (along, reduced - chain.lattice_gap * (label - chain.size / 2)),
            "label": (along, label),
            "mean_displacement": (particles, fields.rods - chain.anchors),
            "mean_velocity": (particles, fields.rod_velocities),
            "rods": ("time", rods),
            "centre": ("time", trapezoid(fields.density * x, x) / rods),
            "cloud_width": ("time", np.sqrt(square)),
            "kinetic_energy": ("time", chain.size * chain.mean_mass / 2 * fields.energy),
            "unsteadiness": ("time", fields.unsteadiness),
            **({} if flux is None else {"heat_flux": (along, chain.mean_mass * flux)}),
        },
        coordinates={"x": x, "time": times},
        source="theory",
        method={"theory": "hydrodynamics", **method},
        status=status,
        end_time=times[-1],
        residual=fields.unsteadiness[-1],
    ).assign_attrs(density_of=OF_FLUID)
