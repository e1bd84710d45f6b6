"""Claims set beside what was measured; the verdict is computed, never typed in.

A claim is either a **statement of the paper**, which names its ``source`` there by the label of
the figure, equation or section, or a **finding of our own**, without a source. A statement of the
paper comes out as

* ``reproduced``;
* ``not reproduced``;
* ``undecided``, where the statistics do not suffice;
* ``cannot be decided``, where it holds at one value of a parameter that the paper does not give,
  and fails at another (``variations`` says at which, with both numbers).

A finding of our own is ``confirmed``, ``refuted`` or ``undecided``.

**The rule.** Every claim comes down to one measured number and the interval in which it has to
lie. It holds if the number lies inside with three standard errors to spare at either end. It fails
if the number lies outside with three standard errors to spare. Otherwise it is undecided, and a
longer simulation may decide it. Large errors can therefore help neither the paper nor us.

The intervals are: up to half a unit of the last digit to either side of a number of the paper;
everything above zero for something that is positive, or larger than something else; and a stated
limit to either side of zero for something that vanishes, or is the same as something else.

**Many differences.** That two curves are the same is decided by the worst of all differences. The
largest of many numbers lies further off by chance than a single one does. The errors are therefore
enlarged so that chance exceeds three of them in any of the differences as rarely as it exceeds
three in one number: by 1.1 for two differences, by 1.6 for a thousand.

**Choices.** ``ours`` lists parameters that the paper does not give, and changes no verdict.
``variations`` are the same number at other values of such a parameter, each judged by the rule.
Only if one of the numbers holds and another one fails, the verdict changes.

**Statements to the eye.** That a curve "matches" points, or that they "can be fitted" or
"described" by it, is a statement about a plot. It gets two numbers: the largest deviation in units
of the plot, and its significance in standard errors. Only the first one decides. It has to be below
2 % of the plotted range, which an eye cannot see in a plot like the paper's: of an axis of 5 to
7 cm these are 1.0 to 1.4 mm, the size of a symbol. This limit was fixed before any deviation was
worked out. A deviation is a distance in the plane of the plot (``distances_in_plot``).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypedDict, Unpack

from scipy.stats import norm

Verdict = Literal[
    "reproduced", "not reproduced", "cannot be decided", "confirmed", "refuted", "undecided"
]

EYE = 0.02  # of the plotted range: what no eye sees
_SIGNIFICANT = 3.0


class Estimate(NamedTuple):
    """A number and its standard error."""

    value: float
    error: float

    def __str__(self) -> str:
        """Return both, to the error's second digit."""
        if not math.isfinite(self.value + self.error):
            return "not determined" if math.isnan(self.value) else f"{self.value:.3g} ± unknown"
        digits = max(0, 1 - math.floor(math.log10(self.error))) if self.error > 0 else 4
        return f"{self.value:.{digits}f} ± {self.error:.{digits}f}"

    def minus(self, other: Estimate) -> Estimate:
        """Return the difference to an independent one."""
        return Estimate(self.value - other.value, math.hypot(self.error, other.error))


class Decisive(NamedTuple):
    """The number that decides a claim, and what decides it.

    Attributes
    ----------
    value, error
        What was measured, and its standard error. Deviations from a line are shares of the
        plotted range. The error of the worst of many differences is the enlarged one.
    expected
        What it is compared with.
    limit
        How far it may lie from ``expected``; NaN: it has to be larger than ``expected``.
    """

    value: float
    error: float
    expected: float
    limit: float

    @property
    def holds(self) -> bool | None:
        """The rule: whether the number lies inside; None: its error does not allow to say."""
        positive = math.isnan(self.limit)
        low, high = (0.0, math.inf) if positive else (-self.limit, self.limit)
        deviation, chance = self.value - self.expected, _SIGNIFICANT * self.error
        if low < deviation - chance and deviation + chance < high:
            return True
        if deviation + chance < low or deviation - chance > high:
            return False
        return None


class Variation(NamedTuple):
    """The number of a claim at another value of a parameter that the paper does not give.

    Attributes
    ----------
    choice
        The other value: ``dt = 0.01``.
    measured
        The number there, with its standard error.
    verdict
        What the rule says of it; computed with the claim.
    """

    choice: str
    measured: Estimate
    verdict: Verdict = "undecided"

    def __str__(self) -> str:
        """Return all three."""
        return f"{self.choice}: {self.measured}, {self.verdict}"


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
        Parameters that the paper does not give and that we chose (or ""). They are listed only.
    variations
        The same number at other values of such parameters, each with its verdict.
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
    variations: Sequence[Variation] = ()
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
    variations: Sequence[Variation]
    theory: str
    reason: str
    exactly: str
    in_limit: bool


def number_claim(
    statement: str, paper: float, precision: float, measured: Estimate, **about: Unpack[About]
) -> Claim:
    """Compare a number with the one quoted; ``precision``: half a unit of its last digit."""
    decisive = Decisive(*measured, expected=paper, limit=precision)
    return _claim(statement, str(measured), decisive, paper=f"{paper:g}", **about)


def positive_claim(
    statement: str, quantity: str, measured: Estimate, **about: Unpack[About]
) -> Claim:
    """Decide whether a number, named ``quantity``, is positive as the statement implies."""
    decisive = Decisive(*measured, expected=0.0, limit=math.nan)
    return _claim(statement, f"{quantity} {measured}", decisive, **about)


def small_claim(
    statement: str, quantity: str, measured: Estimate, limit: float, **about: Unpack[About]
) -> Claim:
    """Decide whether a number that should vanish is below ``limit``."""
    decisive = Decisive(*measured, expected=0.0, limit=limit)
    found = f"{quantity} {measured} (limit {limit:g})"
    return _claim(statement, found, decisive, **about)


def same_claim(
    statement: str,
    quantity: str,
    differences: Iterable[Estimate],
    limit: float,
    **about: Unpack[About],
) -> Claim:
    """Decide whether two things are the same: whether all their differences are below ``limit``."""
    every = list(differences)
    chance = float(norm.isf(norm.sf(_SIGNIFICANT) / len(every))) / _SIGNIFICANT
    each = [Decisive(one.value, one.error * chance, expected=0.0, limit=limit) for one in every]
    worst = max(
        range(len(every)),
        key=lambda k: (each[k].holds is False, each[k].holds is None, abs(each[k].value)),
    )
    largest = max((abs(one.value) / one.error for one in every if one.error > 0), default=math.nan)
    found = (
        f"{quantity}: {every[worst]}, the worst of {len(every)} (limit {limit:g}); largest "
        f"difference {largest:.1f} standard errors"
    )
    return _claim(statement, found, each[worst], **about)


def eye_claim(
    statement: str, quantity: str, deviation: Estimate, significance: float, **about: Unpack[About]
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
    return _claim(statement, found, decisive, **about)


def _claim(
    statement: str, found: str, decisive: Decisive, *, paper: str = "", **about: Unpack[About]
) -> Claim:
    """Return the claim with its verdict: that of its number, unless a variation contradicts it."""
    of_paper = bool(about.get("source"))
    varied = [
        (other, decisive._replace(value=other.measured.value, error=other.measured.error).holds)
        for other in about.get("variations", ())
    ]
    about["variations"] = [
        other._replace(verdict=_named(holds, of_paper)) for other, holds in varied
    ]
    verdict = _named(decisive.holds, of_paper)
    if of_paper and {True, False} <= {decisive.holds, *(holds for _, holds in varied)}:
        verdict = "cannot be decided"
    elif decisive.holds:
        about["reason"] = ""
    return Claim(
        statement=statement,
        measured=found,
        decisive=decisive,
        verdict=verdict,
        paper=paper,
        **about,
    )


def _named(holds: bool | None, of_paper: bool) -> Verdict:
    if holds is None:
        return "undecided"
    yes: Verdict = "reproduced" if of_paper else "confirmed"
    no: Verdict = "not reproduced" if of_paper else "refuted"
    return yes if holds else no
