"""Where the kinetic equation holds, without and with pair correlations: its errors of W_v and W_x.

Relative errors against restitution and size. The full quality takes some two hours on one core.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.layout import entitle, legend_above, panels
from crazybilliards.comparison.widths import (
    WidthDeviation,
    border_width,
    central_width,
    width_deviation,
)
from crazybilliards.reproduction.checked_chains import Checked, Group, checked
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.tables import Tables, percent
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim, same_claim
from crazybilliards.reproduction.errors_of_theories import Error, draw_errors

_TABLES = {
    "correlations_held_out": (Group.HELD_OUT,),
    "correlations_derived_with": (Group.DERIVED_WITH, Group.OF_FIGURES, Group.HELD_OUT_EARLIER),
}
_LEAST_DRAWN = 30  # rods, if not held out: chains of 10 are in the tables only
_GOALS = {"in the centre": 0.025, "of the border": 0.05}  # of W_v, up to 300 rods
_LONGEST = 300
_SLOW = 20  # L (1 - e) from which on W_v without correlations is too small


def cases(quality: Quality) -> Cases:
    """Chains without correlations, held out, derived with, of figures: runs and theories."""
    cases: Cases = {}
    for each in checked(quality):
        cases |= each.cases(quality)
    return cases


def _found(results: Results) -> list[Checked]:
    """Return the chains that these are results of."""
    return [each for each in checked("full") if f"{each.runs.name}/0" in results]


def _deviations(results: Results, each: Checked) -> list[WidthDeviation]:
    """Return those of the theory without correlations, and of that with them if it is checked."""
    run = each.runs.pooled(results)
    names = [each.independent]
    if each.group != Group.INDEPENDENT:
        names.append(each.with_pairs)
    return [width_deviation(run, results[name]) for name in names]


def _relative_errors(results: Results, each: Checked, deviation: WidthDeviation) -> list[float]:
    """Return the standard errors of W_v in the centre and at the border of the simulation."""
    if each.group == Group.INDEPENDENT:  # one run: the error of a rod bounds that of the centre
        return [deviation.error] * 2
    widths = [each.runs.estimate(results, width) for width in (central_width, border_width)]
    return [width.error / width.value for width in widths]


def tables(results: Results) -> Tables:
    """Give the errors without correlations, then both theories' for every group of chains."""
    found = _found(results)
    errors = ["centre, %", "border, %", "largest, %", "error of a rod, %"]
    alone = [each for each in found if each.group == Group.INDEPENDENT]
    rows = [_row(results, each) for each in alone if each.chain.gap == 0]
    tables = {"kinetic_equation": [["e", "L", "gamma", *errors], *rows]}
    rows = [_row(results, each) for each in alone if each.chain.gap > 0]
    tables["kinetic_equation_gaps"] = [["e", "L", "g L/s", "gamma", *errors], *rows]
    heads = ["L", "e", "gamma"]
    heads += [
        f"W_v {place}{which}, %"
        for place in ("centre", "border", "largest")
        for which in (" without", "")
    ]
    heads += ["rods 3 to 10, %", "error of the centre, a rod, the border, %"]
    heads += ["Theta/T centre", "Theta/T border"]
    heads += [f"W_x {which}, %" for which in ("rod 1", "rods 2 to L/2", "largest")]
    for name, groups in _TABLES.items():
        rows = [_row_of_both(results, each) for each in found if each.group in groups]
        tables[name] = [heads, *rows]
    return tables


def _row(results: Results, each: Checked) -> list[str]:
    chain, [found] = each.chain, _deviations(results, each)
    return [
        f"{chain.restitution:g}",
        f"{chain.size}",
        *([f"{chain.gap * chain.size / chain.thermal_length:.0f}"] if chain.gap else []),
        f"{chain.damping:g}",
        percent(found.centre),
        percent(found.border),
        f"{100 * found.largest:.1f}",
        f"{100 * found.error:.1f}",
    ]


def _row_of_both(results: Results, each: Checked) -> list[str]:
    chain, both = each.chain, _deviations(results, each)
    centre, border = _relative_errors(results, each, both[-1])
    errors = (centre, both[-1].error, border)
    theory, run = results[each.with_pairs], each.runs.pooled(results)
    slow, wide = (
        getattr(theory, name).values / _even(getattr(run, name).values) - 1
        for name in ("velocity_width", "displacement_width")
    )
    half = chain.size // 2
    return [
        f"{chain.size}",
        f"{chain.restitution:g}",
        f"{chain.damping:g}",
        *(percent(found.centre) for found in both),
        *(percent(found.border) for found in both),
        *(f"{100 * found.largest:.1f}" for found in both),
        percent(slow[2 : min(10, half)].mean()),
        ", ".join(f"{100 * error:.1f}" for error in errors),
        *_temperatures(theory, run),
        percent(wide[0]),
        percent(wide[1:half].mean()),
        f"{100 * np.abs(wide).max():.1f}",
    ]


def _temperatures(theory: xr.Dataset, run: xr.Dataset) -> list[str]:
    """Return Theta/T at the contact in the centre and at the first: of the theory, measured."""
    if "relative_temperature" not in run:  # runs of figures
        return ["", ""]
    shares = [_even(each.relative_temperature.values) for each in (theory, run)]
    shares = [
        relative / (relative + _even(each.neighbour_covariance.values))
        for relative, each in zip(shares, (theory, run), strict=True)
    ]
    middle = run.sizes["particle"] // 2 - 1
    return [", ".join(f"{share[place]:.3f}" for share in shares) for place in (middle, 0)]


def _even(values: np.ndarray) -> np.ndarray:
    return (values + values[::-1]) / 2


def claims(results: Results) -> list[Claim]:
    """Check: too slow without correlations; the goals that were set for chains held out."""
    held_out = [each for each in _found(results) if each.group == Group.HELD_OUT]
    claims = []
    for each in held_out:
        [before, _], chain = _deviations(results, each), each.chain
        if chain.size * (1 - chain.restitution) >= _SLOW:
            error, _ = _relative_errors(results, each, before)
            claims.append(
                positive_claim(
                    "without correlations rods in the centre are too slow, "
                    f"L = {chain.size}, e = {chain.restitution:g}, gamma = {chain.damping:g}",
                    "1 less theory over simulation:",
                    Estimate(-before.centre, error),
                )
            )
    both = [_with_pairs(results, each) for each in held_out if each.chain.size <= _LONGEST]
    for number, (place, goal) in enumerate(_GOALS.items()):
        claims.append(
            same_claim(
                f"with correlations W_v {place} is right to {goal:.1%}, L <= {_LONGEST}",
                "relative deviation",
                [each[number] for each in both],
                goal,
            )
        )
    return claims


def _with_pairs(results: Results, each: Checked) -> tuple[Estimate, Estimate]:
    """Return the deviations of W_v in the centre and at the border with correlations."""
    _, after = _deviations(results, each)
    centre, border = _relative_errors(results, each, after)
    return Estimate(after.centre, centre), Estimate(after.border, border)


def _errors(results: Results, *, with_pairs: bool) -> list[Error]:
    """Return what is drawn of a theory: each chain of the usual damping once, and driven ones."""
    drawn: dict[tuple[int, float], Error] = {}
    for each in _found(results):
        chain = each.chain
        usual = chain.damping == 1 or chain.restitution > 1
        place = chain.size, chain.restitution
        deviations = _deviations(results, each)
        held_out = each.group == Group.HELD_OUT
        if not usual or chain.gap or len(deviations) <= with_pairs:
            continue
        if each.group == Group.HELD_OUT_EARLIER or not (held_out or chain.size >= _LEAST_DRAWN):
            continue
        found = deviations[with_pairs]
        centre, border = _relative_errors(results, each, found)
        drawn.setdefault(
            place,
            Error(
                chain=chain,
                centre=100 * found.centre,
                border=100 * found.border,
                centre_error=100 * centre,
                border_error=100 * border,
                held_out=held_out,
            ),
        )
    return list(drawn.values())


def draw(results: Results) -> Figure:
    """Draw the errors of both theories in the centre and at the border."""
    both = [_errors(results, with_pairs=with_pairs) for with_pairs in (False, True)]
    drawn = [each for errors in both for each in errors if not (each.driven or each.held_out)]
    sizes = sorted({each.chain.size for each in drawn})
    figure, axes = panels(2, 2, height=2.6, sharex=True, sharey=True)
    for number, ax in enumerate(axes):
        which = ("centre", "border")[number % 2]
        draw_errors(ax, both[number // 2], which, sizes)
        theory = ("without pair correlations", "with pair correlations")[number // 2]
        entitle(ax, f"{which}, {theory}")
    for ax in axes[2:]:
        ax.set_xlabel(r"restitution $e$, linear in $\sqrt{1 - e}$ up to 1")
    for ax in axes[::2]:
        ax.set_ylabel("$W_v$: theory $-$ simulation [%]\n(negative: too small)")
    legend_above(figure, axes[0])
    return figure


STUDY = Study(
    name="validity",
    title="Where the kinetic equation holds",
    caption="Relative difference of W_v in theory from W_v in simulations, negative where W_v of "
    "the theory is too small. (a), (b): the kinetic equation, corrected for the centre of mass. "
    "(c), (d): with pair correlations; full symbols are chains that were simulated only after that "
    "theory was final. Grey symbols: e = 1.05. The axis of the error is linear in the shaded band "
    "and logarithmic beyond. Bars: standard errors of the simulations. Lines join the symbols.",
    cases=cases,
    draw=draw,
    claims=claims,
    tables=tables,
)
