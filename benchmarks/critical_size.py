"""The critical size of driven chains: kinetic equation and simulation in one phase diagram.

    python benchmarks/critical_size.py FIGURE.png

Simulated: tau = W^2 L/sum W_v(i)^2, the free energy over the chain's, falls to zero at the critical
size; a parabola through five sizes just below finds where. Takes about half an hour on one core.
"""

import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np

from crazybilliards.comparison.layout import house_style, panels
from crazybilliards.kinetic import critical_size
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

RESTITUTIONS = ((1.02, "#0072B2", "-"), (1.05, "#E69F00", "--"), (1.1, "#009E73", "-."))
DAMPINGS = (0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0)
SIMULATED = ((1.05, 1.0), (1.05, 2.0), (1.05, 4.0), (1.1, 4.0))
NEAR = (0.82, 0.855, 0.88, 0.9, 0.92)  # sizes, as shares of the closed form
DURATION = 100_000.0


def closed_form(chain: Chain) -> float:
    """L_c = pi gamma/((e - 1) sqrt(k m))."""
    unit = math.sqrt(chain.stiffness * chain.mass)
    return math.pi * chain.damping / ((chain.restitution - 1) * unit)


def simulated(chain: Chain) -> tuple[float, float]:
    """Return the size at which 1/energy, extrapolated, reaches zero, and its error."""
    sizes = sorted({round(share * closed_form(chain)) for share in NEAR})
    shares, errors = [], []
    for size in sizes:
        run = simulate(
            chain.replace(size=size), duration=DURATION, seed=4, threads=1, progress=False
        )
        if run.attrs["status"] != "completed":
            print(f"  {size} rods: {run.attrs['status']}", flush=True)
            break
        square = run.velocity_width.values**2
        share = chain.free_velocity_width**2 / square.mean()
        relative = np.sqrt(np.mean((2 * run.velocity_width_error / run.velocity_width) ** 2))
        shares.append(share)
        errors.append(float(share * relative))
        print(f"  {size} rods: tau = {share:.4f} +- {errors[-1]:.4f}", flush=True)
    sizes = sizes[: len(shares)]
    line, parabola = (
        float(min(root.real for root in np.roots(fit) if root.real > sizes[-1]))
        for fit in (np.polyfit(sizes, shares, n, w=1 / np.array(errors)) for n in (1, 2))
    )
    return parabola, max(abs(line - parabola), 0.5)


def main(figure: Path) -> None:
    drawing, [ax] = panels(1, 1, height=2.9, wanted=1)
    print("| e | gamma | kinetic equation | closed form | simulation |\n|---|---|---|---|---|")
    for restitution, colour, line in RESTITUTIONS:
        chains = [Chain(restitution=restitution, damping=damping) for damping in DAMPINGS]
        found = [critical_size(chain) for chain in chains]
        ax.plot(
            DAMPINGS,
            [each.value for each in found],
            color=colour,
            linestyle=line,
            label=f"kinetic equation, $e = {restitution:g}$",
        )
        for number, (e, damping) in enumerate(SIMULATED):
            if e != restitution:
                continue
            chain = Chain(restitution=e, damping=damping)
            theory = found[DAMPINGS.index(damping)]
            value, error = simulated(chain)
            print(
                f"| {e:g} | {damping:g} | {theory.value:.1f} ± {theory.error:.1f} "
                f"| {closed_form(chain):.1f} | {value:.1f} ± {error:.1f} |",
                flush=True,
            )
            ax.errorbar(
                damping,
                value,
                error,
                fmt="o",
                markerfacecolor="none",
                color=colour,
                label=f"simulation, $e = {e:g}$" if number in (0, 3) else None,
            )
    ax.text(0.97, 0.05, "steady states below the lines", ha="right", transform=ax.transAxes)
    ax.set(xlabel=r"damping $\gamma$ [$\sqrt{kM}$]", ylabel="number of rods $L$", xlim=(0, 5.1))
    ax.set_ylim(bottom=0, top=400)
    ax.legend()
    drawing.savefig(figure)


if __name__ == "__main__":
    with house_style():
        main(Path(sys.argv[1]))
