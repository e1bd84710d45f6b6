"""How many rods move together: runs and theories of neighbours, and the correlation length."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction.claims.study import Cases, Quality
from crazybilliards.reproduction.claims.verdicts import Estimate

SNAPPED = 100  # rods of the chains whose snapshots are kept
# Time units that a chain is measured.
_DURATIONS = {30: 8000.0, 100: 6000.0, 300: 3000.0, 1000: 1000.0, 3000: 300.0}
_QUICK = {30: 2000.0, 100: 500.0}
_MOST_RODS = 1000  # that the theory takes
# Cells on which the theory's widths are right to a few per mille, and on which to a per cent.
CELLS = {"quick": 11, "full": 22}
_DRAWN = 100  # spectra, for the error of the length


def sizes(quality: Quality, longest: int = 3000) -> tuple[int, ...]:
    """Return the lengths that are simulated."""
    return tuple(size for size in (_QUICK, _DURATIONS)[quality == "full"] if size <= longest)


def neighbours(size: int, restitution: float, quality: Quality) -> Cases:
    """Return a run at the default time step, and the theory with pair correlations if it can."""
    chain = Chain(size=size, restitution=restitution)
    raw = ["snapshots"] if size == SNAPPED else []
    settings: dict[str, Any] = {
        "duration": (_QUICK, _DURATIONS)[quality == "full"][size],
        "every": 0.5,
        "observe": ["widths", "covariances", "modes", *raw],
    }
    cases = {rods_name(size, restitution): Case("simulate", chain, settings)}
    if size <= _MOST_RODS:
        cases[theory_name(size, restitution)] = Case(
            "correlated_phase_space", chain, {"cells": CELLS[quality]}
        )
    return cases


def rods_name(size: int, restitution: float) -> str:
    """Return the name of the run in :func:`neighbours`."""
    return f"rods L={size} e={restitution:g}"


def theory_name(size: int, restitution: float) -> str:
    """Return the name of the theory in :func:`neighbours`."""
    return f"theory L={size} e={restitution:g}"


def correlation_length(result: xr.Dataset) -> Estimate:
    """Return the correlation length xi in rods, from the spectrum of the velocities.

    Correlations exp(-r/xi) have the spectrum S = S_inf + (S_0 - S_inf)/(1 + (k xi)^2) with
    k = pi q/L; here xi is 1/k where a spectrum lies halfway between S_0, which is that of the
    centre of mass, and its shortest waves. Its standard error, 0 in theory, is that under
    independent errors of all modes.
    """
    spectrum = result.mode_velocity_variance.values
    length = _length(result, spectrum)
    if "mode_velocity_variance_error" not in result:
        return Estimate(length, 0.0)
    generator = np.random.default_rng(0)
    noise = generator.normal(size=(_DRAWN, spectrum.size))
    noise *= result.mode_velocity_variance_error.values
    return Estimate(length, float(np.std([_length(result, spectrum + each) for each in noise])))


def _length(result: xr.Dataset, spectrum: np.ndarray) -> float:
    chain = chain_of(result)
    wave = np.pi * result.mode.values / chain.size
    short = spectrum[-max(3, spectrum.size // 10) :].mean()
    whole = chain.free_velocity_width**2
    shares = (spectrum - short) / (whole - short)
    shares[0] = 1.0  # the centre of mass is mode 0
    first = int(np.argmax(shares[1:] < 0.5)) + 1
    between = [first, first - 1]
    return float(1 / np.interp(0.5, shares[between], wave[between]))
