"""What the kinetic equation, without and with pair correlations, says of several figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from crazybilliards.comparison.drawing import COLOURS, along_the_chain, draw_rods
from crazybilliards.comparison.layout import legend_above, panels
from crazybilliards.reproduction.chains import (
    LARGE,
    RESTITUTIONS,
    Theory,
    correlated_equation,
    kinetic_equation,
)
from crazybilliards.reproduction.claims.repetition import Runs
from crazybilliards.reproduction.claims.study import Cases, Quality, Results, all_of

INDEPENDENT, PAIRS = "kinetic equation", "with pair correlations"
_EQUATIONS: dict[str, Callable[[int, float], Theory]] = {
    INDEPENDENT: kinetic_equation,
    PAIRS: correlated_equation,
}
_SOLVED = {  # restitutions
    INDEPENDENT: {"quick": (0.95,), "full": (0.85, 0.92, 0.95)},
    PAIRS: {"quick": (0.95,), "full": RESTITUTIONS},
}
LINES = {INDEPENDENT: "--", PAIRS: "-"}
CROSSES: dict[str, dict[str, Any]] = {
    INDEPENDENT: {"marker": "x", "linestyle": "none", "color": COLOURS[4]},
    PAIRS: {"marker": "+", "linestyle": "none", "color": COLOURS[2]},
}
Theories = dict[str, dict[float, xr.Dataset]]  # by name, then by restitution


def by_restitution(quality: Quality) -> Cases:
    """Return the theories of L = 1000."""
    solved = (
        equation(LARGE, e) for name, equation in _EQUATIONS.items() for e in _SOLVED[name][quality]
    )
    return all_of(solved, quality)


def predicted(results: Results) -> Theories:
    """Return the results of :func:`by_restitution`."""
    return {
        name: {
            e: results[theory]
            for e in RESTITUTIONS
            if (theory := equation(LARGE, e).name) in results
        }
        for name, equation in _EQUATIONS.items()
    }


def draw_flippers(
    results: Results, shown: Mapping[str, tuple[Runs, Theory, float]], ylabel: str
) -> Figure:
    """Draw W_v(i) of runs as symbols and of the kinetic equation as lines, in one panel.

    ``shown`` has by label the runs, the theory, and the unit of their widths.
    """
    figure, [ax] = panels(1, 1, height=3.1)
    for number, (label, (runs, theory, unit)) in enumerate(shown.items()):
        draw_rods(ax, runs.pooled(results), "velocity_width", number=number, unit=unit, label=label)
        solved = results[theory.name]
        ax.plot(solved.normalized_particle, solved.velocity_width / unit, color=COLOURS[number])
    along_the_chain(ax)
    ax.set_ylabel(ylabel)
    ax.plot([], [], color="0.4", label="kinetic equation")
    legend_above(figure, ax)
    return figure
