"""How far the kinetic equations are from simulations: the errors in docs/tables.

    crazybilliards reproduce validity --quality full
    python benchmarks/accuracy/relaxation_error.py

measure them for the steady state, in time, and with pair correlations: chains without gap on linear
springs. They are errors of the theories, not of their numerical solutions.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

import numpy as np

from crazybilliards.model import Chain

# phase_space. By size and restitution: largest relative error of W_v over particles 3 to L - 2, and
# of the first and last. gamma = 1; at e = 1 the theory is exact.
_DISSIPATIVE = {
    30: {
        0.0: (0.145, 0.037),
        0.5: (0.073, 0.045),
        0.75: (0.011, 0.024),
        0.9: (0.019, 0.010),
        0.95: (0.010, 0.001),
        0.98: (0.003, 0.001),
        1.0: (0.0, 0.0),
    },
    100: {
        0.0: (0.263, 0.043),
        0.5: (0.196, 0.056),
        0.75: (0.099, 0.039),
        0.9: (0.012, 0.016),
        0.95: (0.008, 0.014),
        0.98: (0.007, 0.001),
        1.0: (0.0, 0.0),
    },
    300: {
        0.0: (0.355, 0.039),
        0.5: (0.284, 0.037),
        0.75: (0.184, 0.050),
        0.9: (0.064, 0.028),
        0.95: (0.017, 0.021),
        0.98: (0.004, 0.010),
        1.0: (0.0, 0.0),
    },
    1000: {
        0.0: (0.436, 0.007),
        0.5: (0.367, 0.011),
        0.75: (0.256, 0.022),
        0.9: (0.131, 0.003),
        0.95: (0.057, 0.003),
        0.98: (0.016, 0.008),
        1.0: (0.0, 0.0),
    },
}
# gamma/sqrt(k m): between these the damping changes the errors of 100 rods by less than a half.
_DAMPINGS = 0.24, 1.5
# gamma = 4.
_DRIVEN = {
    30: {1.0: (0.0, 0.0), 1.05: (0.005, 0.008)},
    60: {1.0: (0.0, 0.0), 1.05: (0.006, 0.013)},
    100: {1.0: (0.0, 0.0), 1.05: (0.022, 0.019)},
}
_LEAST_DRIVEN_DAMPING = 1.95

# relax_phase_space. By size and restitution: largest relative error of the kinetic energy at any
# time, after a release from equilibrium at e = 1, as it is and with y times 0.4. With 100 rods at
# e = 0.8 the mesh does not resolve f.
_TRANSIENT = {
    10: {0.8: 0.069, 0.9: 0.059, 0.95: 0.046, 1.0: 0.0},
    30: {0.8: 0.109, 0.9: 0.054, 0.95: 0.022, 1.0: 0.0},
    100: {0.8: np.nan, 0.9: 0.113, 0.95: 0.040, 1.0: 0.0},
}
_TRANSIENT_DAMPINGS = 0.29, 0.49  # gamma/sqrt(k m); gamma = 0.6 and 1
# gamma = 4.
_DRIVEN_TRANSIENT = {
    10: {1.0: 0.0, 1.05: 0.027},
    30: {1.0: 0.0, 1.05: 0.031},
}
_DRIVEN_TRANSIENT_DAMPINGS = 1.95, 1.96

# correlated_phase_space, chains of 10 to 300 rods and of more, gamma from 0.4 to 3. By restitution:
# the same two errors of W_v as of phase_space. Those of 1000 rods are from figures of the paper.
_SHORT = 300
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

_Number = TypeVar("_Number", int, float)
_Measured = TypeVar("_Measured", float, tuple[float, float])


class Accuracy(NamedTuple):
    """Relative errors of W_v to expect; NaN where none was measured."""

    inner: float  # particles 3 to L - 2
    border: float  # the first and the last


def expected_accuracy(chain: Chain) -> Accuracy:
    """Return the largest errors of ``phase_space`` on the measured chains around this one."""
    if chain.restitution == 1:
        return Accuracy(0.0, 0.0)
    driven = chain.restitution > 1
    around = _around(
        chain,
        _DRIVEN if driven else _DISSIPATIVE,
        (_LEAST_DRIVEN_DAMPING, np.inf) if driven else _DAMPINGS,
    )
    return _largest(around) if around else Accuracy(np.nan, np.nan)


def expected_correlated_accuracy(chain: Chain) -> Accuracy:
    """Return the larger errors of ``correlated_phase_space`` at the two restitutions around it."""
    measured = _OF_SHORT if chain.size <= _SHORT else _OF_LONG
    return _largest([measured[e] for e in _neighbours(chain.restitution, list(measured))])


def expected_transient_error(chain: Chain) -> float:
    """Return the relative error of the kinetic energy in time to expect; NaN if none was measured.

    It is the largest of the measured chains on all sides of this one. Without a gap and at e = 1
    the equation is exact.
    """
    if chain.restitution == 1 and chain.gap == 0:
        return 0.0
    driven = chain.restitution > 1
    around = _around(
        chain,
        _DRIVEN_TRANSIENT if driven else _TRANSIENT,
        _DRIVEN_TRANSIENT_DAMPINGS if driven else _TRANSIENT_DAMPINGS,
    )
    return float(np.max(around)) if around else np.nan


def _largest(errors: list[tuple[float, float]]) -> Accuracy:
    return Accuracy(*map(max, zip(*errors, strict=True)))


def _around(
    chain: Chain, table: dict[int, dict[float, _Measured]], dampings: tuple[float, float]
) -> list[_Measured]:
    """Return the errors of the measured chains on all sides of this one; none beyond them."""
    restitutions = list(next(iter(table.values())))
    damping = chain.damping / np.sqrt(chain.stiffness * chain.mass)
    measured = (
        dampings[0] <= damping <= dampings[1]
        and min(table) <= chain.size <= max(table)
        and min(restitutions) <= chain.restitution <= max(restitutions)
    )
    if chain.gap != 0 or chain.spring != "linear" or not measured:
        return []
    return [
        table[size][e]
        for size in _neighbours(chain.size, list(table))
        for e in _neighbours(chain.restitution, restitutions)
    ]


def _neighbours(value: _Number, measured: list[_Number]) -> tuple[_Number, _Number]:
    """Return the measured values on both sides of this one, which may be the same."""
    return max(m for m in measured if m <= value), min(m for m in measured if m >= value)
