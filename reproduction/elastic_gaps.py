"""Elastic chains with gaps: simulated and exact displacements.

At e = 1 the stationary state is known exactly for any gap g. With linear springs it is that of R.
J. Baxter's one-dimensional plasma (Math. Proc. Camb. Phil. Soc. 59, 779 (1963)), and with g = 0 the
rods are order statistics of one Gaussian. The paper compares with theory only without gaps.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, Study
from crazybilliards.reproduction.claims.verdicts import EYE, Claim, Estimate, worst

_GAPS = (0.0, 0.5, 2.0)
_DURATION = {"quick": 500_000.0, "full": 1_000_000.0}
_QUANTITIES = {
    "mean_displacement": r"displacement $\langle\Delta x\rangle/s$",
    "displacement_width": "width $W_x/s$",
}


def cases(quality: Quality) -> Cases:
    """L = 50, e = 1, three gaps: the simulation and the exact equilibrium of each."""
    settings = {"duration": _DURATION[quality], "observe": ["widths"]}
    cases: Cases = {}
    for gap in _GAPS:
        chain = Chain(size=50, gap=gap)
        cases[f"rods g={gap:g}"] = Case("simulate", chain, settings)
        cases[f"exact g={gap:g}"] = Case("equilibrium", chain, {})
    return cases


def claims(results: Results) -> list[Claim]:
    """Check: the mean and the width of every rod's displacement are the exact ones."""
    symbols = {"mean_displacement": "<dx>", "displacement_width": "W_x"}
    return [_exact(results, gap, *each) for gap in _GAPS for each in symbols.items()]


def _exact(results: Results, gap: float, name: str, symbol: str) -> Claim:
    rods, exact = results[f"rods g={gap:g}"], results[f"exact g={gap:g}"]
    s = chain_of(rods).thermal_length
    difference, error = (rods[name] - exact[name]) / s, rods[f"{name}_error"] / s
    differences = map(Estimate, difference.values, error.values)
    return Claim(
        f"{symbol} of every rod is the exact one, g = {gap:g}",
        **worst(f"{symbol} of a rod less the exact one, in units of s", differences, EYE),
    )


def draw(results: Results) -> Figure:
    """Draw <dx> and W_x of the rods as symbols and the exact ones as lines."""
    figure, axes = panels(2, 1, height=1.9, wanted=1, sharex=True)
    for number, gap in enumerate(_GAPS):
        rods, exact = results[f"rods g={gap:g}"], results[f"exact g={gap:g}"]
        s = chain_of(rods).thermal_length
        for ax, name in zip(axes, _QUANTITIES, strict=True):
            draw_rods(ax, rods, name, number=number, unit=s, label=f"$g = {gap:g}$")
            ax.plot(exact.normalized_particle, exact[name] / s, color=COLOURS[number], zorder=3)
    for ax, label in zip(axes, _QUANTITIES.values(), strict=True):
        ax.set_ylabel(label)
    along_the_chain(axes[1])
    axes[1].set_ylim(bottom=0)
    axes[0].plot([], [], color="0.4", label="exact")
    legend_above(figure, axes[0])
    return figure


STUDY = Study(
    name="elastic-gaps",
    title="Displacements of elastic chains with gaps",
    caption="Mean and standard deviation of each rod's displacement from its anchor, in thermal "
    "lengths s, at e = 1, L = 50 and three gaps g (in radii R). Symbols: simulation. Lines: exact "
    "equilibrium.",
    cases=cases,
    draw=draw,
    claims=claims,
)
