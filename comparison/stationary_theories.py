"""The stationary theories: which of them take a chain, how good each is there, and the best one.

A theory is one line of ``THEORIES``. A module is imported when it is first used, so the command
line can list the theories in its ``--help`` without a delay.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.kinetic.accuracy import Accuracy
    from crazybilliards.model import Chain


@dataclass(frozen=True)
class Theory:
    """A theory of a chain's steady state.

    Attributes
    ----------
    name
        The name of the function in ``crazybilliards.kinetic``, e.g. ``"equilibrium"``.
    title
        Its name in tables and legends.
    module
        The module below ``crazybilliards.kinetic`` that has the function and ``check_NAME``.
    seconds
        Computing time on one core, by the chain, within a factor of three.
    """

    name: str
    title: str
    module: str
    seconds: Callable[[Chain], float]

    @property
    def solve(self) -> Callable[..., xr.Dataset]:
        """The function: ``solve(chain, **settings)`` gives a result in the common vocabulary."""
        return self._find(self.name)

    @property
    def check(self) -> Callable[..., Any]:
        """Raise the ValueError that ``solve`` would raise for a wrong argument."""
        return self._find(f"check_{self.name}")

    def accuracy(self, chain: Chain) -> Accuracy:
        """Return the errors that the theory states for a chain that it takes."""
        from crazybilliards.kinetic.accuracy import expected

        return expected(self.name, chain)

    def refusal(self, chain: Chain, settings: Mapping[str, Any] | None = None) -> str:
        """Return why the theory does not take the chain and these settings, or nothing."""
        defaults, given = self._defaults, dict(settings or {})
        if unknown := sorted(set(given) - set(defaults)):
            return f"{unknown[0]}: {self.name} has no such setting"
        try:
            self.check(chain, **(defaults | given))
        except ValueError as error:
            return str(error)
        return ""

    @property
    def _defaults(self) -> dict[str, Any]:
        arguments = inspect.signature(self.solve).parameters.values()
        return {each.name: each.default for each in arguments if each.default is not each.empty}

    def _find(self, name: str) -> Any:
        return getattr(import_module(f"crazybilliards.kinetic.{self.module}"), name)


def _steps(chain: Chain) -> float:
    """Return about how many steps lead from e = 1 to the chain, each with 2.5 times the drag."""
    return 1 + math.log1p(abs(1 - chain.restitution) * chain.size) / math.log(2.5)


THEORIES = {
    theory.name: theory
    for theory in (
        Theory(
            "equilibrium",
            "exact equilibrium",
            "exact.gibbs_measure",
            lambda chain: 1e-3 * chain.size,
        ),
        Theory("force_balance", "force balance", "statics.balance", lambda chain: 0.03),
        Theory(
            "phase_space",
            "kinetic equation",
            "kinetic_equation.stationary",
            lambda chain: 0.4 * _steps(chain),
        ),
        Theory(
            "correlated_phase_space",
            "kinetic equation with pair correlations",
            "correlations.stationary",
            lambda chain: 1.0 * _steps(chain),
        ),
    )
}


def theories(chain: Chain) -> xr.Dataset:
    """List the theories of the steady state: which take a chain, their errors, what they cost.

    Nothing is solved. ``theories(chain).to_dataframe()`` is a table.

    Parameters
    ----------
    chain
        The chain.

    Returns
    -------
    xarray.Dataset
        Over ``theory``, the name of the function: ``takes`` (whether it takes the chain),
        ``reason`` (why not), the errors that its result states, and ``expected_seconds`` on one
        core, within a factor of three. The errors are the largest that simulations of chains like
        this one, or exact solutions, showed: relative ones of W_v (``velocity_width_error`` of the
        particles 3 to L - 2, ``border_error`` of the first and the last) and of W_x
        (``displacement_width_error``), of the mean displacement in thermal lengths
        (``mean_displacement_error``), and of the smoothed density relative to close packing
        (``density_error``). They are NaN where none was measured or the chain is not taken.
        ``attrs["best"]`` is the name of the theory with the smallest error of W_v, or empty if none
        takes the chain. A chain with e > 1 may turn out to have no steady state when a theory is
        solved (see ``critical_size``).

    Examples
    --------
    >>> from crazybilliards import Chain
    >>> table = theories(Chain(size=100, restitution=0.5))
    >>> table.attrs["best"]
    'correlated_phase_space'
    >>> table.takes.values
    array([False, False,  True,  True])
    """
    import numpy as np
    import xarray as xr

    from crazybilliards.kinetic.accuracy import Accuracy

    rows = []
    for theory in THEORIES.values():
        reason = theory.refusal(chain)
        errors = Accuracy() if reason else theory.accuracy(chain)
        seconds = math.nan if reason else theory.seconds(chain)
        rows.append((not reason, reason, *errors, seconds))
    columns = (
        ("takes", "whether the theory takes the chain", ""),
        ("reason", "why not", ""),
        ("velocity_width_error", "expected relative error of W_v", "1"),
        ("border_error", "expected relative error of W_v at the border", "1"),
        ("displacement_width_error", "expected relative error of W_x", "1"),
        ("mean_displacement_error", "expected error of the mean displacement, over s", "1"),
        ("density_error", "expected error of the density, over close packing", "1"),
        ("expected_seconds", "expected computing time", "s"),
    )
    variables = {
        name: ("theory", np.array(values), {"long_name": title, "units": unit})
        for (name, title, unit), values in zip(columns, zip(*rows, strict=True), strict=True)
    }
    best = best_theory(chain) if any(takes for takes, *_ in rows) else None
    return xr.Dataset(variables, {"theory": list(THEORIES)}, {"best": best.name if best else ""})


def best_theory(chain: Chain, settings: Mapping[str, Any] | None = None) -> Theory:
    """Return the theory with the smallest expected error of W_v of those that take the chain.

    An error that was not measured counts as larger than any other. Raises ValueError, with all
    reasons, if no theory takes the chain and the ``settings``.
    """
    refusals = {theory.name: theory.refusal(chain, settings) for theory in THEORIES.values()}
    taking = [theory for theory in THEORIES.values() if not refusals[theory.name]]
    if not taking:
        reasons = "; ".join(f"{name}: {reason}" for name, reason in refusals.items())
        raise ValueError(f"no theory takes this chain: {reasons}")
    return min(taking, key=lambda theory: _or_infinite(theory.accuracy(chain).velocity_width))


def _or_infinite(error: float) -> float:
    return math.inf if math.isnan(error) else error
