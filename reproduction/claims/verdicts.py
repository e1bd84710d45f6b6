"""Claims set beside what was measured; the verdict is computed, never typed in.

A :class:`Claim` is a statement of the paper. It comes down to one measured number and the interval
in which it has to lie. It is ``reproduced`` if the number lies inside with three standard errors to
spare at either end, ``not reproduced`` if it lies outside with three to spare, and otherwise
``undecided``. It ``cannot be decided`` if it holds at one value of a parameter that the paper does
not give, and fails at another.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, Literal, NamedTuple, TypeVar

from scipy.stats import norm

from crazybilliards.model import Array

Verdict = Literal["reproduced", "not reproduced", "cannot be decided", "undecided"]
Interval = tuple[float, float]
Choice = TypeVar("Choice")

#: Of the plotted range: what no eye sees in a plot like the paper's. Of an axis of 5 to 7 cm this
#: is 1.0 to 1.4 mm, the size of a symbol. It was fixed before any distance was worked out.
EYE = 0.02
POSITIVE = (0.0, math.inf)
_SIGNIFICANT = 3.0
_OUTCOMES: dict[bool | None, Verdict] = {True: "reproduced", False: "not reproduced"}


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

    def times(self, factor: float) -> Estimate:
        """Return it in another unit, or with the other sign."""
        return Estimate(self.value * factor, self.error * abs(factor))

    def minus(self, other: Estimate) -> Estimate:
        """Return the difference to an independent one."""
        return Estimate(self.value - other.value, math.hypot(self.error, other.error))

    def lies(self, within: Interval) -> bool | None:
        """Apply the rule: whether it lies inside; None if its error does not allow to say."""
        chance = _SIGNIFICANT * self.error
        least, most = self.value - chance, self.value + chance
        if within[0] < least and most < within[1]:
            return True
        return False if most < within[0] or least > within[1] else None


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
    number: Estimate
    within: Interval = POSITIVE  #: where it has to lie: above zero, or around a number
    words: str = ""  #: written in place of quantity and number
    elsewhere: Mapping[str, Estimate] = field(default_factory=dict)  #: by what was chosen instead
    ours: str = ""  #: parameters that the paper does not give and that we chose; only listed
    reason: str = ""  #: why it does not hold, if it does not

    @property
    def verdict(self) -> Verdict:
        """That of its number, unless the number at another choice contradicts it."""
        holds = self.number.lies(self.within)
        if {True, False} <= {holds, *(at.lies(self.within) for at in self.elsewhere.values())}:
            return "cannot be decided"
        return _OUTCOMES.get(holds, "undecided")

    @property
    def details(self) -> dict[str, str]:
        """What there is to say about it, by what it is."""
        high, centre = self.within[1], sum(self.within) / 2
        limit = f" (limit {high:g})" if centre == 0 else ""
        others = []
        for choice, number in self.elsewhere.items():
            told = _OUTCOMES.get(number.lies(self.within))
            others.append(f"{choice}: {number}" + (f", {told}" if told else ""))
        texts = {
            "verdict": self.verdict,
            "in the paper": self.source,
            "its number": f"{centre:g}" if centre and math.isfinite(centre) else "",
            "found here": self.words or f"{self.quantity} {self.number}{limit}".strip(),
            "our choice, not given in the paper": self.ours,
            "at other choices": "; ".join(others),
            "why": "" if self.verdict == "reproduced" else self.reason,
        }
        return {name: text for name, text in texts.items() if text}


# -- what a claim takes of measured numbers, as its keywords ----------------------------------


def at_choices(
    choices: Mapping[str, Choice], measured: Callable[[Choice], Estimate | dict[str, Any]]
) -> dict[str, Any]:
    """Return what is measured at our choice, the first one, and the numbers ``elsewhere``.

    A choice is, for instance, the time step, by a name such as ``"dt = 0.01"``. ``measured`` gives
    a number, or what :func:`worst` and :func:`in_plot` return.
    """
    ours, *others = (
        found if isinstance(found := measured(choice), dict) else {"number": found}
        for choice in choices.values()
    )
    elsewhere = zip(list(choices)[1:], others, strict=True)
    return ours | {"elsewhere": {name: other["number"] for name, other in elsewhere}}


def worst(quantity: str, differences: Iterable[Estimate], limit: float) -> dict[str, Any]:
    """Return the difference that decides whether two things are the same to ``limit``.

    The largest of many numbers lies further off by chance than a single one does. The errors are
    therefore enlarged so that chance exceeds three of them in any of the differences as rarely as
    it exceeds three in one number: by 1.1 for two differences, by 1.6 for a thousand.
    """
    measured = list(differences)
    chance = float(norm.isf(norm.sf(_SIGNIFICANT) / len(measured))) / _SIGNIFICANT
    within = around(0.0, limit)
    number = _decisive([Estimate(value, error * chance) for value, error in measured], within)
    largest = max((abs(value) / error for value, error in measured if error > 0), default=math.nan)
    words = (
        f"{quantity}: {Estimate(number.value, number.error / chance)}, the worst of "
        f"{len(measured)} (limit {limit:g}); largest difference {largest:.1f} standard errors"
    )
    return {"number": number, "within": within, "words": words}


def _decisive(numbers: Sequence[Estimate], within: Interval) -> Estimate:
    """Return the number that decides whether all lie inside, which need not be the largest one.

    It is one that lies outside or, if there is none, one of which its error does not allow to say.
    """
    order = {True: 0, None: 1, False: 2}
    return max(numbers, key=lambda number: (order[number.lies(within)], abs(number.value)))


def furthest_in_plot(distances: Array, errors: Array) -> Estimate:
    """Return the distance, a share of the plotted range, that decides :func:`in_plot`."""
    return _decisive(list(map(Estimate, distances.tolist(), errors.tolist())), around(0.0, EYE))


def in_plot(quantity: str, distance: Estimate, vertical: float | None = None) -> dict[str, Any]:
    """Return what decides whether an eye could see that a curve misses the points.

    That a curve "matches" points, or that they "can be fitted" or "described" by it, is a statement
    about a plot. ``distance`` is that of a symbol from the nearest point of the curve in the plane
    of the plot, as a share of the plotted range (``distances_in_plot``); of several symbols
    :func:`furthest_in_plot`. It has to be below ``EYE``. Beside a steep line it is far shorter than
    the ``vertical`` one, of which the largest, that of another symbol perhaps, is told in standard
    errors.
    """
    words = (
        f"{quantity}: the symbol that decides is {distance.times(100)} % of the plotted range away "
        f"from the nearest point of the line (visible: {100 * EYE:g} %)"
    )
    if vertical is not None:
        words += f"; the largest vertical distance is {vertical:.1f} standard errors"
    return {"number": distance, "within": around(0.0, EYE), "words": words}
