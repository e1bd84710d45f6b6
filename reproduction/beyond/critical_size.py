"""The critical size of driven chains, e > 1: kinetic equation and simulation.

Simulated: tau = W^2 L/sum W_v(i)^2, the free energy over the chain's, falls to zero at the critical
size; a parabola through five sizes just below finds where.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points
from crazybilliards.comparison.layout import panels
from crazybilliards.comparison.sweeps import Case
from crazybilliards.kinetic.kinetic_equation.criticality import critical_size
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_critical_size
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.tables import Tables
from crazybilliards.reproduction.claims.verdicts import Claim, Estimate, positive_claim, small_claim

_SIMULATED = {  # restitution and damping
    "quick": ((1.05, 1.0),),
    "full": ((1.05, 1.0), (1.05, 2.0), (1.05, 4.0), (1.1, 4.0)),
}
_DURATION = {"quick": 2000.0, "full": 100_000.0}
_NEAR = (0.82, 0.855, 0.88, 0.9, 0.92)  # sizes, as shares of the closed form
_LEAST = 3  # sizes that a parabola needs
_LEAST_ERROR = 0.5  # rods: a size is a whole number

_LINES = {1.02: "-", 1.05: "--", 1.1: "-."}  # by restitution
_DAMPINGS = (0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0)
_CLOSED_FORM = 0.03  # what the kinetic equation may be off it: three of its own errors
_BEYOND = {2.0: 1, 4.0: -1}  # by damping: the sign of simulated less predicted critical size


def cases(quality: Quality) -> Cases:
    """E > 1: chains of five sizes just below the critical one."""
    settings = {"duration": _DURATION[quality]}
    cases: Cases = {}
    for restitution, damping in _SIMULATED[quality]:
        chain = Chain(restitution=restitution, damping=damping)
        critical = weak_damping_critical_size(chain)
        for size in sorted({round(share * critical) for share in _NEAR}):
            name = f"e={restitution:g} gamma={damping:g} L={size}"
            cases[name] = Case("simulate", chain.replace(size=size), settings)
    return cases


def _simulated(results: Results) -> dict[tuple[float, float], Estimate]:
    """Return the simulated critical sizes by restitution and damping."""
    runs: dict[tuple[float, float], list[xr.Dataset]] = {}
    for run in results.values():
        chain = chain_of(run)
        runs.setdefault((chain.restitution, chain.damping), []).append(run)
    return {each: _critical(of_one) for each, of_one in runs.items()}


def _critical(runs: list[xr.Dataset]) -> Estimate:
    """Return the size at which tau, extrapolated, reaches zero, and its error.

    The error is the difference to a straight line.
    """
    sizes, shares, errors = [], [], []
    for run in runs:
        if run.attrs["status"] != "completed":
            break  # diverged: no steady state from this size on
        chain = chain_of(run)
        sizes.append(chain.size)
        shares.append(chain.free_velocity_width**2 / float((run.velocity_width**2).mean()))
        relative = np.mean((2 * run.velocity_width_error / run.velocity_width) ** 2)
        errors.append(shares[-1] * math.sqrt(relative))
    if len(sizes) < _LEAST:
        return Estimate(math.nan, math.nan)
    line, parabola = (
        min((root.real for root in np.roots(fit) if root.real > sizes[-1]), default=math.nan)
        for fit in (np.polyfit(sizes, shares, n, w=1 / np.array(errors)) for n in (1, 2))
    )
    return Estimate(float(parabola), max(float(abs(line - parabola)), _LEAST_ERROR))


@cache  # tables, claims and picture take the same numbers
def _predicted(restitution: float, damping: float) -> tuple[Estimate, float]:
    """Return the critical size of the kinetic equation, and that of the closed form."""
    chain = Chain(restitution=restitution, damping=damping)
    return Estimate(*critical_size(chain)), weak_damping_critical_size(chain)


def tables(results: Results) -> Tables:
    """Give the critical sizes of both theories and of the simulation."""
    rows = [["e", "gamma", "kinetic equation", "closed form", "simulation"]]
    for (restitution, damping), found in _simulated(results).items():
        theory, closed = _predicted(restitution, damping)
        both = [f"{each.value:.1f} ± {each.error:.1f}" for each in (theory, found)]
        rows.append([f"{restitution:g}", f"{damping:g}", both[0], f"{closed:.1f}", both[1]])
    return {"critical_size": rows}


def claims(results: Results) -> list[Claim]:
    """Check: the closed form is right; simulated chains diverge earlier only at strong damping."""
    claims = []
    for (restitution, damping), found in _simulated(results).items():
        theory, closed = _predicted(restitution, damping)
        where = f"e = {restitution:g}, gamma = {damping:g}"
        claims.append(
            small_claim(
                f"the kinetic equation gives the closed form of the critical size, {where}",
                "L_c over the closed form, less 1:",
                Estimate(theory.value / closed - 1, theory.error / closed),
                _CLOSED_FORM,
            )
        )
        if sign := _BEYOND.get(damping):
            side = "larger" if sign > 0 else "smaller"
            claims.append(
                positive_claim(
                    f"simulated chains diverge at a {side} size than the equation says, {where}",
                    f"rods by which it is {side}:",
                    Estimate(sign * (found.value - theory.value), found.minus(theory).error),
                )
            )
    return claims


def draw(results: Results) -> Figure:
    """Draw the critical size against the damping; the lines take a quarter of a minute."""
    measured = _simulated(results)
    figure, [ax] = panels(1, 1, height=2.9, wanted=1)
    for number, (e, line) in enumerate(_LINES.items()):
        theory = [_predicted(e, damping)[0].value for damping in _DAMPINGS]
        label = f"kinetic equation, $e = {e:g}$"
        ax.plot(_DAMPINGS, theory, line, color=COLOURS[number], label=label)
    for number, e in enumerate(_LINES):
        found = [(damping, *each) for (one, damping), each in measured.items() if one == e]
        if found:
            draw_points(ax, *np.transpose(found), number=number, label=f"simulation, $e = {e:g}$")
    ax.text(0.97, 0.02, "steady states below the lines", ha="right", transform=ax.transAxes)
    ax.set(xlabel=r"damping $\gamma$ [$\sqrt{kM}$]", ylabel="number of rods $L$")
    ax.set(xlim=(0, 5.1), ylim=(0, 420))
    ax.legend(loc="upper left")
    return figure


STUDY = Study(
    name="critical-size",
    title="The critical size of driven chains",
    caption="Lines: the number of rods above which a driven chain (e > 1) has no steady state, by "
    "the kinetic equation. Symbols: where the inverse of the mean energy of simulated chains, "
    "extrapolated from smaller sizes by a parabola, reaches zero.",
    cases=cases,
    draw=draw,
    claims=claims,
    tables=tables,
)
