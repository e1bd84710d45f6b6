"""What the kinetic equation, without and with pair correlations, says of figures 3, 7 and 9."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import xarray as xr
from matplotlib.axes import Axes

from crazybilliards.comparison.drawing import COLOURS
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.widths import central_width, width_deviation
from crazybilliards.model import chain_of
from crazybilliards.reproduction.chains import (
    LARGE,
    RESTITUTIONS,
    correlated_equation,
    correlated_name,
    dissipative_name,
    kinetic_equation,
    kinetic_name,
)
from crazybilliards.reproduction.claims.repetition import estimate, pooled
from crazybilliards.reproduction.claims.study import Cases, Quality, Results
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, small_claim

SIZES = (30, 100, 300, LARGE)  # of chains at e = 0
_OF_INDEPENDENT = {"quick": (0.95,), "full": (0.85, 0.92, 0.95)}
_OF_PAIRS = {"quick": (0.95,), "full": RESTITUTIONS}
_SIZES_OF_PAIRS = {"quick": (30,), "full": SIZES}

INDEPENDENT, PAIRS = "kinetic equation", "with pair correlations"
PAIRS_ALONE = "theory with pairs"  # in a figure without the other theory and with less room
LINES = {INDEPENDENT: "--", PAIRS: "-"}
CROSSES: dict[str, dict[str, Any]] = {
    INDEPENDENT: {"marker": "x", "linestyle": "none", "color": COLOURS[4]},
    PAIRS: {"marker": "+", "linestyle": "none", "color": COLOURS[2]},
}
_REASONS = {
    INDEPENDENT: "correlations of velocities, which the theory leaves out, grow with L (1 - e)",
    PAIRS: "the theory is linear in fluctuations, and in long chains those of gaps are as large as "
    "their means",
}
_CLAIMED = {INDEPENDENT: f"the {INDEPENDENT}", PAIRS: f"the {INDEPENDENT} {PAIRS}"}

Theories = dict[str, dict[float, xr.Dataset]]  # by name, then by restitution


def by_restitution(quality: Quality) -> Cases:
    """Return the theories of L = 1000."""
    cases: Cases = {}
    for restitution in _OF_INDEPENDENT[quality]:
        cases |= kinetic_equation(LARGE, restitution, 1.0, quality)
    for restitution in _OF_PAIRS[quality]:
        cases |= correlated_equation(LARGE, restitution, quality)
    return cases


def predicted(results: Results) -> Theories:
    """Return the results of :func:`by_restitution`."""
    names = {
        INDEPENDENT: {e: kinetic_name(LARGE, e, 1.0) for e in RESTITUTIONS},
        PAIRS: {e: correlated_name(LARGE, e) for e in RESTITUTIONS},
    }
    return {
        theory: {e: results[name] for e, name in of_theory.items() if name in results}
        for theory, of_theory in names.items()
    }


def by_size(quality: Quality) -> Cases:
    """Return the theory with pair correlations at e = 0."""
    cases: Cases = {}
    for size in _SIZES_OF_PAIRS[quality]:
        cases |= correlated_equation(size, 0.0, quality)
    return cases


def predicted_by_size(results: Results) -> dict[int, xr.Dataset]:
    """Return the results of :func:`by_size`."""
    names = {size: correlated_name(size, 0.0) for size in SIZES}
    return {size: results[name] for size, name in names.items() if name in results}


def minus_nu(theory: xr.Dataset) -> float:
    """Return the exponent of the power laws from the borders."""
    return -fit_border_power_law(theory).exponent


def exponent_of_size(results: Results, size: int) -> str:
    """Return nu of the theory at e = 0, for a claim."""
    theories = predicted_by_size(results)
    return f"{PAIRS} {-minus_nu(theories[size]):.3f}" if size in theories else ""


def draw_widths_by_size(ax: Axes, results: Results) -> None:
    """Draw W_v(i)/W of the theory at e = 0 as dotted lines."""
    for size, theory in predicted_by_size(results).items():
        widths = theory.velocity_width / chain_of(theory).free_velocity_width
        ax.plot(theory.particle, widths, ":", color=COLOURS[SIZES.index(size)], zorder=4)
    ax.plot([], [], ":", color="0.4", label=PAIRS_ALONE)


def listed(found: Theories, value: Callable[[xr.Dataset], float], *restitutions: float) -> str:
    """List ``value(theory)`` of every theory at the restitutions, for a claim."""
    texts = []
    for name, theories in found.items():
        there = {e: value(theories[e]) for e in restitutions if e in theories}
        if there:
            values = ", ".join(f"{e:g}: {each:.3f}" for e, each in there.items())
            texts.append(values if name == INDEPENDENT else f"{name} {values}")
    return "; ".join(texts)


def centre_claims(results: Results) -> list[Claim]:
    """Check W_v in the centre of L = 1000 against both theories."""
    claims = []
    for name_of_theory, theories in predicted(results).items():
        for e, theory in theories.items():
            name = dissipative_name(LARGE, e)
            deviation = width_deviation(pooled(results, name), theory)
            # Rods of the centre move together: only runs are independent.
            centre = estimate(results, name, central_width)
            claims.append(
                small_claim(
                    f"{_CLAIMED[name_of_theory]} gives W_v in the centre, e = {e:g}",
                    "relative deviation",
                    Estimate(deviation.centre, centre.error / centre.value),
                    0.05,
                    theory="nothing fitted",
                    reason=_REASONS[name_of_theory],
                )
            )
    return claims
