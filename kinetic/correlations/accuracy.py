"""How far the theory is from simulations: the largest errors in its two tables in docs/tables.

    python benchmarks/correlations.py FOLDER [--held-out]

measures them: velocity widths of chains of 10 to 600 rods, with gamma from 0.4 to 3. Those of 1000
rods are from the figures of the paper. They are errors of the theory, not of its solution.
"""

from __future__ import annotations

from typing import NamedTuple

_SHORT = 300  # rods
# Restitution: largest relative error of W_v over particles 3 to L - 2, and of the first and last.
_OF_SHORT = {
    1.0: (0.0002, 0.0002),
    0.97: (0.010, 0.002),
    0.95: (0.010, 0.002),
    0.9: (0.017, 0.009),
    0.82: (0.026, 0.018),
    0.75: (0.023, 0.035),
    0.62: (0.033, 0.036),
    0.5: (0.058, 0.063),
    0.2: (0.067, 0.070),
    0.0: (0.119, 0.113),
}
_OF_LONG = {
    1.0: (0.0002, 0.0002),
    0.97: (0.015, 0.010),
    0.95: (0.019, 0.011),
    0.92: (0.012, 0.005),
    0.85: (0.026, 0.027),
    0.82: (0.025, 0.035),
    0.75: (0.039, 0.043),
    0.62: (0.051, 0.058),
    0.5: (0.098, 0.074),
    0.2: (0.133, 0.122),
    0.0: (0.226, 0.157),
}


class Accuracy(NamedTuple):
    """Relative errors of W_v to expect."""

    inner: float  # particles 3 to L - 2
    border: float  # the first and the last


def expected_accuracy(restitution: float, size: int) -> Accuracy:
    """Return the larger errors of the two measured restitutions on both sides of this one."""
    measured = _OF_SHORT if size <= _SHORT else _OF_LONG
    above = min(e for e in measured if e >= restitution)
    below = max(e for e in measured if e <= restitution)
    inner, border = (max(pair) for pair in zip(measured[above], measured[below], strict=True))
    return Accuracy(inner, border)
