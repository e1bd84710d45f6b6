"""How far the theories are from simulations and exact solutions: the errors in docs/tables.

    crazybilliards reproduce validity --quality full
    python benchmarks/accuracy/relaxation_error.py
    python benchmarks/accuracy/force_balance.py

measure them: those of the kinetic equations for the steady state, with gaps, with pair correlations
and in time, and those of the force balance. They are errors of the theories, not of their numerical
solutions. ``expected_NAME(chain)`` states that of the theory NAME.
"""

from __future__ import annotations

import math
import warnings
from typing import NamedTuple, TypeVar

import numpy as np

from crazybilliards.kinetic import measured_errors as errors
from crazybilliards.model import Chain

_Number = TypeVar("_Number", int, float)
_Measured = TypeVar("_Measured", float, tuple[float, float])


class Accuracy(NamedTuple):
    """Relative errors of W_v to expect, of the force balance of the density; NaN: not measured."""

    inner: float  # particles 3 to L - 2
    border: float  # the first and the last


class UnmeasuredWarning(UserWarning):
    """The error of a theory was not measured for chains like this one."""


def warn_if_unmeasured(theory: str, error: float) -> None:
    """Tell the caller of a theory, once, that its error is not known for this chain."""
    if math.isnan(error):
        warnings.warn(
            f"the error of {theory} was not measured for chains like this one (model_error is "
            "NaN); crazybilliards.theories(chain) lists what is known",
            UnmeasuredWarning,
            stacklevel=4,  # the theory, and what hands it out
        )


def expected_equilibrium(chain: Chain) -> Accuracy:
    """Return the errors of ``equilibrium``, which is exact."""
    return Accuracy(0.0, 0.0)


def expected_force_balance(chain: Chain) -> Accuracy:
    """Return the largest error of the density on the measured chains around this one.

    It lies at the border, and is also that of the next shorter thermal length.
    """
    shorter = sum(length <= chain.thermal_length / chain.radius for length in errors.LENGTHS)
    if chain.spring != "linear" or shorter == 0:
        return Accuracy(np.nan, np.nan)
    gap = chain.lattice_gap / chain.thermal_length
    sizes = errors.OF_DENSITY[0.0]
    if not (gap <= max(errors.OF_DENSITY) and min(sizes) <= chain.size <= max(sizes)):
        return Accuracy(np.nan, np.nan)
    error = max(
        errors.OF_DENSITY[g][size][shorter - 1]
        for g in _neighbours(gap, list(errors.OF_DENSITY))
        for size in _neighbours(chain.size, list(sizes))
    )
    return Accuracy(error, error)


def expected_phase_space(chain: Chain) -> Accuracy:
    """Return the largest errors of ``phase_space`` on the measured chains around this one."""
    if chain.restitution == 1:
        return Accuracy(0.0, 0.0)
    if chain.restitution > 1:
        tables, dampings = {0.0: errors.DRIVEN}, (errors.LEAST_DRIVEN_DAMPING, np.inf)
    else:
        tables, dampings = {0.0: errors.DISSIPATIVE, **errors.WITH_GAPS}, errors.DAMPINGS
    lattice = chain.lattice_gap * chain.size / chain.thermal_length
    if lattice > max(tables):
        return Accuracy(np.nan, np.nan)
    shorter, longer = (
        _around(chain, tables[each], dampings) for each in _neighbours(lattice, list(tables))
    )
    return _largest(shorter + longer) if shorter and longer else Accuracy(np.nan, np.nan)


def expected_correlated_phase_space(chain: Chain) -> Accuracy:
    """Return the largest errors of ``correlated_phase_space`` on chains of no smaller e."""
    return Accuracy(*_of_correlated(chain)[:2])


def expected_correlated_displacement(chain: Chain) -> float:
    """Return the largest relative error of its W_x, of any particle, on these chains."""
    return _of_correlated(chain)[2]


def _of_correlated(chain: Chain) -> tuple[float, float, float]:
    measured = errors.OF_SHORT if chain.size <= errors.SHORT else errors.OF_LONG
    return measured[max(e for e in measured if e <= chain.restitution)]


def expected_relax_phase_space(chain: Chain) -> float:
    """Return the relative error of the kinetic energy in time to expect; NaN if none was measured.

    It is the largest of the measured chains on all sides of this one. Without a gap and at e = 1
    the equation is exact.
    """
    if chain.restitution == 1 and chain.gap == 0:
        return 0.0
    driven = chain.restitution > 1
    around = chain.gap == 0 and _around(
        chain,
        errors.DRIVEN_TRANSIENT if driven else errors.TRANSIENT,
        errors.DRIVEN_TRANSIENT_DAMPINGS if driven else errors.TRANSIENT_DAMPINGS,
    )
    return float(np.max(around)) if around else np.nan


def _largest(errors: list[tuple[float, float]]) -> Accuracy:
    return Accuracy(*map(max, zip(*errors, strict=True)))


def _around(
    chain: Chain, table: dict[int, dict[float, _Measured]], dampings: tuple[float, float]
) -> list[_Measured]:
    """Return the errors of the measured chains on all sides of this one; none beyond them."""
    restitutions = list(next(iter(table.values())))
    damping = chain.damping / np.sqrt(chain.stiffness * chain.mass)
    measured = (
        dampings[0] <= damping <= dampings[1]
        and min(table) <= chain.size <= max(table)
        and min(restitutions) <= chain.restitution <= max(restitutions)
    )
    if chain.spring != "linear" or not measured:
        return []
    return [
        table[size][e]
        for size in _neighbours(chain.size, list(table))
        for e in _neighbours(chain.restitution, restitutions)
    ]


def _neighbours(value: _Number, measured: list[_Number]) -> tuple[_Number, _Number]:
    """Return the measured values on both sides of this one, which may be the same."""
    return max(m for m in measured if m <= value), min(m for m in measured if m >= value)
