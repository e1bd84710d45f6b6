"""Runs and theories that several figures share, with what each quality grants them.

The paper's parameters throughout: gamma = k = A = 1, g = 0 unless said.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.repetition import Granted, Runs
from crazybilliards.reproduction.claims.study import Cases, Quality, Results

LARGE = 1000  # the paper's longest chains
SIZES = (10, 30, 100, 300, LARGE)
RESTITUTIONS = (0.0, 0.5, 0.75, 0.85, 0.92, 0.95)
STEPS = (1e-2, 3e-3, 1e-3)  # at which the perfectly inelastic chain runs besides the default one

OTHER_STEP = 1e-2  # at which the others do, to see whether the step decides a claim

# By the number of rods from which on it is granted. The longest chains have warm-ups of their own:
# W_v and <dx> of 1000 rods that start at their anchors are steady, to 2 %, after 20 time units at
# e = 0 and 0.95. The relaxation time, 8.4, is that of the motion of all rods together.
_DISSIPATIVE: dict[int, Granted] = {
    1: {"quick": (4, {"duration": 1000.0}), "full": (8, {"duration": 24_000.0})},
    101: {"quick": (4, {"duration": 500.0}), "full": (8, {"duration": 6000.0})},
    LARGE: {
        "quick": (4, {"duration": 40.0, "warmup": 20.0}),
        "full": (10, {"duration": 500.0, "warmup": 50.0}),
    },
}
# At e = 0 runs cost less than at other restitutions below 1, and more statements depend on them.
# Up to 30 rods they are long enough to tell exponents of -0.45 and -0.46 apart.
_INELASTIC: dict[int, Granted] = {
    1: {**_DISSIPATIVE[1], "full": (8, {"duration": 400_000.0})},
    31: _DISSIPATIVE[1],
    101: {**_DISSIPATIVE[101], "full": (20, {"duration": 6000.0})},
    LARGE: {**_DISSIPATIVE[LARGE], "full": (30, {"duration": 500.0, "warmup": 50.0})},
}
# At the largest restitution widths fluctuate for longer: whether the fit misses a rod there needs
# more runs.
_LARGEST: Granted = {**_DISSIPATIVE[LARGE], "full": (24, {"duration": 500.0, "warmup": 50.0})}
# Runs at the second restitution cost most, and other amplitudes are compared with all the runs at
# A = 1. So many decide what they can decide.
_FEWER: Granted = {**_DISSIPATIVE[LARGE], "full": (6, {"duration": 500.0, "warmup": 50.0})}
_AT_STEP: dict[int, Granted] = {
    1: {"quick": (4, {"duration": 400.0}), "full": (6, {"duration": 6000.0})},
    100: {"quick": (4, {"duration": 400.0}), "full": (6, {"duration": 3000.0})},
    101: {"quick": (4, {"duration": 100.0}), "full": (6, {"duration": 1500.0})},
    LARGE: {
        "quick": (4, {"duration": 40.0, "warmup": 20.0}),
        "full": (6, {"duration": 800.0, "warmup": 50.0}),
    },
}
_ENOUGH = 8, {"duration": 50_000.0}  # which takes a quarter of a second, so that both can afford it
_ELASTIC: Granted = {"quick": _ENOUGH, "full": _ENOUGH}
_FLIPPERS: Granted = {"quick": (4, {"duration": 1000.0}), "full": (8, {"duration": 8000.0})}
# Whether the fit of a power law to the profile of these, (size, damping), misses a rod needs more.
_MOST_FLIPPERS = (100, 4.0)
_FLIPPERS_LONG: Granted = {**_FLIPPERS, "full": (32, {"duration": 8000.0})}
_AGAIN: Granted = {
    "quick": (4, {"duration": 40.0, "warmup": 20.0}),
    "full": (4, {"duration": 200.0, "warmup": 50.0}),
}
_FLIPPERS_AGAIN: Granted = {"quick": (4, {"duration": 300.0}), "full": (4, {"duration": 1500.0})}


def _granted(by_size: Mapping[int, Granted], size: int) -> Granted:
    return by_size[max(least for least in by_size if least <= size)]


def dissipative(size: int, restitution: float, amplitude: float = 1.0) -> Runs:
    """Return runs of a dissipative chain at the default time step."""
    granted = _granted(_DISSIPATIVE if restitution else _INELASTIC, size)
    if (size, restitution, amplitude) == (LARGE, RESTITUTIONS[-1], 1):
        granted = _LARGEST
    if size == LARGE and (amplitude != 1 or restitution == RESTITUTIONS[1]):
        granted = _FEWER
    return Runs(
        f"L={size} e={restitution:g} A={amplitude:g}",
        Chain(size=size, restitution=restitution, amplitude=amplitude),
        granted,
        {"observe": ["widths", "velocities"]},
    )


def at_step(size: int, step: float | None) -> Runs:
    """Return runs of the perfectly inelastic chain at a fixed time step; None: the default one."""
    if step is None:
        return dissipative(size, 0.0)
    return Runs(
        f"L={size} dt={step:g}",
        Chain(size=size, restitution=0.0),
        _granted(_AT_STEP, size),
        {"time_step": step, "observe": ["widths", "velocities"]},
    )


def at_other_step(runs: Runs) -> Runs:
    """Return runs of the same chain of 1000 rods, or of flippers, at the step ``OTHER_STEP``."""
    chain = runs.chain
    if chain == Chain(size=LARGE, restitution=0.0):
        return at_step(LARGE, OTHER_STEP)
    return runs.at_step(OTHER_STEP, _FLIPPERS_AGAIN if chain.restitution > 1 else _AGAIN)


def at_steps(sizes: Iterable[int] = SIZES) -> list[Runs]:
    """Return :func:`at_step` at the default step and at every fixed one."""
    return [at_step(size, step) for size in sizes for step in (None, *STEPS)]


def chain_step(results: Results, size: int) -> float:
    """Return the default time step of that size, as the result records it."""
    run = at_step(size, None).members(results)[0]
    return float(json.loads(run.attrs["provenance"])["schedule"]["time_step"])


def flippers(size: int, damping: float) -> Runs:
    """Return runs at e = 1.05, with collision rates and avalanches."""
    return Runs(
        f"L={size} gamma={damping:g}",
        Chain(size=size, restitution=1.05, damping=damping),
        _FLIPPERS_LONG if (size, damping) == _MOST_FLIPPERS else _FLIPPERS,
        {"observe": ["widths", "velocities", "collisions", "avalanches", "triggered-collisions"]},
    )


def elastic(size: int) -> Runs:
    """Return runs at e = 1 at the default time step."""
    return Runs(f"L={size} e=1", Chain(size=size), _ELASTIC, {"observe": ["widths", "velocities"]})


class Theory(NamedTuple):
    """A theory of one chain, which is solved on a coarser mesh at quick quality."""

    name: str
    job: str
    chain: Chain
    coarse: Mapping[str, Any]  # the settings of quick quality; full quality has the default ones

    def cases(self, quality: Quality) -> Cases:
        """Return its case."""
        return {self.name: Case(self.job, self.chain, self.coarse if quality == "quick" else {})}


def kinetic_equation(size: int, restitution: float, damping: float = 1.0) -> Theory:
    """Return the kinetic equation; quick: on a coarser mesh, half a per cent off."""
    return Theory(
        f"theory L={size} e={restitution:g} gamma={damping:g}",
        "phase_space",
        Chain(size=size, restitution=restitution, damping=damping),
        {"cells": 16},
    )


def correlated_equation(size: int, restitution: float) -> Theory:
    """Return the kinetic equation with pair correlations."""
    return Theory(
        f"theory of pairs L={size} e={restitution:g}",
        "correlated_phase_space",
        Chain(size=size, restitution=restitution),
        {"cells": 22},
    )
