"""Claims of the paper, set beside what was measured; the verdict is computed, never typed in.

A claim with a number p, quoted to a precision d (half a unit of its last digit, or what "about"
grants), is reproduced if the measured value lies within d plus three standard errors of p, refuted
if it does not, and undecided if three standard errors exceed a third of p. A claim that something
is positive, or larger than something else, is reproduced or refuted at three standard errors; one
that something vanishes, if it is below or above a stated limit by as much. A claim that two things
are the same is reproduced if no difference exceeds what chance explains: five standard errors for
the largest of many.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

Verdict = Literal["reproduced", "refuted", "undecided"]

_SIGNIFICANT = 3.0
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


@dataclass(frozen=True)
class Claim:
    """One statement of the paper and what became of it.

    Attributes
    ----------
    statement, paper
        What the paper says, and its number (empty for a statement without one).
    measured, theory
        What was found here, with its standard error, and what theory predicts (or "").
    verdict
        Computed from the measured value and its error.
    reason
        Why a refuted claim does not hold, or what else there is to say.
    """

    statement: str
    paper: str
    measured: str
    theory: str
    verdict: Verdict
    reason: str = ""


def number_claim(
    statement: str,
    paper: float,
    precision: float,
    measured: Estimate,
    *,
    theory: str = "",
    reason: str = "",
) -> Claim:
    """Compare a measured number with the paper's."""
    value, error = measured
    verdict: Verdict = "reproduced"
    if not _SIGNIFICANT * error < abs(paper) / 3:
        verdict = "undecided"
    elif not abs(value - paper) <= precision + _SIGNIFICANT * error:
        verdict = "refuted"
    return Claim(statement, f"{paper:g}", str(measured), theory, verdict, _unless(verdict, reason))


def positive_claim(
    statement: str, quantity: str, measured: Estimate, *, theory: str = "", reason: str = ""
) -> Claim:
    """Decide whether a number, named ``quantity``, is positive as the paper's statement implies."""
    verdict: Verdict = "undecided"
    if measured.value > _SIGNIFICANT * measured.error:
        verdict = "reproduced"
    elif measured.value < -_SIGNIFICANT * measured.error:
        verdict = "refuted"
    return Claim(statement, "", f"{quantity} {measured}", theory, verdict, _unless(verdict, reason))


def small_claim(
    statement: str,
    quantity: str,
    measured: Estimate,
    limit: float,
    *,
    theory: str = "",
    reason: str = "",
) -> Claim:
    """Decide whether a number that should vanish is below ``limit``, what an eye would see."""
    verdict: Verdict = "undecided"
    if abs(measured.value) + _SIGNIFICANT * measured.error < limit:
        verdict = "reproduced"
    elif abs(measured.value) - _SIGNIFICANT * measured.error > limit:
        verdict = "refuted"
    found = f"{quantity} {measured} (limit {limit:g})"
    return Claim(statement, "", found, theory, verdict, _unless(verdict, reason))


def same_claim(
    statement: str,
    measured: str,
    deviation: float,
    *,
    theory: str = "",
    reason: str = "",
) -> Claim:
    """Decide whether two things are the same; ``deviation``: the largest, in standard errors."""
    verdict: Verdict = "undecided"
    if math.isfinite(deviation):
        verdict = "reproduced" if deviation < _LARGEST_OF_MANY else "refuted"
    measured = f"{measured}; largest difference {deviation:.1f} standard errors"
    return Claim(statement, "", measured, theory, verdict, _unless(verdict, reason))


def _unless(verdict: Verdict, reason: str) -> str:
    """Return the reason, where the paper's claim did not come out."""
    return "" if verdict == "reproduced" else reason
