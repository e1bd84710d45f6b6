"""How far the theory is from simulations: the largest errors in the table of its page.

    python benchmarks/correlations.py FOLDER

measures them: velocity widths of chains of 10 to 300 rods, gamma = 1,
and of 100 rods with gamma = 0.5 and 3. They are errors of the theory, not of its numerical
solution.
"""

from __future__ import annotations

from typing import NamedTuple

# Restitution: largest relative error of W_v over particles 3 to L - 2, and of the first and last.
_MEASURED = {
    1.0: (0.0002, 0.0002),
    0.95: (0.010, 0.003),
    0.9: (0.018, 0.010),
    0.75: (0.023, 0.035),
    0.5: (0.058, 0.063),
    0.0: (0.105, 0.100),
}


class Accuracy(NamedTuple):
    """Relative errors of W_v to expect."""

    inner: float  # particles 3 to L - 2
    border: float  # the first and the last


def expected_accuracy(restitution: float) -> Accuracy:
    """Return the larger errors of the two measured restitutions on both sides of this one."""
    above = min(e for e in _MEASURED if e >= restitution)
    below = max(e for e in _MEASURED if e <= restitution)
    inner, border = (max(pair) for pair in zip(_MEASURED[above], _MEASURED[below], strict=True))
    return Accuracy(inner, border)
