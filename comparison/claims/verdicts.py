"""Claims set beside what was measured; the verdict is computed, never typed in.

A claim is either a **statement of the paper**, which names its ``source`` there by the label of
the figure, equation or section, or a **finding of our own**, without a source. A statement of the
paper comes out as

* ``reproduced``;
* ``not reproduced``;
* ``undecided``, where the statistics do not suffice;
* ``cannot be decided``, where it fails at a parameter that the paper does not give and that is
  therefore our choice (``ours`` says which).

A finding of our own is ``confirmed``, ``refuted`` or ``undecided``.

**Rules.** A number p, quoted to a precision d (half a unit of its last digit, or the
tolerance of "about"), comes out if the measured value lies within d plus three standard errors of
p. If it does only because the errors are large, three of them more than 2 d, that is undecided: a
longer simulation could still refute it. That something is positive, or larger than something else,
is decided at three standard errors. That something vanishes is decided by a stated
limit, at as many. That two things are the same comes out if no difference exceeds what chance
explains: five standard errors for the largest of many.

**Statements to the eye.** That a curve "matches" points, or that they "can be fitted" or
"described" by it, is a statement about a plot. It gets two numbers: the largest deviation in units
of the plot, and its significance in standard errors. It is reproduced if an eye could not see the
deviation in a plot like the paper's, whatever the significance. The tolerance is 2 % of the
plotted range. The paper's plots are half a page wide: 2 % of an axis of 5 to 7 cm is 1.0 to 1.4 mm,
the size of a plotted symbol, and a line that touches every symbol looks right. It was fixed before
any deviation was worked out. A deviation is the distance of a symbol from the line in the plane of
the plot, each axis in units of its range (``distances_in_plot`` in ``comparison/distances.py``):
beside a steep line one sees the horizontal distance.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypedDict, Unpack

import numpy as np

Verdict = Literal[
    "reproduced", "not reproduced", "cannot be decided", "confirmed", "refuted", "undecided"
]

EYE = 0.02  # of the plotted range: what no eye sees
_SIGNIFICANT = 3.0
_LARGEST_CHANCE = 2.0  # times the precision of a number
_LARGEST_OF_MANY = 5.0


class Estimate(NamedTuple):
    """A number and its standard error."""

    value: float
    error: float

    def __str__(self) -> str:
        """Return both, to the error's second digit."""
        if not (math.isfinite(self.value) and math.isfinite(self.error)):
            return "not determined"
        digits = max(0, 1 - math.floor(math.log10(self.error))) if self.error > 0 else 4
        return f"{self.value:.{digits}f} ± {self.error:.{digits}f}"

    def minus(self, other: Estimate) -> Estimate:
        """Return the difference to an independent one."""
        return Estimate(self.value - other.value, math.hypot(self.error, other.error))


def largest_deviate(differences: Iterable[Estimate]) -> float:
    """Return the magnitude that is largest in standard errors; NaN if one is not determined."""
    return float(np.max([abs(each.value) / each.error for each in differences]))


class Decisive(NamedTuple):
    """The number that decides a claim, for programs.

    Attributes
    ----------
    value, error
        What was measured, and its standard error. Deviations from a line are shares of the
        plotted range; largest differences are in standard errors, and their own error is NaN.
    expected
        What it is compared with.
    limit
        How far it may lie from ``expected``; NaN: it has to be larger than ``expected``.
    """

    value: float
    error: float
    expected: float
    limit: float


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One statement and what became of it.

    Attributes
    ----------
    statement
        What is claimed, in our own words.
    source
        Where the paper says so: labels of its source, ``fig. 3, eq:power_law``. Empty: a finding
        of our own.
    ours
        Parameters that it depends on, that the paper does not give and that we chose (or "").
    paper
        The paper's number (empty for a statement without one).
    measured, theory
        What was found here, with its standard error, and what theory predicts (or "").
    decisive
        The number in ``measured`` that decides.
    verdict
        Computed from the measured value and its error.
    reason
        Why it does not hold, if it does not.
    exactly
        What is true beyond what an eye can see, whatever the verdict (or "").
    in_limit
        Whether the number is the limit of a vanishing time step. Its error then includes the
        remaining error of the step. Otherwise it belongs to the time step of its runs.
    """

    statement: str
    measured: str
    decisive: Decisive
    verdict: Verdict
    source: str = ""
    ours: str = ""
    paper: str = ""
    theory: str = ""
    reason: str = ""
    exactly: str = ""
    in_limit: bool = False

    @property
    def of_paper(self) -> bool:
        """Whether the paper says so."""
        return bool(self.source)


class About(TypedDict, total=False):
    """What can be said of any claim besides its number; :class:`Claim` says what each means."""

    source: str
    ours: str
    theory: str
    reason: str
    exactly: str
    in_limit: bool


def number_claim(
    statement: str, paper: float, precision: float, measured: Estimate, **about: Unpack[About]
) -> Claim:
    """Compare a measured number with the one quoted."""
    chance = _SIGNIFICANT * measured.error
    holds: bool | None = abs(measured.value - paper) <= precision + chance
    if math.isnan(measured.value + chance) or (holds and chance > _LARGEST_CHANCE * precision):
        holds = None
    decisive = Decisive(*measured, expected=paper, limit=precision)
    return _claim(statement, str(measured), decisive, holds, paper=f"{paper:g}", **about)


def positive_claim(
    statement: str, quantity: str, measured: Estimate, **about: Unpack[About]
) -> Claim:
    """Decide whether a number, named ``quantity``, is positive as the statement implies."""
    holds: bool | None = None
    if abs(measured.value) > _SIGNIFICANT * measured.error:
        holds = measured.value > 0
    decisive = Decisive(*measured, expected=0.0, limit=math.nan)
    return _claim(statement, f"{quantity} {measured}", decisive, holds, **about)


def small_claim(
    statement: str, quantity: str, measured: Estimate, limit: float, **about: Unpack[About]
) -> Claim:
    """Decide whether a number that should vanish is below ``limit``."""
    decisive = Decisive(*measured, expected=0.0, limit=limit)
    found = f"{quantity} {measured} (limit {limit:g})"
    return _claim(statement, found, decisive, _below(measured, limit), **about)


def same_claim(statement: str, measured: str, deviation: float, **about: Unpack[About]) -> Claim:
    """Decide whether two things are the same; ``deviation``: the largest, in standard errors."""
    holds = bool(deviation < _LARGEST_OF_MANY) if math.isfinite(deviation) else None
    found = f"{measured}; largest difference {deviation:.1f} standard errors"
    decisive = Decisive(float(deviation), math.nan, expected=0.0, limit=_LARGEST_OF_MANY)
    return _claim(statement, found, decisive, holds, **about)


def eye_claim(
    statement: str,
    quantity: str,
    deviation: Estimate,
    significance: float,
    **about: Unpack[About],
) -> Claim:
    """Decide whether an eye could see that a curve misses the points.

    Parameters
    ----------
    statement, about
        See :class:`Claim`.
    quantity
        Which points, which curve, and what axes the plot has.
    deviation
        The largest deviation as a share of the plotted range, with its standard error.
    significance
        The largest deviation in standard errors of the points, which may be that of another point.
    """
    percent = Estimate(100 * deviation.value, 100 * deviation.error)
    found = (
        f"{quantity}: off by at most {percent} % of the plotted range (visible: "
        f"{100 * EYE:g} %), {significance:.1f} standard errors"
    )
    decisive = Decisive(*deviation, expected=0.0, limit=EYE)
    return _claim(statement, found, decisive, _below(deviation, EYE), **about)


def _below(measured: Estimate, limit: float) -> bool | None:
    """Whether a magnitude is below a limit; None if its error does not allow to say."""
    if abs(measured.value) + _SIGNIFICANT * measured.error < limit:
        return True
    if abs(measured.value) - _SIGNIFICANT * measured.error > limit:
        return False
    return None


def _claim(
    statement: str,
    measured: str,
    decisive: Decisive,
    holds: bool | None,
    *,
    paper: str = "",
    **about: Unpack[About],
) -> Claim:
    """Return the claim with its verdict; ``holds`` None: the statistics do not suffice."""
    verdict: Verdict = "undecided"
    if holds is not None and about.get("source"):
        failed: Verdict = "cannot be decided" if about.get("ours") else "not reproduced"
        verdict = "reproduced" if holds else failed
    elif holds is not None:
        verdict = "confirmed" if holds else "refuted"
    if holds:
        about["reason"] = ""
    return Claim(
        statement=statement,
        measured=measured,
        decisive=decisive,
        verdict=verdict,
        paper=paper,
        **about,
    )
