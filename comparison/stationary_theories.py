"""The theories of the steady state: which one a chain has, and what pictures call them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import xarray as xr

from crazybilliards.kinetic.exact.gibbs_measure import check_equilibrium, equilibrium
from crazybilliards.kinetic.gas.stationary import check_steady_state, steady_state
from crazybilliards.kinetic.statics.balance import check_force_balance, force_balance
from crazybilliards.model import Chain


@dataclass(frozen=True)
class StationaryTheory:
    """A theory of a chain's steady state."""

    title: str  # in tables and legends
    solve: Callable[..., xr.Dataset]  # of a chain and settings, gives a result
    check: Callable[..., Any]  # raises the ValueError that solve would raise for its arguments

    @property
    def name(self) -> str:
        """The name of the function in ``crazybilliards.kinetic``, e.g. "equilibrium"."""
        return self.solve.__name__


THEORIES = {
    theory.name: theory
    for theory in (
        StationaryTheory("exact equilibrium", equilibrium, check_equilibrium),
        StationaryTheory("force balance", force_balance, check_force_balance),
        StationaryTheory("gas", steady_state, check_steady_state),
    )
}
# What pictures call a result.
TITLES = {
    "simulation": "simulation",
    **{name: theory.title for name, theory in THEORIES.items()},
    "force_balance_arctanh": "force balance, arctanh fit",
    "rod_by_rod": "force balance, rod by rod",
}


def theory_of(chain: Chain) -> StationaryTheory:
    """Return the exact equilibrium if no collision of the chain takes energy, otherwise the gas."""
    elastic = chain.restitution == chain.wall_restitution == 1
    return THEORIES["equilibrium" if elastic else "steady_state"]
