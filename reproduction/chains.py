"""Runs that several figures share, with the durations that each quality grants them.

The paper's parameters throughout: gamma = k = A = 1, g = 0 unless said.
"""

from __future__ import annotations

from typing import Any

from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.repetition import repeated
from crazybilliards.reproduction.claims.study import Cases, Quality

LARGE = 1000  # the paper's longest chains
SIZES = (10, 30, 100, 300, LARGE)
RESTITUTIONS = (0.0, 0.5, 0.75, 0.85, 0.92, 0.95)

# Quick and full: number of runs, and the time each is measured.
_SHORT_CHAINS = {"quick": (4, 1000.0), "full": (8, 6000.0)}
_LONG_CHAINS = {"quick": (4, 50.0), "full": (5, 400.0)}
_WARMUP = {"quick": 50.0, "full": 100.0}  # of long chains: six and twelve relaxation times


def dissipative(size: int, restitution: float, quality: Quality, amplitude: float = 1.0) -> Cases:
    """Return runs of a dissipative chain at the default time step, named by its parameters."""
    chain = Chain(size=size, restitution=restitution, amplitude=amplitude)
    name = dissipative_name(size, restitution, amplitude)
    observe = ["widths", "velocities"]
    if size < LARGE:
        number, duration = _SHORT_CHAINS[quality]
        duration *= 0.5 if size > 100 else 1.0
        return repeated(name, chain, number, duration=duration, observe=observe)
    number, duration = _LONG_CHAINS[quality]
    return repeated(
        name, chain, number, duration=duration, warmup=_WARMUP[quality], observe=observe
    )


def dissipative_name(size: int, restitution: float, amplitude: float = 1.0) -> str:
    """Return the name under which :func:`dissipative` runs go."""
    return f"L={size} e={restitution:g} A={amplitude:g}"


def flippers(size: int, damping: float, quality: Quality) -> Cases:
    """Return runs at e = 1.05, with collision rates and avalanches."""
    chain = Chain(size=size, restitution=1.05, damping=damping)
    number, duration = {"quick": (3, 1000.0), "full": (8, 8000.0)}[quality]
    return repeated(
        flippers_name(size, damping),
        chain,
        number,
        duration=duration,
        observe=["widths", "velocities", "collisions", "avalanches", "triggered-collisions"],
    )


def flippers_name(size: int, damping: float) -> str:
    """Return the name under which :func:`flippers` runs go."""
    return f"L={size} gamma={damping:g}"


def elastic(size: int, quality: Quality, **settings: Any) -> Cases:
    """Return runs at e = 1 at the default time step."""
    number, duration = {"quick": (4, 5000.0), "full": (8, 50_000.0)}[quality]
    observe = ["widths", "velocities"]
    chain = Chain(size=size)
    return repeated(
        elastic_name(size), chain, number, duration=duration, observe=observe, **settings
    )


def elastic_name(size: int) -> str:
    """Return the name under which :func:`elastic` runs go."""
    return f"L={size} e=1"


def kinetic_equation(size: int, restitution: float, damping: float, quality: Quality) -> Cases:
    """Return the prediction of the kinetic equation; quick: on a coarser mesh, half a per cent."""
    chain = Chain(size=size, restitution=restitution, damping=damping)
    settings = {"cells": 16} if quality == "quick" else {}
    return {kinetic_name(size, restitution, damping): Case("phase_space", chain, settings)}


def correlated_equation(size: int, restitution: float, quality: Quality) -> Cases:
    """Return the prediction of the kinetic equation with pair correlations.

    Quick: on a coarser mesh.
    """
    chain = Chain(size=size, restitution=restitution)
    settings = {"cells": 22} if quality == "quick" else {}
    return {correlated_name(size, restitution): Case("correlated_phase_space", chain, settings)}


def correlated_name(size: int, restitution: float) -> str:
    """Return the name of :func:`correlated_equation`."""
    return f"theory of pairs L={size} e={restitution:g}"


def kinetic_name(size: int, restitution: float, damping: float) -> str:
    """Return the name of :func:`kinetic_equation`."""
    return f"theory L={size} e={restitution:g} gamma={damping:g}"
