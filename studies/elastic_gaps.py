"""Are rods of elastic chains with gaps where the exact solution has them? Simulations beside it.

    python -m studies.elastic_gaps FOLDER

At e = 1 the stationary state is known exactly for any gap g. With linear springs it is that of R.
J. Baxter's one-dimensional plasma (Math. Proc. Camb. Phil. Soc. 59, 779 (1963)), and with g = 0 the
rods are order statistics of one Gaussian. The paper compares with theory only without gaps. The
table has the largest differences of all rods, in thermal lengths s and in standard errors. The
picture has simulations as symbols and the exact solution as lines.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.comparison.sweeps import Case
from crazybilliards.model import Chain, chain_of
from studies.common import Results, Table, carry_out

GAPS = (0.0, 0.5, 2.0)
SETTINGS = {"duration": 1_000_000, "observe": ["widths"]}
QUANTITIES = {
    "mean_displacement": r"displacement $\langle\Delta x\rangle/s$",
    "displacement_width": "width $W_x/s$",
}


def cases() -> dict[str, Case]:
    chains = {gap: Chain(size=50, gap=gap) for gap in GAPS}
    return {f"rods {gap}": Case("simulate", chain, SETTINGS) for gap, chain in chains.items()} | {
        f"exact {gap}": Case("equilibrium", chain, {}) for gap, chain in chains.items()
    }


def differences(results: Results, gap: float, name: str) -> list[str]:
    rods, exact = results[f"rods {gap}"], results[f"exact {gap}"]
    difference, s = abs(rods[name] - exact[name]), chain_of(rods).thermal_length
    largest = float((difference / rods[f"{name}_error"]).max())
    return [f"{gap:g}", name, f"{float(difference.max() / s):.4f}", f"{largest:.1f}"]


def tables(results: Results) -> dict[str, Table]:
    heads = ["gap", "quantity", "largest difference, s", "largest difference, standard errors"]
    rows = [differences(results, gap, name) for gap in GAPS for name in QUANTITIES if results]
    return {"elastic_gaps": [heads, *rows]}


def draw(results: Results) -> Figure:
    figure, axes = panels(2, 1, height=1.9, wanted=1, sharex=True)
    for number, gap in enumerate(GAPS):
        rods, exact = results[f"rods {gap}"], results[f"exact {gap}"]
        s = chain_of(rods).thermal_length
        for ax, name in zip(axes, QUANTITIES, strict=True):
            draw_rods(ax, rods, name, number=number, unit=s, label=f"$g = {gap:g}$")
            ax.plot(exact.normalized_particle, exact[name] / s, color=COLOURS[number], zorder=3)
    for ax, label in zip(axes, QUANTITIES.values(), strict=True):
        ax.set_ylabel(label)
    along_the_chain(axes[1])
    axes[1].set_ylim(bottom=0)
    axes[0].plot([], [], color="0.4", label="exact")
    legend_above(figure, axes[0])
    return figure


if __name__ == "__main__":
    carry_out(__doc__, cases(), tables, draw)
