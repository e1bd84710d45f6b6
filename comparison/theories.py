"""The stationary theories by name: sweeps compute them, the command ``theory`` prints them.

A theory is one line of ``THEORIES``. A module is imported when it is first used, so the command
line can list the theories in its ``--help`` without a delay.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Theory:
    """A theory of a chain's steady state.

    Attributes
    ----------
    name
        The name of the function in ``crazybilliards.kinetic``, e.g. ``"equilibrium"``.
    title
        Its name in tables and legends.
    judged_by
        The quantity whose error the attribute ``model_error`` of its results is.
    module
        The module below ``crazybilliards.kinetic`` that has the function and ``check_NAME``.
    """

    name: str
    title: str
    module: str
    judged_by: str = "W_v of the particles 3 to L-2"

    @property
    def solve(self) -> Callable[..., xr.Dataset]:
        """The function: ``solve(chain, **settings)`` gives a result in the common vocabulary."""
        return self._find(self.name)

    @property
    def check(self) -> Callable[..., Any]:
        """Raise the ValueError that ``solve`` would raise for a wrong argument."""
        return self._find(f"check_{self.name}")

    def _find(self, name: str) -> Any:
        return getattr(import_module(f"crazybilliards.kinetic.{self.module}"), name)


THEORIES = {
    theory.name: theory
    for theory in (
        Theory("equilibrium", "exact equilibrium", "exact.gibbs_measure"),
        Theory(
            "force_balance",
            "force balance",
            "statics.balance",
            "the smoothed density, of close packing",
        ),
        Theory("phase_space", "kinetic equation", "kinetic_equation.stationary"),
        Theory(
            "correlated_phase_space",
            "kinetic equation with pair correlations",
            "correlations.stationary",
        ),
    )
}
