"""About how long the stationary theories compute: on one core, within a factor of three."""

from __future__ import annotations

import math

from crazybilliards.model import Chain


def expected_seconds(theory: str, chain: Chain) -> float:
    """Return the computing time of a theory, by the name of its function [s]."""
    # From e = 1 to the chain in steps, each with 2.5 times the drag.
    steps = 1 + math.log1p(abs(1 - chain.restitution) * chain.size) / math.log(2.5)
    return {
        "equilibrium": 1e-3 * chain.size,
        "force_balance": 0.03,
        "phase_space": 0.4 * steps,
        "correlated_phase_space": 1.0 * steps,
    }[theory]
