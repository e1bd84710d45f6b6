"""Claims set beside what was measured; the verdict is computed, never typed in.

A :class:`Claim` is a **statement of the paper**, which names its ``source`` there by the label of
the figure, equation or section. It comes out as

* ``reproduced``;
* ``not reproduced``;
* ``undecided``, where the statistics do not suffice;
* ``cannot be decided``, where it holds at one value of a parameter that the paper does not give,
  and fails at another (``elsewhere`` says at which, with both numbers).

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
``elsewhere`` has the same number at other values of such a parameter, each judged by the rule.
Only if one of the numbers holds and another one fails, the verdict changes.

**Statements to the eye.** That a curve "matches" points, or that they "can be fitted" or
"described" by it, is a statement about a plot. What decides is the distance of a symbol from the
nearest point of the line in the plane of the plot (``distances_in_plot``). It has to be below 2 %
of the plotted range, which an eye cannot see in a plot like the paper's: of an axis of 5 to 7 cm
these are 1.0 to 1.4 mm, the size of a symbol. This limit was fixed before any distance was worked
out. Beside a steep line this distance is far shorter than the vertical one, of which the largest is
told in standard errors.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Literal, NamedTuple, TypedDict

from scipy.stats import norm

from crazybilliards.model.arrays import Array

Verdict = Literal["reproduced", "not reproduced", "cannot be decided", "undecided"]

EYE = 0.02  # of the plotted range: what no eye sees
POSITIVE = (0.0, math.inf)
_SIGNIFICANT = 3.0

Interval = tuple[float, float]


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

    def __neg__(self) -> Estimate:
        return Estimate(-self.value, self.error)

    def minus(self, other: Estimate) -> Estimate:
        """Return the difference to an independent one."""
        return Estimate(self.value - other.value, math.hypot(self.error, other.error))

    def lies(self, within: Interval) -> bool | None:
        """Apply the rule: whether it lies inside; None if its error does not allow to say."""
        low, high = within
        chance = _SIGNIFICANT * self.error
        if low < self.value - chance and self.value + chance < high:
            return True
        if self.value + chance < low or self.value - chance > high:
            return False
        return None


def around(value: float, limit: float) -> Interval:
    """Return the interval of ``limit`` to either side of a value."""
    return value - limit, value + limit


@dataclass(frozen=True)
class Claim:
    """One statement of the paper and what became of it."""

    statement: str  #: in our own words
    quantity: str = ""  #: what the number is, with further numbers; it is written before it
    _: KW_ONLY
    source: str  #: labels of the paper's source, "fig. 3, eq:power_law"
    #: The number that decides, with its standard error. Deviations from a line are shares of the
    #: plotted range. The error of the worst of many differences is the enlarged one.
    found: Estimate
    within: Interval = POSITIVE  #: where it has to lie: above zero, or around a number
    words: str = ""  #: written in place of quantity and number
    elsewhere: Mapping[str, Estimate] = field(default_factory=dict)  #: by what was chosen instead
    ours: str = ""  #: parameters that the paper does not give and that we chose; only listed
    reason: str = ""  #: why it does not hold, if it does not

    @property
    def verdict(self) -> Verdict:
        """That of its number, unless the number at another choice contradicts it."""
        others = {each.lies(self.within) for each in self.elsewhere.values()}
        if {True, False} <= {self.found.lies(self.within), *others}:
            return "cannot be decided"
        return self._named(self.found)

    def _named(self, found: Estimate) -> Verdict:
        holds = found.lies(self.within)
        if holds is None:
            return "undecided"
        return "reproduced" if holds else "not reproduced"

    def _verdict_there(self, found: Estimate) -> str:
        """Return what to write after a number at another choice: nothing if it decides nothing."""
        return "" if found.lies(self.within) is None else f", {self._named(found)}"

    @property
    def details(self) -> dict[str, str]:
        """What there is to say about it, by what it is."""
        low, high = self.within
        number = low != -high and math.isfinite(high)
        limit = f" (limit {high:g})" if low == -high else ""
        told = {
            "verdict": self.verdict,
            "in the paper": self.source,
            "its number": f"{(low + high) / 2:g}" if number else "",
            "found here": self.words or f"{self.quantity} {self.found}{limit}".strip(),
            "our choice, not given in the paper": self.ours,
            "at other choices": "; ".join(
                f"{choice}: {found}{self._verdict_there(found)}"
                for choice, found in self.elsewhere.items()
            ),
            "why": "" if self.verdict == "reproduced" else self.reason,
        }
        return {name: text for name, text in told.items() if text}


class Found(TypedDict):
    """What a claim takes of :func:`worst` and :func:`in_plot`."""

    found: Estimate
    within: Interval
    words: str


def worst(quantity: str, differences: Iterable[Estimate], limit: float) -> Found:
    """Return the difference that decides whether two things are the same to ``limit``."""
    every = list(differences)
    chance = float(norm.isf(norm.sf(_SIGNIFICANT) / len(every))) / _SIGNIFICANT
    within = around(0.0, limit)
    each = [Estimate(one.value, one.error * chance) for one in every]
    at = each.index(_decisive(each, within))
    largest = max((abs(one.value) / one.error for one in every if one.error > 0), default=math.nan)
    words = (
        f"{quantity}: {every[at]}, the worst of {len(every)} (limit {limit:g}); largest "
        f"difference {largest:.1f} standard errors"
    )
    return {"found": each[at], "within": within, "words": words}


def _decisive(every: Sequence[Estimate], within: Interval) -> Estimate:
    """Return the number that decides whether all lie inside, which need not be the largest one.

    It is one that lies outside or, if there is none, one of which its error does not allow to say.
    """
    order = {True: 0, None: 1, False: 2}
    return max(every, key=lambda one: (order[one.lies(within)], abs(one.value)))


def furthest_in_plot(deviations: Array, errors: Array) -> Estimate:
    """Return the deviation, as a share of the plotted range, that decides :func:`in_plot`."""
    each = [Estimate(*pair) for pair in zip(deviations.tolist(), errors.tolist(), strict=True)]
    return _decisive(each, around(0.0, EYE))


def in_plot(quantity: str, distance: Estimate, vertical: float | None = None) -> Found:
    """Return what decides whether an eye could see that a curve misses the points.

    ``distance`` is that of a symbol from the nearest point of the curve, as a share of the plotted
    range; of several symbols :func:`furthest_in_plot`. ``vertical``, the largest vertical distance
    in standard errors, may be that of another symbol.
    """
    percent = Estimate(100 * distance.value, 100 * distance.error)
    words = (
        f"{quantity}: the symbol that decides is {percent} % of the plotted range away from the "
        f"nearest point of the line (visible: {100 * EYE:g} %)"
    )
    if vertical is not None:
        words += f"; the largest vertical distance is {vertical:.1f} standard errors"
    return {"found": distance, "within": around(0.0, EYE), "words": words}
