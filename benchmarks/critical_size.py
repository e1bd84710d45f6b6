"""The critical size of driven chains: kinetic equation and simulation.

    python benchmarks/critical_size.py

Prints docs/tables/critical_size.csv, which docs/figures/critical_size.py draws.

Simulated: tau = W^2 L/sum W_v(i)^2, the free energy over the chain's, falls to zero at the critical
size; a parabola through five sizes just below finds where. Takes about half an hour on one core.
"""

import numpy as np

from crazybilliards.kinetic import critical_size
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_critical_size
from crazybilliards.model import Chain
from crazybilliards.particles import simulate

SIMULATED = ((1.05, 1.0), (1.05, 2.0), (1.05, 4.0), (1.1, 4.0))
NEAR = (0.82, 0.855, 0.88, 0.9, 0.92)  # sizes, as shares of the closed form
DURATION = 100_000.0


def simulated(chain: Chain) -> tuple[float, float]:
    """Return the size at which 1/energy, extrapolated, reaches zero, and its error."""
    sizes = sorted({round(share * weak_damping_critical_size(chain)) for share in NEAR})
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


def main() -> None:
    print("e,gamma,kinetic equation,closed form,simulation")
    for restitution, damping in SIMULATED:
        chain = Chain(restitution=restitution, damping=damping)
        theory = critical_size(chain)
        value, error = simulated(chain)
        print(
            f"{restitution:g},{damping:g},{theory.value:.1f} ± {theory.error:.1f},"
            f"{weak_damping_critical_size(chain):.1f},{value:.1f} ± {error:.1f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
