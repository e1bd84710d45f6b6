"""What the theories state of themselves: their errors against simulations or exact solutions.

They are errors of the theories, not of their numerical solutions, and are read from the tables in
``kinetic/measured``, which ``studies/stationary_errors.py``, ``studies/force_balance.py`` and
``studies/relaxation_error.py`` have written. A stated error is a measured one plus two of its
standard errors: for ``steady_state`` the largest of the chains of its kind that are nearby, for
``force_balance`` that of the measured chains on all sides, and in time that of all chains in a
range of L (1 - e). It is NaN beyond them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from crazybilliards.model import Chain
from crazybilliards.model.warn import warn_user

# Of ``steady_state``: a chain is near another one of its kind if all its numbers are within these
# factors, 1 - e as well, and e within this difference. x is that of ``kind_and_place``.
_FACTORS = {"L": 2.5, "Gamma": 2.5}
_FACTORS_OF_X = {"gap": 2.5, "box": 2.5, "driven": 1.45, "inelastic walls": 1.5}
_FACTOR_OF_LOSS, _DIFFERENCE = 2.6, 0.26
_SAME = 5e-3  # relative
_SHORTEST = 21.0  # s/R in the table of the force balance
_OF_THE_GRID = 1e-3  # at e = 1, where the gas is exact but for its cells
# Of the force balance the largest of 800 boxes at e = 1; with gap and springs it may be twice that.
_IN_A_BOX = 0.18
# Of the chains and starts in time: L, Gamma, what y was multiplied by, and the shift in s.
_IN_TIME = {"L": (20, 100), "Gamma": (0.3, 1.5), "stretch": (0.8, 1.3), "shift": (-2, 2)}


class Accuracy(NamedTuple):
    """Errors to expect of a theory's quantities; NaN: not measured."""

    velocity_width: float = math.nan  # relative, of the particles 3 to L - 2
    border: float = math.nan  # the same of the first and the last
    displacement_width: float = math.nan  # relative, of any particle
    mean_displacement: float = math.nan  # of any particle, in s, or in the room of a rod
    density: float = math.nan  # of the smoothed density, relative to close packing
    wall_force: float = math.nan  # relative

    def named(self) -> dict[str, float]:
        """Return the errors by the names that attributes of results have."""
        return {f"{quantity}_model_error": error for quantity, error in self._asdict().items()}


class UnmeasuredWarning(UserWarning):
    """The error of a theory was not measured for chains like this one."""


def warn_if_unmeasured(theory: str, error: float, what: str = "chains like this one") -> None:
    """Tell the caller of a theory, once, that its error is not known for this chain."""
    if math.isnan(error):
        warn_user(
            f"the error of {theory} was not measured for {what} (it is NaN)", UnmeasuredWarning
        )


def errors_of_equilibrium(chain: Chain) -> Accuracy:
    """Return the errors of ``equilibrium``, which is exact; without walls there is no force."""
    return Accuracy(0.0, 0.0, 0.0, 0.0, 0.0, 0.0 if chain.box else math.nan)


def errors_of_force_balance(chain: Chain) -> Accuracy:
    """Return the errors of ``force_balance`` at e = 1, where they were measured."""
    if chain.box:
        density, force = (_IN_A_BOX, 0.0) if chain.exchangeable else (math.nan, math.nan)
        return Accuracy(velocity_width=0.0, border=0.0, density=density, wall_force=force)
    if chain.spring != "linear":
        return Accuracy(velocity_width=0.0, border=0.0)
    place = {"g/s": chain.lattice_gap / chain.thermal_length, "L": chain.size}
    moved = _around("mean_displacement", place)
    # The density of shorter rods is less wrong, so that of the shortest counts beyond it, too.
    length = min(chain.thermal_length / chain.radius, _SHORTEST)
    density = _around("density", place | {"s/R": length})
    return Accuracy(velocity_width=0.0, border=0.0, mean_displacement=moved, density=density)


def errors_of_steady_state(chain: Chain) -> Accuracy:
    """Return the errors of ``steady_state``: the largest of the measured chains nearby."""
    if (chain.restitution == 1 or chain.size == 1) and chain.wall_restitution == 1:
        if chain.spring == "quadratic" and chain.lattice_gap:
            return Accuracy(velocity_width=0.0, border=0.0)
        return Accuracy(0.0, 0.0, 0.0, 0.0, _OF_THE_GRID, _OF_THE_GRID if chain.box else math.nan)
    kind, place = kind_and_place(chain)
    measured = _table("steady_state").query("kind == @kind")
    if place["e"] <= 1:  # errors fall towards e = 1
        place["e"] = np.fmin(place["e"], measured.e.max())
    for axis, value in place.items():
        if not _is_inside(value, measured[axis].min(), measured[axis].max()):
            return Accuracy()
    near = measured[_near(measured, place, {**_FACTORS, "x": _FACTORS_OF_X.get(kind, 1.1)})]
    found = Accuracy(*near[list(Accuracy._fields)].max())
    # Of one s/R each, on which the density depends: all of such a size and restitution count.
    alike = measured[_near(measured, place, {"L": _FACTORS["L"]})] if len(near) else near
    return found._replace(density=float(alike.density.max()))


def kind_and_place(chain: Chain) -> tuple[str, dict[str, float]]:
    """Return which table a chain belongs to, and where: L, e, Gamma and a number x of its kind.

    x is the gap over s, the room of a box over s, the share of the critical size, or the
    restitution of walls. Lengths of a gas without springs are in the room of a rod.
    """
    s = chain.thermal_length if chain.stiffness else 2 * chain.walls[1] / chain.size
    damping = chain.damping * s / (chain.mass * chain.free_velocity_width)
    kind, x = "linear", 1.0
    if chain.wall_restitution < 1:
        kind, x = "inelastic walls" if chain.stiffness == 0 else "", chain.wall_restitution
    elif chain.stiffness == 0:
        kind = "gas in a box"
    elif chain.restitution > 1:
        kind = "driven" if chain.gap == chain.box == 0 and chain.spring == "linear" else ""
        x = chain.size * (chain.restitution - 1) / (math.pi * damping)
    elif chain.box:
        kind, x = "box" if chain.spring == "linear" else "", 2 * chain.walls[1] / s
    elif chain.spring == "quadratic":
        kind = "quadratic" if not chain.gap else ""
    elif chain.gap:
        kind, x = "gap", chain.gap / s
    return kind, {"L": chain.size, "e": chain.restitution, "Gamma": damping, "x": x}


def _near(
    rows: pd.DataFrame, place: Mapping[str, float], factors: Mapping[str, float]
) -> pd.Series[bool]:
    """Return which rows are within these factors of a place, and have nearly its restitution."""
    e, away = place["e"], np.abs(rows.e - place["e"])
    alike = _are_within(_FACTOR_OF_LOSS, 1 - rows.e, 1 - e) & (away <= _DIFFERENCE)
    near = alike | (away < _SAME) | (e > 1)
    for axis, factor in factors.items():
        near &= _are_within(factor, rows[axis], place[axis])
    return near


def _are_within(factor: float, values: pd.Series[float], value: float) -> pd.Series[bool]:
    return (values <= factor * value) & (value <= factor * values)


def _is_inside(value: float, least: float, most: float) -> bool:
    """Return whether a value lies between two others, but for a small tolerance."""
    return least - _SAME * abs(least) <= value <= most + _SAME * abs(most)


def expected_in_time(chain: Chain, stretch: float, shift: float, heat: float) -> float:
    """Return the relative error of the kinetic energy of ``hydrodynamics`` with a temperature.

    It is that of any time after a start from the equilibrium at e = 1, whose y were multiplied by
    ``stretch`` and moved by ``shift`` thermal lengths, with W^2 = ``heat`` times the free one. NaN:
    not measured.
    """
    if chain.stiffness == 0 or chain.box or chain.mass_ratio != 1:
        return math.nan
    if chain.restitution == 1 and chain.gap == 0 and chain.spring == "linear":
        return 0.0
    _, place = kind_and_place(chain)
    place |= {"stretch": stretch, "shift": shift}
    inside = all(_is_inside(place[axis], *ends) for axis, ends in _IN_TIME.items())
    if not inside or abs(heat - 1) > 2 * _SAME:
        return math.nan
    rows = _table("relaxation")
    fits = rows.n == chain.potential_exponent
    for axis, value in {
        "g/s": chain.lattice_gap / chain.thermal_length,
        "L(1-e)": round(chain.size * (1 - chain.restitution), 9),
    }.items():
        fits &= rows[f"least {axis}"].le(value) & rows[f"most {axis}"].ge(value)
    return float(next(iter((rows.error + 2 * rows["standard error"])[fits]), math.nan))


def _around(quantity: str, place: Mapping[str, float]) -> float:
    """Return the largest error of the measured chains on both sides in every number of a place."""
    rows = _table("force_balance").query("quantity == @quantity")
    for axis, value in place.items():
        below = rows[axis][rows[axis] <= value * (1 + _SAME)].max()
        above = rows[axis][rows[axis] >= value * (1 - _SAME)].min()
        if math.isnan(below + above):
            return math.nan
        rows = rows[rows[axis].isin((below, above))]
    return float(rows.error.max())


@cache
def _table(name: str) -> pd.DataFrame:
    return pd.read_csv(Path(__file__).with_name("measured") / f"{name}.csv")
