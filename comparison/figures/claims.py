"""Claims of the paper, set beside what was measured; the verdict is computed, never typed in.

A claim with a number p, quoted to a precision d (half a unit of its last digit, or what "about"
grants), is reproduced if the measured value lies within d plus three standard errors of p, refuted
if it does not, and undecided if three standard errors exceed a third of p. A claim that something
is positive, or larger than something else, is reproduced or refuted at three standard errors. A
claim that two things are the same is reproduced if no difference exceeds what chance explains:
five standard errors for the largest of many.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Verdict = Literal["reproduced", "refuted", "undecided"]

_SIGNIFICANT = 3.0
_LARGEST_OF_MANY = 5.0


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
    value: float,
    error: float,
    *,
    theory: str = "",
    reason: str = "",
) -> Claim:
    """Compare a measured number with the paper's."""
    verdict: Verdict = "reproduced"
    if not _SIGNIFICANT * error < abs(paper) / 3:
        verdict = "undecided"
    elif not abs(value - paper) <= precision + _SIGNIFICANT * error:
        verdict = "refuted"
    return Claim(
        statement, f"{paper:g}", with_error(value, error), theory, verdict, _unless(verdict, reason)
    )


def positive_claim(
    statement: str,
    measured: str,
    value: float,
    error: float,
    *,
    theory: str = "",
    reason: str = "",
) -> Claim:
    """Decide whether a number, the one ``measured`` speaks of, is positive as the paper says."""
    verdict: Verdict = "undecided"
    if value > _SIGNIFICANT * error:
        verdict = "reproduced"
    elif value < -_SIGNIFICANT * error:
        verdict = "refuted"
    return Claim(statement, "", measured, theory, verdict, _unless(verdict, reason))


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


def with_error(value: float, error: float) -> str:
    """Return a number with its standard error, both to the error's second digit."""
    if not (math.isfinite(value) and math.isfinite(error)):
        return "not determined"
    digits = max(0, 1 - math.floor(math.log10(error))) if error > 0 else 4
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def _unless(verdict: Verdict, reason: str) -> str:
    """Return the reason, where the paper's claim did not come out."""
    return "" if verdict == "reproduced" else reason
