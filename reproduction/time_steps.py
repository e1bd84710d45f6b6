"""The perfectly inelastic chain at fixed time steps: what the step does to the exponents."""

from __future__ import annotations

import json

from crazybilliards.model import Chain
from crazybilliards.reproduction.chains import SIZES, dissipative, dissipative_name
from crazybilliards.reproduction.claims.repetition import repeated
from crazybilliards.reproduction.claims.study import Cases, Quality, Results

STEPS = (1e-2, 3e-3, 1e-3)
_DURATION = {"quick": (4, 100.0), "full": (6, 1500.0)}


def at_steps(quality: Quality, sizes: tuple[int, ...] = SIZES) -> Cases:
    """Return runs at every fixed step and at the default one."""
    number, duration = _DURATION[quality]
    cases: Cases = {}
    for size in sizes:
        cases |= dissipative(size, 0.0, quality)
        for step in STEPS:
            chain = Chain(size=size, restitution=0.0)
            cases |= repeated(
                step_name(size, step),
                chain,
                number,
                duration=duration if size > 100 else 4 * duration,
                time_step=step,
                observe=["widths"],
            )
    return cases


def step_name(size: int, step: float | None) -> str:
    """Return the name of the runs at a step; None: the default one."""
    return dissipative_name(size, 0.0) if step is None else f"L={size} dt={step:g}"


def chain_step(results: Results, size: int) -> float:
    """Return the default time step of that size, as the result records it."""
    run = results[f"{step_name(size, None)}/0"]
    return float(json.loads(run.attrs["provenance"])["schedule"]["time_step"])
