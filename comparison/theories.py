"""The stationary theories by name: sweeps compute them, the command ``theory`` prints them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import xarray as xr

from crazybilliards.kinetic import equilibrium, force_balance, phase_space
from crazybilliards.kinetic.exact.gibbs_measure import check_equilibrium
from crazybilliards.kinetic.kinetic_equation.stationary import check_phase_space
from crazybilliards.kinetic.statics.balance import check_force_balance


class Theory(NamedTuple):
    """A theory of a chain's steady state.

    Attributes
    ----------
    title
        What it is called in tables and legends.
    solve
        ``solve(chain, **settings)`` gives its result in the common vocabulary.
    check
        ``check(chain, **settings)`` raises the ValueError that ``solve`` would raise for a wrong
        argument, without any work.
    """

    title: str
    solve: Callable[..., xr.Dataset]
    check: Callable[..., Any]


THEORIES = {
    "equilibrium": Theory("exact equilibrium", equilibrium, check_equilibrium),
    "force_balance": Theory("force balance", force_balance, check_force_balance),
    "phase_space": Theory("kinetic equation", phase_space, check_phase_space),
}
