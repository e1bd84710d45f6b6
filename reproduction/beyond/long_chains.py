"""Long chains at e = 0: how the centre's velocities, force and correlation length grow with L.

Simulations have the default time step. The theory with pair correlations goes to 1000 rods.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.fits import fit_border_power_law
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.model import Chain, chain_of
from crazybilliards.model.chain import middle_tenth
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.tables import Table, Tables
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim
from crazybilliards.reproduction.correlated_rods import correlation_length, neighbours, sizes

_HEADS = {  # of the tables
    "W_v": "$W_v/W$",
    "relative": r"$\sqrt{\Theta}/W$",
    "common": r"$\sqrt{h_c}/W$",
    "force": "$P/ks$",
    "xi": r"$\xi$",
}
_FIRST = 100  # rods from which on the common part is compared with a power
_GUESSED = -0.25  # the power that is guessed for it

Quantities = dict[str, Estimate]  # the error is 0 in theory


def cases(quality: Quality) -> Cases:
    """E = 0, L = 30 to 3000: simulation and theory."""
    cases: Cases = {}
    for size in sizes(quality):
        cases |= neighbours(size, 0.0, quality)
    return cases


def _both(results: Results) -> dict[str, dict[int, Quantities]]:
    """Return the quantities of theory and simulation by length."""
    found: dict[str, dict[int, Quantities]] = {"theory": {}, "simulation": {}}
    for result in results.values():
        kind = "simulation" if _simulated(result) else "theory"
        found[kind][chain_of(result).size] = _quantities(result)
    return found


def _simulated(result: xr.Dataset) -> bool:
    return "velocity_width_error" in result


def _quantities(result: xr.Dataset) -> Quantities:
    """Return roots of temperatures in the centre over W, the force there over k s, and xi."""
    return {
        "W_v": _root(result, "velocity_width", 2),
        "relative": _root(result, "relative_temperature", 1),
        "common": _root(result, "neighbour_covariance", 1),
        "force": _force(result),
        "xi": correlation_length(result),
    }


def _root(result: xr.Dataset, name: str, power: int) -> Estimate:
    """Return the root of the mean of values to a power over the middle tenth, over W."""
    values, width = result[name].values, chain_of(result).free_velocity_width
    middle = middle_tenth(values.size)  # of L rods, or of L - 1 contacts
    value = float(np.sqrt((values[middle] ** power).mean()))
    if not _simulated(result):
        return Estimate(value / width, 0.0)
    # Neighbouring rods err together.
    errors = power * result[f"{name}_error"].values[middle] * values[middle] ** (power - 1)
    return Estimate(value / width, float(errors.mean() / (2 * value)) / width)


def _force(result: xr.Dataset) -> Estimate:
    """Return the force in the centre, which balances the springs of half of the chain."""
    chain = chain_of(result)
    half, unit = chain.size // 2, chain.thermal_length
    displaced = result.mean_displacement.values / unit
    force = float(displaced[::-1][:half].sum() - displaced[:half].sum()) / 2
    if not _simulated(result):
        return Estimate(force, 0.0)
    errors = result.mean_displacement_error.values / unit
    return Estimate(force, float(errors[:half].sum()) / math.sqrt(2))


def _slope(found: Mapping[int, Quantities], name: str, small: int, large: int) -> Estimate:
    """Return the slope of the logarithm of a quantity between two lengths."""
    one, other = found[small][name], found[large][name]
    span = math.log(large / small)
    error = math.hypot(one.error / one.value, other.error / other.value) / span
    return Estimate(math.log(other.value / one.value) / span, error)


def _printed(number: Estimate) -> str:
    value, error = number
    return f"{value:.4g} ± {error:.2g}" if error else f"{value:.4g}"


def tables(results: Results) -> Tables:
    """Give the quantities of every length and their slopes; a guess of xi, and nu of the theory."""
    theories, runs = _both(results).values()
    fits = {
        chain_of(theory).size: fit_border_power_law(theory)
        for theory in results.values()
        if not _simulated(theory)
    }
    exponents = {
        size: f"{fit.exponent:.3f} ± {fit.exponent_error:.3f}" for size, fit in fits.items()
    }
    guesses = {size: f"{_guess(size, found['force'].value):.1f}" for size, found in runs.items()}
    return {
        "long_chains_simulation": _table(runs, r"$\sqrt{2/3}\,P/\Gamma$", guesses),
        "long_chains_theory": _table(theories, r"$\nu$", exponents),
    }


def _guess(size: int, force: float) -> float:
    """Return what the correlation length would be if collisions took all energy."""
    chain = Chain(size=size)
    return math.sqrt(2 / 3) * force * math.sqrt(chain.stiffness * chain.mass) / chain.damping


def _table(found: Mapping[int, Quantities], last: str, values: Mapping[int, str]) -> Table:
    """Return quantities and one more column, then slopes."""
    rows = [["L", *_HEADS.values(), last]]
    rows += [
        [f"{size}", *(_printed(each[name]) for name in _HEADS), values[size]]
        for size, each in found.items()
    ]
    for one, other in pairwise(found):
        slopes = [_slope(found, name, one, other) for name in _HEADS]
        shown = [_printed(each._replace(value=round(each.value, 3))) for each in slopes]
        rows.append([f"{one} → {other}", *shown, ""])
    return rows


def claims(results: Results) -> list[Claim]:
    """Check: two parts of W_v with two slopes; force and relative motion of the theory."""
    theories, runs = _both(results).values()
    shortest, longest = min(runs), max(runs)
    steeper = _slope(runs, "common", shortest, longest).minus(
        _slope(runs, "relative", shortest, longest)
    )
    found = [
        positive_claim(
            "the common motion of neighbours falls more slowly with L than the relative one",
            "difference of the slopes",
            steeper,
        )
    ]
    if longest > _FIRST:
        slope = _slope(runs, "common", _FIRST, longest)
        found.append(
            positive_claim(
                f"the root of the covariance of neighbours falls faster than L^{_GUESSED:g}",
                f"{_GUESSED:g} less the slope from L = {_FIRST}",
                Estimate(_GUESSED - slope.value, slope.error),
            )
        )
    for size, theory in theories.items():
        for name, words in (("force", "force is too small"), ("relative", "neighbours are slow")):
            found.append(
                positive_claim(
                    f"the theory's {words}, L = {size}",
                    "simulation less theory",
                    runs[size][name].minus(theory[name]),
                )
            )
    return found


def draw(results: Results) -> Figure:
    """Draw the five quantities against L."""
    theories, runs = _both(results).values()
    figure, axes = panels(1, 3, height=2.6)
    for number, name in enumerate(("W_v", "relative", "common")):
        _draw(axes[0], theories, runs, name, number=number, label=_HEADS[name])
    for ax, name in zip(axes[1:], ("force", "xi"), strict=True):
        _draw(ax, theories, runs, name, number=0, label="")
    axes[0].set_ylabel("in the centre")
    axes[1].set_ylabel("force $P$ in the centre [$ks$]")
    axes[2].set_ylabel(r"correlation length $\xi$ [rods]")
    for ax in axes:
        ax.set(xscale="log", yscale="log", xlabel="rods $L$")
        ax.set_xticks(list(runs), [f"{size}" for size in runs])
        ax.xaxis.set_minor_formatter("")
    legend_above(figure, axes[0], "symbols: simulation, lines: theory")
    return figure


def _draw(
    ax: Axes,
    theories: Mapping[int, Quantities],
    runs: Mapping[int, Quantities],
    name: str,
    *,
    number: int,
    label: str,
) -> None:
    values, errors = np.transpose([each[name] for each in runs.values()])
    draw_points(ax, list(runs), values, errors, number=number, label=label)
    ax.plot(list(theories), [each[name].value for each in theories.values()], color=COLOURS[number])


STUDY = Study(
    name="long-chains",
    title="Long chains at e = 0: powers of the length",
    caption="Perfectly inelastic chains against their length. (a) Roots of the temperature, of the "
    "relative temperature of neighbours and of their covariance, in the middle tenth, over the "
    "width W of a free rod. (b) Force in the centre. (c) Correlation length of the velocities. "
    "Symbols: simulation at the default time step. Lines: theory with pair correlations.",
    cases=cases,
    draw=draw,
    claims=claims,
    tables=tables,
)
