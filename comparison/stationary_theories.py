"""The stationary theories: which of them take a chain, how good each is there, and the best one.

A theory is one line of ``THEORIES``.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from crazybilliards.kinetic.accuracy import Accuracy, expected, expected_seconds
from crazybilliards.kinetic.correlations.stationary import (
    check_correlated_phase_space,
    correlated_phase_space,
)
from crazybilliards.kinetic.exact.gibbs_measure import check_equilibrium, equilibrium
from crazybilliards.kinetic.kinetic_equation.stationary import check_phase_space, phase_space
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

    def accuracy(self, chain: Chain) -> Accuracy:
        """Return the errors that the theory states for a chain that it takes."""
        return expected(self.name, chain)

    def refusal(self, chain: Chain) -> str:
        """Return why the theory does not take the chain, or nothing."""
        arguments = inspect.signature(self.solve).parameters.values()
        defaults = {argument.name: argument.default for argument in arguments}
        try:
            self.check(**(defaults | {"chain": chain}))
        except ValueError as error:
            return str(error)
        return ""


THEORIES = {
    theory.name: theory
    for theory in (
        StationaryTheory("exact equilibrium", equilibrium, check_equilibrium),
        StationaryTheory("force balance", force_balance, check_force_balance),
        StationaryTheory("kinetic equation", phase_space, check_phase_space),
        StationaryTheory(
            "kinetic equation with pair correlations",
            correlated_phase_space,
            check_correlated_phase_space,
        ),
    )
}
# What pictures call a result. Its name everywhere else is that of the function that computes it.
TITLES = {
    "simulation": "simulation",
    **{name: theory.title for name, theory in THEORIES.items()},
    "force_balance_arctanh": "force balance, arctanh fit",
    "rod_by_rod": "force balance, rod by rod",
}

_COLUMNS = (
    ("takes", "whether the theory takes the chain", ""),
    ("reason", "why not", ""),
    ("velocity_width_model_error", "expected relative error of W_v", "1"),
    ("border_model_error", "expected relative error of W_v at the border", "1"),
    ("displacement_width_model_error", "expected relative error of W_x", "1"),
    ("mean_displacement_model_error", "expected error of the mean displacement, over s", "1"),
    ("density_model_error", "expected error of the density, over close packing", "1"),
    ("expected_seconds", "expected computing time", "s"),
)


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
        this one, or exact solutions, showed: relative ones of W_v (``velocity_width_model_error``
        of the particles 3 to L - 2, ``border_model_error`` of the first and the last) and of W_x
        (``displacement_width_model_error``), of the mean displacement in thermal lengths
        (``mean_displacement_model_error``), and of the smoothed density relative to close packing
        (``density_model_error``). They are NaN where none was measured or the chain is not taken.
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
    rows = []
    for theory in THEORIES.values():
        if reason := theory.refusal(chain):
            rows.append((False, reason, *Accuracy(), math.nan))
        else:
            rows.append((True, "", *theory.accuracy(chain), expected_seconds(theory.name, chain)))
    variables = {
        name: ("theory", np.array(values), {"long_name": title, "units": unit})
        for (name, title, unit), values in zip(_COLUMNS, zip(*rows, strict=True), strict=True)
    }
    table = xr.Dataset(variables, {"theory": list(THEORIES)})
    best = best_theory(chain).name if table.takes.any() else ""
    return table.assign_attrs(best=best)


def best_theory(chain: Chain) -> StationaryTheory:
    """Return the theory with the smallest stated error of W_v; one that is not known is largest.

    Raises a ValueError with the reasons if no theory takes the chain.
    """
    refusals = {name: theory.refusal(chain) for name, theory in THEORIES.items()}
    if len(set(refusals.values())) == 1 and all(refusals.values()):  # it has no steady state
        raise ValueError(refusals.popitem()[1])
    if all(refusals.values()):
        reasons = "; ".join(f"{name}: {reason}" for name, reason in refusals.items())
        raise ValueError(f"no theory takes this chain: {reasons}")
    errors = {
        name: theory.accuracy(chain).velocity_width
        for name, theory in THEORIES.items()
        if not refusals[name]
    }
    return THEORIES[min(errors, key=lambda name: (math.isnan(errors[name]), errors[name]))]
