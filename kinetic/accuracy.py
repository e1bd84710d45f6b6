"""What the theories state of themselves: their errors, and about how long they compute.

The errors are those of the theories, not of their numerical solutions. They are read from the
tables in ``kinetic/measured``, which

    python -m studies.stationary_errors FOLDER
    python -m studies.force_balance
    python -m studies.relaxation_error FOLDER

have written. A stated error is the measured one plus two of its standard errors: the largest of the
measured chains on all sides of a chain, or in time of all measured chains in a range of L (1 - e).
It is NaN beyond them.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

from crazybilliards.model import Chain
from crazybilliards.model.warn import warn_user

# Coordinates in the tables, in order. The density of shorter rods is less wrong, so that of the
# largest s/R counts beyond it, too.
_PLACE = ("g L/s", "L", "e", "Gamma")
_AXES = {
    "force_balance": ("g/s", "L"),
    "phase_space": _PLACE,
    "correlated_phase_space": _PLACE,
    "relax_phase_space": ("L", "e", "Gamma", "y times"),
}
_LENGTH = "s/R"
# Of the density of the force balance at e = 1, without a gap or without springs: the largest of 800
# boxes. With both it may be twice as large.
_IN_A_BOX = 0.18
_CONTINUOUS, _SAME = ("Gamma", "g L/s", "g/s", _LENGTH), 5e-3  # relative
_ANY = 0.49  # Gamma of a measured chain
# Of the chains and starts in time: L, Gamma, what y was multiplied by, and the shift in s.
_IN_TIME = {"L": (20, 100), "Gamma": (0.3, 1.5), "stretch": (0.8, 1.3), "shift": (-2, 2)}


class Accuracy(NamedTuple):
    """Errors to expect of a theory's quantities; NaN: not measured."""

    velocity_width: float = math.nan  # relative, of the particles 3 to L - 2
    border: float = math.nan  # the same of the first and the last
    displacement_width: float = math.nan  # relative, of any particle
    mean_displacement: float = math.nan  # in thermal lengths, of any particle
    density: float = math.nan  # of the smoothed density, relative to close packing

    def named(self) -> dict[str, float]:
        """Return the errors by the names that attributes of results and columns of tables have."""
        return {f"{quantity}_model_error": error for quantity, error in self._asdict().items()}


class UnmeasuredWarning(UserWarning):
    """The error of a theory was not measured for chains like this one."""


def warn_if_unmeasured(theory: str, error: float) -> None:
    """Tell the caller of a theory, once, that its error is not known for this chain."""
    if math.isnan(error):
        warn_user(
            f"the error of {theory} was not measured for chains like this one (it is "
            "NaN); crazybilliards.theories(chain) lists what is known",
            UnmeasuredWarning,
        )


def expected(theory: str, chain: Chain) -> Accuracy:
    """Return the errors of a stationary theory: the largest of the measured chains around this one.

    At e = 1 these theories have the exact velocities. ``force_balance`` was measured there alone.
    A theory that was never measured has no errors to state.
    """
    if theory == "equilibrium":
        return Accuracy(0.0, 0.0, 0.0, 0.0, 0.0)
    if theory not in _AXES or (theory == "force_balance" and chain.restitution != 1):
        return Accuracy()
    if chain.box:
        density = _IN_A_BOX if chain.exchangeable else math.nan
        return Accuracy(velocity_width=0.0, border=0.0, density=density)
    axes, place = _AXES[theory], _place(chain)
    errors = {
        quantity: _around(theory, quantity, axes + (_LENGTH,) * (quantity == "density"), place)
        for quantity in Accuracy._fields
    }
    exact = {"velocity_width": 0.0, "border": 0.0} if chain.restitution == 1 else {}
    return Accuracy(**errors | exact)


class Release(NamedTuple):
    """A start in time from the equilibrium at e = 1."""

    stretch: float  # of y
    shift: float  # in thermal lengths
    heat: float  # W^2 over the free one


def expected_in_time(chain: Chain, release: Release | None) -> float:
    """Return the relative error of the kinetic energy of ``hydrodynamics`` with a temperature.

    It is that of any time after a ``release``; None: another start. NaN: not measured. At e = 1
    Gaussian clouds are exact.
    """
    known = chain.stiffness > 0 and chain.box == 0 and chain.mass_ratio == 1
    if not known or release is None:
        return math.nan
    if chain.restitution == 1 and chain.gap == 0 and chain.spring == "linear":
        return 0.0
    s, W = chain.thermal_length, chain.free_velocity_width
    place = {
        "L": float(chain.size),
        "Gamma": chain.damping * s / (chain.mass * W),
        "stretch": release.stretch,
        "shift": release.shift,
    }
    inside = all(
        least - _SAME * abs(least) <= place[axis] <= most * (1 + _SAME)
        for axis, (least, most) in _IN_TIME.items()
    )
    if not inside or abs(release.heat - 1) > 2 * _SAME:
        return math.nan
    measured = _tables()["hydrodynamics", "kinetic_energy"].get(chain.potential_exponent, {})
    concentration = round(chain.size * (1 - chain.restitution), 9)
    return _in_ranges(measured, [chain.lattice_gap / s, concentration])


def _in_ranges(measured: Any, place: list[float]) -> float:
    """Return the error of the first ranges, from least to most, that hold all values; or NaN."""
    if not place:
        return float(measured)
    value, *rest = place
    for least, ends in measured.items():
        for most, inner in ends.items():
            if least <= value <= most and not math.isnan(found := _in_ranges(inner, rest)):
                return found
    return math.nan


def expected_relax_phase_space(chain: Chain, compression: float) -> float:
    """Return the relative error of the kinetic energy in time to expect; NaN if none was measured.

    ``compression``: what y of the equilibrium at e = 1 was multiplied by at the start; NaN for
    another start. Without a gap and at e = 1 the equation is exact.
    """
    if chain.gap > 0:
        return math.nan
    if chain.restitution == 1:
        return 0.0
    place, theory = _place(chain) | {"y times": compression}, "relax_phase_space"
    return _around(theory, "kinetic_energy", _AXES[theory], place)


def expected_seconds(theory: str, chain: Chain) -> float:
    """Return the computing time of a theory, by the name of its function [s].

    It is that on one core, within a factor of three.
    """
    # From e = 1 to the chain in steps, each with 2.5 times the drag.
    steps = 1 + math.log1p(abs(1 - chain.restitution) * chain.size) / math.log(2.5)
    return {
        "equilibrium": 1e-3 * chain.size,
        "force_balance": 0.03,
        "phase_space": 0.4 * steps,
        "correlated_phase_space": 1.0 * steps,
    }[theory]


def _place(chain: Chain) -> dict[str, float]:
    """Return where a chain lies in the tables; NaN for quadratic springs, which are in none."""
    if chain.spring != "linear" or min(chain.stiffness, chain.damping, chain.amplitude) == 0:
        return dict.fromkeys((*_PLACE, "g/s", _LENGTH), math.nan)
    s = chain.thermal_length
    return {
        "L": chain.size,
        "e": chain.restitution,
        # At e = 1 no distribution in space depends on the damping.
        "Gamma": _ANY if chain.restitution == 1 else chain.relative_damping,
        "g L/s": chain.lattice_gap * chain.size / s,
        "g/s": chain.lattice_gap / s,
        _LENGTH: s / chain.radius,
    }


def _around(theory: str, quantity: str, axes: tuple[str, ...], place: Mapping[str, float]) -> float:
    """Return the largest error of the measured chains on all sides of a place; NaN beyond them."""
    return _largest(_tables().get((theory, quantity), {}), [(axis, place[axis]) for axis in axes])


def _largest(measured: Any, place: list[tuple[str, float]]) -> float:
    """Return the largest error on both sides of the first coordinate, and so on for the others."""
    if not place:
        return float(measured)
    (axis, value), *rest = place
    if axis in _CONTINUOUS:  # gamma = 1 is measured as Gamma = 0.49
        value = next((each for each in measured if abs(each - value) <= _SAME * each), value)
    below = [each for each in measured if each <= value]
    above = [each for each in measured if each >= value]
    if not below or not (above or axis == _LENGTH):
        return math.nan
    sides = {max(below), min(above, default=max(below))}
    errors = [_largest(measured[side], rest) for side in sides]
    return math.nan if any(map(math.isnan, errors)) else max(errors)


@cache
def _tables() -> dict[tuple[str, str], Any]:
    """Return the errors to state, by theory and quantity, then by the coordinates of the chain."""
    tables: dict[tuple[str, str], Any] = {}
    for row in _rows():
        theory, quantity = row.pop("theory"), row.pop("quantity")
        error = float(row.pop("error")) + 2 * float(row.pop("standard error"))
        *outer, last = (float(value) for value in row.values() if value)
        branch = tables.setdefault((theory, quantity), {})
        for value in outer:
            branch = branch.setdefault(value, {})
        branch[last] = error
    return tables


def _rows() -> Iterator[dict[str, str]]:
    for table in (files("crazybilliards.kinetic") / "measured").iterdir():
        if table.name.endswith(".csv"):
            yield from csv.DictReader(table.read_text(encoding="utf-8").splitlines())
