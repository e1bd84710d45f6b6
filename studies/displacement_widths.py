"""Displacement widths of the theory with pair correlations, on chains drawn at random.

    python -m studies.displacement_widths

Prints docs/tables/displacement_widths.csv: the largest error of W_x of any rod against simulations
in the limit of a vanishing time step, in which W_x has an error of 0.2 to 0.8 % at that rod.
"Before" is W_x with the covariance h of the velocities in place of h'. The chains were drawn after
the equation was final, and before any of them was simulated. Its cells in chains of 131 to 260 rods
were changed after the first results (docs/tables.md). On one core it takes about two hours.
"""

import math

import numpy as np

from crazybilliards.kinetic import accuracy
from crazybilliards.kinetic.correlations.closure import collective_variance
from crazybilliards.kinetic.correlations.stationary import in_agreement
from crazybilliards.kinetic.correlations.stationary_result import rods
from studies.common import Table, damped, print_table
from studies.stationary_errors import largest, pooled, simulated_widths

NUMBER = 24
ACCURACY, LIMIT = 0.0015, 0.005


def table() -> Table:
    """Draw chains: size and damping with an even logarithm, restitution evenly."""
    yield "L", "e", "Gamma", "before, %", "now, %", "rod", "its error, %", "stated, %"
    draw = np.random.default_rng(20261126)
    for _ in range(NUMBER):
        size = round(math.exp(draw.uniform(math.log(10), math.log(300))))
        e = round(draw.uniform(0, 0.97), 3)
        Gamma = round(math.exp(draw.uniform(math.log(0.25), math.log(1.3))), 3)
        yield f"{size}", f"{e:g}", f"{Gamma:g}", *row(size, e, Gamma)


def row(size: int, e: float, Gamma: float) -> list[str]:
    chain = damped(size, e, Gamma)
    value, error = pooled([simulated_widths(chain, ACCURACY, LIMIT)], "displacement_width", 1)
    found = in_agreement(chain, 2e-3)
    of_velocities, of_displacements = (
        collective_variance(problem.cells, pairs, np.arange(0.5, size))
        for problem, pairs in (
            (found.problem, found.pairs),
            (found.problem.on_whole_cells(), found.displaced),
        )
    )
    variance = rods(found).position_variance
    before, now = (
        chain.thermal_length * np.sqrt(each) / value - 1
        for each in (variance + of_velocities - of_displacements, variance)
    )
    worst = int(np.argmax(np.abs(now[: (size + 1) // 2])))
    stated = accuracy.expected("correlated_phase_space", chain).displacement_width
    return [
        f"{100 * largest(before, error)[0]:.1f}",
        f"{100 * now[worst]:+.1f}",
        f"{worst + 1}",
        f"{100 * error[worst] / value[worst]:.1f}",
        f"{100 * stated:.1f}",
    ]


if __name__ == "__main__":
    print_table(table())
