"""From which length on has a driven chain, e > 1, no steady state? Theory and simulation.

    python -m studies.critical_size FOLDER

Simulated: tau = W^2 L/sum W_v(i)^2, the free energy over the chain's, falls to zero at the critical
size; a parabola through five sizes just below finds where. Takes a quarter of an hour on one core.
"""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, draw_points, panels
from crazybilliards.comparison.sweeps import Case
from crazybilliards.kinetic import critical_size
from crazybilliards.model import Chain, chain_of
from studies.common import Results, Table, carry_out

SIMULATED = ((1.05, 1.0), (1.05, 2.0), (1.05, 4.0), (1.1, 4.0))  # restitution, damping
DURATION = 100_000.0
NEAR = (0.82, 0.855, 0.88, 0.9, 0.92)  # sizes, as shares of the theory's
LEAST = 3  # sizes that a parabola needs
LEAST_ERROR = 0.5  # rods: a size is a whole number
LINES = {1.02: "-", 1.05: "--", 1.1: "-."}  # by restitution
DAMPINGS = (0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0)  # of the lines


def cases() -> dict[str, Case]:
    found = {}
    for restitution, damping in SIMULATED:
        chain = Chain(restitution=restitution, damping=damping)
        critical = critical_size(chain).value
        for size in sorted({round(share * critical) for share in NEAR}):
            name = f"e={restitution:g} gamma={damping:g} L={size}"
            found[name] = Case("simulate", chain.replace(size=size), {"duration": DURATION})
    return found


def simulated(results: Results) -> dict[tuple[float, float], tuple[float, float]]:
    """Return critical sizes and their errors by restitution and damping."""
    runs: dict[tuple[float, float], list[xr.Dataset]] = {}
    for run in results.values():
        chain = chain_of(run)
        runs.setdefault((chain.restitution, chain.damping), []).append(run)
    return {each: zero_of_tau(of_one) for each, of_one in runs.items()}


def zero_of_tau(runs: list[xr.Dataset]) -> tuple[float, float]:
    """Return the size at which tau, extrapolated, is zero; its error: that of a straight line."""
    sizes, shares, errors = [], [], []
    for run in runs:
        if run.attrs["status"] != "completed":
            break  # diverged: no steady state from this size on
        chain = chain_of(run)
        sizes.append(chain.size)
        shares.append(chain.free_velocity_width**2 / float((run.velocity_width**2).mean()))
        relative = np.mean((2 * run.velocity_width_error / run.velocity_width) ** 2)
        errors.append(shares[-1] * math.sqrt(relative))
    if len(sizes) < LEAST:
        return math.nan, math.nan
    line, parabola = (
        min((root.real for root in np.roots(fit) if root.real > sizes[-1]), default=math.nan)
        for fit in (np.polyfit(sizes, shares, n, w=1 / np.array(errors)) for n in (1, 2))
    )
    return float(parabola), max(float(abs(line - parabola)), LEAST_ERROR)


def tables(results: Results) -> dict[str, Table]:
    rows = [["e", "gamma", "theory", "simulation"]]
    for (restitution, damping), found in simulated(results).items():
        chain = Chain(restitution=restitution, damping=damping)
        theory, (size, error) = critical_size(chain).value, found
        row = f"{restitution:g}", f"{damping:g}", f"{theory:.1f}", f"{size:.1f} ± {error:.1f}"
        rows.append(list(row))
    return {"critical_size": rows}


def draw(results: Results) -> Figure:
    figure, [ax] = panels(1, 1, height=2.9)
    for number, (e, line) in enumerate(LINES.items()):
        chains = [Chain(restitution=e, damping=damping) for damping in DAMPINGS]
        theory = [critical_size(chain).value for chain in chains]
        label = f"theory, $e = {e:g}$"
        ax.plot(DAMPINGS, theory, line, color=COLOURS[number], label=label)
    for number, e in enumerate(LINES):
        found = [
            (damping, *size) for (one, damping), size in simulated(results).items() if one == e
        ]
        if found:
            draw_points(ax, *np.transpose(found), number=number, label=f"simulation, $e = {e:g}$")
    ax.text(0.97, 0.02, "steady states below the lines", ha="right", transform=ax.transAxes)
    ax.set(xlabel=r"damping $\gamma$ [$\sqrt{kM}$]", ylabel="number of rods $L$")
    ax.set(xlim=(0, 5.1), ylim=(0, 420))
    ax.legend(loc="upper left")
    return figure


if __name__ == "__main__":
    carry_out(__doc__, cases(), tables, draw)
