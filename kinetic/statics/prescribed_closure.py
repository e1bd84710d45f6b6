"""The force balance with a prescribed displacement <dx>(x) and a prescribed W^2(x).

In the log pressure P = ln(w rho_y s/L), w = W^2(x)/W^2, with lengths in thermal lengths s of the
free chain and B = 2 R L/s, equation (***) of :mod:`crazybilliards.kinetic.statics.balance` reads

    P' = -(F(<dx>) s/T) / (w + B exp(P)),      n = (N/L)' = exp(P) / (w + B exp(P)),

without a derivative of w. It is integrated outward from x = 0 to both sides with
``scipy.integrate.solve_ivp``. A root finder determines P(0) so that there are L rods in all. (With
w = 1 there is a closed form, :mod:`crazybilliards.kinetic.statics.wright_closure`.)
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, elementwise

from crazybilliards.kinetic.statics.label_closure import fluid_reach
from crazybilliards.kinetic.statics.profiles import Profile
from crazybilliards.model import Chain
from crazybilliards.model.grid import position_grid
from crazybilliards.model.vocabulary import result

Array = NDArray[np.float64]
Warmth = Callable[[float | Array], Array]

_TAIL = 40.0  # both sides are followed until the pressure has fallen by exp(-40)
_WIDEST = 60.0  # ln rho_y(0) is sought this far from its guess


def solve_prescribed_closure(chain: Chain, profile: Profile, variance: Profile) -> xr.Dataset:
    """Solve the force balance for a given <dx>(x), and W^2(x); see ``force_balance``."""
    free = chain.free_velocity_width**2

    def warmth(x: float | Array) -> Array:
        return np.asarray(variance.function(x)) / free

    def excess(log_pressure: float) -> float:
        sides = [_integrate(chain, profile, warmth, log_pressure, side) for side in (-1, 1)]
        return sum(solution.y[1, -1] for solution in sides) - 1

    # A chain without gap has rho_y = L/s at its centre, one with a wide gap 1/g.
    lam = chain.lattice_gap * chain.size / chain.thermal_length
    guess = -np.log(max(1.0, lam))
    bracket: Any = elementwise.bracket_root(
        np.vectorize(excess), guess, xmin=guess - _WIDEST, xmax=guess + _WIDEST
    )
    if not bracket.success:
        raise ValueError("displacement: no density of this profile adds up to the chain's rods")
    low, high = (float(end) for end in bracket.bracket)
    centre = brentq(excess, low, high, xtol=1e-13, rtol=1e-13)
    return _assemble(chain, profile, warmth, centre)


def _integrate(
    chain: Chain, profile: Profile, warmth: Warmth, log_pressure: float, side: int
) -> Any:
    """Integrate (P, share of the rods passed) from 0 outward over |x|/s; side -1 or +1.

    It ends in the far tail, at the end of the profile, or when it has counted too many rods.
    """
    s = chain.thermal_length
    crowd = 2 * chain.radius * chain.size / s

    def equations(distance: float, state: Array) -> list[float]:
        x = side * s * distance
        pressure = np.exp(min(state[0], 700.0))
        room = float(warmth(x)) + crowd * pressure
        with np.errstate(all="ignore"):
            force = float(side * chain.force(profile.function(x)))
        if not np.isfinite(force):
            raise ValueError(
                f"displacement is not finite at x = {x:g}; an attribute `support` "
                "can tell the interval on which it is"
            )
        return [-force * s / chain.temperature / room, pressure / room]

    def in_the_tail(distance: float, state: Array) -> float:
        return state[0] - log_pressure + _TAIL

    def too_many(distance: float, state: Array) -> float:
        return state[1] - 2.0

    in_the_tail.terminal = too_many.terminal = True  # type: ignore[attr-defined]
    edge = profile.right if side > 0 else -profile.left
    # A profile that holds the rods together keeps them within ten times their extent at rest.
    farthest = 10 * float(position_grid(chain)[-1])
    # Stop just inside: an arctanh is infinite at its end, although its integral is finite.
    solution = solve_ivp(
        equations,
        (0.0, min(edge * (1 - 1e-12), farthest) / s),
        [log_pressure, 0.0],
        method="LSODA",
        rtol=1e-9,
        atol=1e-9,
        events=[in_the_tail, too_many],
        dense_output=True,
    )
    if not solution.success:
        raise ValueError(f"the force balance could not be solved: {solution.message}")
    return solution


def _assemble(chain: Chain, profile: Profile, warmth: Warmth, centre: float) -> xr.Dataset:
    """Put both sides onto the position grid."""
    solutions = {side: _integrate(chain, profile, warmth, centre, side) for side in (-1, 1)}
    s, L = chain.thermal_length, chain.size
    farthest = s * max(solution.t[-1] for solution in solutions.values())
    x = position_grid(chain, max(farthest - float(chain.anchors[-1]), fluid_reach(chain)))
    density, label, displacement = np.zeros((3, x.size))
    passed = {}
    for side, solution in solutions.items():
        end = s * solution.t[-1]
        if solution.status == 0 and profile.left < side * end * 1.01 < profile.right:
            raise ValueError(f"displacement does not hold the rods together at x = {side * end:g}")
        passed[side] = L * solution.y[1, -1]
        here = np.flatnonzero((side * x >= 0) & (side * x <= end))
        log_pressure, share = solution.sol(side * x[here] / s)
        reduced = L / s * np.exp(log_pressure) / warmth(x[here])
        density[here] = reduced / (1 + 2 * chain.radius * reduced)
        label[here] = side * L * share
        label[side * x > end] = side * passed[side]
        displacement[here] = profile.function(x[here])
    return result(
        chain,
        {
            "density": ("x", density),
            "label": ("x", label + passed[-1]),
            "displacement": ("x", displacement),
        },
        coordinates={"x": x},
        source="theory",
        method={"theory": "force balance, prescribed displacement and velocity variance"},
        residual=abs(passed[-1] + passed[1] - chain.size) / chain.size,
    )
