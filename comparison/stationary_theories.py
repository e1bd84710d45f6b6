"""The stationary theories: which of them take a chain, how good each is there, and the best one.

A theory is one line of ``THEORIES``.
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from crazybilliards.kinetic.accuracy import Accuracy, expected, expected_seconds
from crazybilliards.kinetic.correlations.stationary import (
    check_correlated_phase_space,
    correlated_phase_space,
)
from crazybilliards.kinetic.exact.gibbs_measure import check_equilibrium, equilibrium
from crazybilliards.kinetic.kinetic_equation.stationary import check_phase_space, phase_space
from crazybilliards.kinetic.rods.places import are_resolved
from crazybilliards.kinetic.statics.balance import check_force_balance, force_balance
from crazybilliards.model import Chain
from crazybilliards.model.checks import check_choice
from crazybilliards.model.progress import silent, watched


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

    def seconds(self, chain: Chain) -> float:
        """Return the computing time on one core, within a factor of three."""
        return expected_seconds(self.name, chain)

    def refusal(self, chain: Chain, settings: Mapping[str, Any] | None = None) -> str:
        """Return why the theory does not take the chain and these settings, or nothing."""
        arguments = inspect.signature(self.solve).parameters.items()
        defaults = {name: each.default for name, each in arguments if name != "chain"}
        given = dict(settings or {})
        if unknown := sorted(set(given) - set(defaults)):
            return f"{unknown[0]}: {self.name} has no such setting"
        try:
            self.check(chain, **(defaults | given))
        except ValueError as error:
            return str(error)
        return ""

    def lacks(self, chain: Chain, quantity: str) -> str:
        """Return why the result has no such quantity, or nothing."""
        if quantity == "displacement_width":
            if self.name == "force_balance":
                return "it gives no displacement_width"
            if self.name == "phase_space" and chain.lattice_gap > 0 and not are_resolved(chain):
                return "it gives no displacement_width of so many rods with a gap"
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
            rows.append((True, "", *theory.accuracy(chain), theory.seconds(chain)))
    variables = {
        name: ("theory", np.array(values), {"long_name": title, "units": unit})
        for (name, title, unit), values in zip(_COLUMNS, zip(*rows, strict=True), strict=True)
    }
    table = xr.Dataset(variables, {"theory": list(THEORIES)})
    best = choose_theory(chain).theory.name if table.takes.any() else ""
    return table.assign_attrs(best=best)


def best_theory(
    chain: Chain,
    quantity: str = "velocity_width",
    *,
    tolerance: float | None = None,
    cells: int | None = None,
    progress: bool = True,
) -> xr.Dataset:
    """Solve the theory with the smallest stated error of a quantity.

    Parameters
    ----------
    chain
        The chain.
    quantity
        ``"velocity_width"`` (of the particles 3 to L - 2), ``"border"`` (the velocity width of the
        first and the last), ``"displacement_width"``, ``"mean_displacement"`` or ``"density"``.
    tolerance, cells
        As ``phase_space`` takes them. Only a theory that knows them is then chosen.
    progress
        Print which theory was chosen and why, and show how long it takes, on a terminal or in a
        notebook.

    Returns
    -------
    xarray.Dataset
        The result of the theory. ``attrs["best_theory"]`` is the name of its function, and
        ``attrs["chosen"]`` says why: the stated errors of all theories that take the chain (see
        :func:`theories`). An error that was not measured counts as larger than any other.

    Raises
    ------
    ValueError
        For an unknown quantity, before any work; with the reasons, if no theory takes the chain or
        gives the quantity.

    Examples
    --------
    >>> from crazybilliards import Chain
    >>> theory = best_theory(Chain(size=30), "density")
    >>> theory.attrs["chosen"].partition(":")[0]
    'equilibrium comes first of those with the smallest stated error of density'
    """
    given = {"tolerance": tolerance, "cells": cells}
    settings = {name: value for name, value in given.items() if value is not None}
    theory, why = choose_theory(chain, quantity, settings)
    if progress and watched():
        print(f"crazybilliards: {why}", file=sys.stderr, flush=True)
    with nullcontext() if progress else silent():
        result = theory.solve(chain, **settings)
    return result.assign_attrs(best_theory=theory.name, chosen=why)


class Choice(NamedTuple):
    """A theory, and why it was chosen in one sentence."""

    theory: StationaryTheory
    why: str


def choose_theory(
    chain: Chain, quantity: str = "velocity_width", settings: Mapping[str, Any] | None = None
) -> Choice:
    """Choose the theory for :func:`best_theory` without solving it."""
    check_choice("quantity", quantity, Accuracy._fields)
    refusals = {
        name: theory.refusal(chain, settings) or theory.lacks(chain, quantity)
        for name, theory in THEORIES.items()
    }
    if all(refusals.values()):
        if len(set(refusals.values())) == 1:  # it has no steady state
            raise ValueError(refusals.popitem()[1])
        listed = "; ".join(f"{name}: {reason}" for name, reason in refusals.items())
        raise ValueError(f"no theory takes this chain for its {quantity}: {listed}")
    errors: dict[str, float] = {
        name: getattr(theory.accuracy(chain), quantity)
        for name, theory in THEORIES.items()
        if not refusals[name]
    }
    best = min(errors, key=lambda name: (math.isnan(errors[name]), errors[name]))
    named = quantity.replace("_", " ")
    listed = ", ".join(
        f"{name} " + ("not measured" if math.isnan(error) else f"{100 * error:.3g} %")
        for name, error in errors.items()
    )
    if math.isnan(errors[best]):
        return Choice(THEORIES[best], f"{best} comes first, no error of {named} is known here")
    has = "has" if list(errors.values()).count(errors[best]) == 1 else "comes first of those with"
    why = f"{best} {has} the smallest stated error of {named}: {listed}"
    return Choice(THEORIES[best], why)
