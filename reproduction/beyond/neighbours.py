"""How far neighbours remember: correlation lengths and covariances of velocities."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.layout import entitle, legend_above, panels
from crazybilliards.model import chain_of
from crazybilliards.model.chain import middle_tenth
from crazybilliards.reproduction.claims.repetition import error_of_mean
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.tables import Tables
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim, small_claim
from crazybilliards.reproduction.correlated_rods import (
    SNAPPED,
    correlation_length,
    neighbours,
    rods_name,
    sizes,
    theory_name,
)

_RESTITUTIONS = {"quick": (0.95, 0.0), "full": (0.95, 0.9, 0.75, 0.5, 0.0)}
_LONGEST = 1000
_BLOCKS = 16  # of the snapshots in time, whose scatter gives errors
_SEPARATIONS = 14  # that are drawn
_AGREE = 0.1  # of the correlation length, near e = 1
_NEAR_ONE = 0.9

Pair = tuple[xr.Dataset, xr.Dataset]  # simulation and theory


def cases(quality: Quality) -> Cases:
    """Five restitutions, L = 30 to 1000: simulation and theory."""
    cases: Cases = {}
    for e in _RESTITUTIONS[quality]:
        for size in sizes(quality, _LONGEST):
            cases |= neighbours(size, e, quality)
    return cases


def _pairs(results: Results) -> dict[float, dict[int, Pair]]:
    """Return simulation and theory by restitution and length."""
    found: dict[float, dict[int, Pair]] = {}
    for e in _RESTITUTIONS["full"]:
        for size in sizes("full", _LONGEST):
            if (rods := rods_name(size, e)) in results:
                pair = results[rods], results[theory_name(size, e)]
                found.setdefault(e, {})[size] = pair
    return found


def _in_the_centre(result: xr.Dataset) -> Estimate:
    """Return <v_i v_i+1>/T at the contacts of the middle tenth; its error is 0 in theory."""
    own = result.velocity_width.values**2
    own = (own[1:] + own[:-1]) / 2
    middle = middle_tenth(own.size)
    temperature = own[middle].mean()
    share = float(result.neighbour_covariance.values[middle].mean() / temperature)
    if "neighbour_covariance_error" not in result:
        return Estimate(share, 0.0)
    # Neighbouring contacts err together.
    error = result.neighbour_covariance_error.values[middle].mean()
    return Estimate(share, float(error / temperature))


def tables(results: Results) -> Tables:
    """Give correlation lengths, covariances of neighbours, and how many rods move together."""
    rows = [["e", "L", *_columns("xi"), *_columns("h_c/T centre"), "W^2/<v^2>, simulation"]]
    for e, by_size in _pairs(results).items():
        for size, (run, theory) in by_size.items():
            length, shared = correlation_length(run), _in_the_centre(run)
            free = chain_of(run).free_velocity_width
            together = free**2 / float((run.velocity_width**2).mean())
            rows.append(
                [
                    f"{e:g}",
                    f"{size}",
                    f"{length.value:.1f} ± {length.error:.1f}",
                    f"{correlation_length(theory).value:.1f}",
                    f"{shared.value:.3f} ± {shared.error:.3f}",
                    f"{_in_the_centre(theory).value:.3f}",
                    f"{together:.2f}",
                ]
            )
    return {"correlation_lengths": rows}


def _columns(quantity: str) -> list[str]:
    return [f"{quantity}, simulation", f"{quantity}, theory"]


def claims(results: Results) -> list[Claim]:
    """Check: the theory's lengths are right near e = 1 and too short at e = 0."""
    found = []
    for e, by_size in _pairs(results).items():
        for size, (run, theory) in by_size.items():
            where = f"e = {e:g}, L = {size}"
            length, predicted = correlation_length(run), correlation_length(theory).value
            if e >= _NEAR_ONE:
                found.append(
                    small_claim(
                        f"the theory's correlation length is right, {where}",
                        "theory over simulation, less 1:",
                        Estimate(
                            predicted / length.value - 1, predicted * length.error / length.value**2
                        ),
                        _AGREE,
                    )
                )
            if e == 0:
                shared, expected = _in_the_centre(run), _in_the_centre(theory).value
                found += [
                    positive_claim(
                        f"the theory's correlation length is too short, {where}",
                        "rods by which it is:",
                        Estimate(length.value - predicted, length.error),
                    ),
                    positive_claim(
                        f"the theory's covariance of neighbours is too large, {where}",
                        "theory less simulation, over the temperature:",
                        Estimate(expected - shared.value, shared.error),
                    ),
                ]
    return found


def draw(results: Results) -> Figure:
    """Draw correlation lengths, covariances of neighbours, and covariances against distance."""
    figure, axes = panels(1, 3, height=2.6)
    for number, (e, by_size) in enumerate(_pairs(results).items()):
        for ax, value in zip(axes, (correlation_length, _in_the_centre), strict=False):
            values, errors = np.transpose([value(run) for run, _ in by_size.values()])
            draw_points(ax, list(by_size), values, errors, number=number, label=f"$e = {e:g}$")
            lines = [value(theory).value for _, theory in by_size.values()]
            ax.plot(list(by_size), lines, color=COLOURS[number])
        _draw_covariances(axes[2], by_size[SNAPPED][0], number)
    for ax in axes[:2]:
        shown = list(next(iter(_pairs(results).values())))
        ax.set(xscale="log", xlabel="rods $L$")
        ax.set_xticks(shown, [f"{size}" for size in shown])
        ax.xaxis.set_minor_formatter("")
    axes[0].set(yscale="log", ylabel=r"correlation length $\xi$ [rods]")
    axes[1].set(ylim=(0, 1), ylabel=r"$\langle v_i v_{i+1}\rangle/T$, centre")
    axes[2].set(ylim=(0, 0.75), xlabel="separation $r$ [rods]")
    axes[2].set(ylabel=r"$\langle v_i v_{i+r}\rangle/T$, centre")
    entitle(axes[2], f"$L = {SNAPPED}$")
    legend_above(figure, axes[0], "symbols: simulation, lines: theory")
    return figure


def _draw_covariances(ax: Axes, run: xr.Dataset, number: int) -> None:
    """Draw covariances of rods at equal distances from the centre, over their temperatures."""
    size = run.sizes["particle"]
    v, widths = run.velocity.values.reshape(-1, size), run.velocity_width.values
    separations = np.unique(np.geomspace(1, size // 2, _SEPARATIONS).astype(int))
    values, errors = [], []
    for r in separations:
        first = np.arange((size - r) // 2 - size // 20, (size - r) // 2 + size // 20 + 1)
        temperature = (widths[first] * widths[first + r]).mean()
        products = (v[:, first] * v[:, first + r]).mean(axis=1) / temperature
        values.append(products.mean())
        errors.append(error_of_mean([part.mean() for part in np.array_split(products, _BLOCKS)]))
    draw_points(ax, separations, values, errors, number=number)


STUDY = Study(
    name="neighbours",
    title="How far neighbours remember",
    caption="(a) Correlation length of the velocities. (b) Covariance of neighbours in the centre, "
    "over the temperature. (c) Covariance of two rods in the middle of 100 rods against their "
    "distance, over the temperature. Symbols: simulation, with standard errors. Lines in (a) and "
    "(b): theory with pair correlations.",
    cases=cases,
    draw=draw,
    claims=claims,
    tables=tables,
)
