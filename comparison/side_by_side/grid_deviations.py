"""How far theories are from the simulations beside them: densities at e = 1, widths at other e."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

import numpy as np
import xarray as xr

from crazybilliards.comparison.coverage import smooth
from crazybilliards.comparison.distances import Deviation, deviation
from crazybilliards.comparison.side_by_side.grid import ELASTIC, KINETIC, SIMULATION
from crazybilliards.comparison.widths import WidthDeviation, width_deviation
from crazybilliards.model import chain_of
from crazybilliards.model.calls import public

_Found = TypeVar("_Found")


def deviations(tree: xr.DataTree) -> dict[str, dict[str, Deviation]]:
    """Deviation of each theory's smoothed density from the simulation's, by group and theory."""
    return _by_theory(tree, ELASTIC, lambda run, theory: deviation(smooth(run), smooth(theory)))


def largest_width_error(group: xr.DataTree) -> float:
    """Max over particles of |W_v - W| in standard errors; W is exact for every particle."""
    run = group[SIMULATION].to_dataset()
    width = chain_of(run).free_velocity_width
    return float(np.abs((run.velocity_width - width) / run.velocity_width_error).max())


@public
def width_deviations(tree: xr.DataTree) -> dict[str, dict[str, WidthDeviation]]:
    """Compare velocity widths of simulation and theories, by group and theory.

    Both ends of a chain have the same averages. Simulated widths are therefore averaged over a rod
    and its mirror image, which lowers their errors by up to the root of two.
    """
    if not all(SIMULATION in group for group in tree.children.values()):
        raise ValueError(
            f"tree must be what compare_restitutions returns, got {list(tree.children)}"
        )
    return _by_theory(tree, KINETIC, width_deviation)


def _by_theory(
    tree: xr.DataTree, theories: Iterable[str], compare: Callable[[xr.Dataset, xr.Dataset], _Found]
) -> dict[str, dict[str, _Found]]:
    """Compare each theory with the simulation, unless this diverged before it measured."""
    return {
        name: {
            key: compare(group[SIMULATION].to_dataset(), group[key].to_dataset())
            for key in theories
            if key in group and "velocity_width" in group[SIMULATION].data_vars
        }
        for name, group in tree.children.items()
    }
