"""The density on the position grid."""

from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.model.checks import check_real
from crazybilliards.model.grid import deposit, position_grid
from crazybilliards.model.warn import warn_user
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run

_TAIL, _WIDTHS = 40.0, 8.0  # of the energy, in T; of a displacement, in standard deviations


def _reach(run: Run) -> float:
    """Distance from its anchor that hardly any rod exceeds [R]."""
    chain, time = run.chain, run.warmup + run.duration
    thermal = chain.thermal_reach
    if not np.isfinite(thermal):
        # Without damping or springs rods are heated, or spread, for the whole run.
        damped = min(time, chain.mass / chain.damping) if chain.damping > 0 else time
        heat = chain.amplitude**2 * damped / (2 * chain.mass)
        noise = chain.amplitude / chain.mass * damped * np.sqrt(time)
        thermal = chain.reach(_TAIL * heat) if chain.stiffness > 0 else _WIDTHS * noise
    # Flippers (e > 1) drive a chain apart by several times the free reach.
    thermal *= 5 if chain.restitution > 1 else 1
    # A start with thermal or smaller displacements needs no more room than that.
    return float(thermal + max(0.0, run.swing - 0.75 * thermal))


class Density(Averaged):
    """Density of the rods' centres on the position grid, in hat weights, block by block.

    The block means are part of the result, because the error of a smoothed density does not
    follow from the errors of the bins. They take 8 bytes per node and block.

    Parameters
    ----------
    reach
        Distance from the outer anchors that rods may reach [R]; the grid goes 4R further, which
        smoothing needs, and never more than that beyond a wall. None: as far as noise and the
        start can move rods.
    """

    name = "density"
    gives = ("density", "density_block", "outside")
    along = ("x",)
    reads_chain = False  # but for the grid: rods beyond it are counted

    def __init__(self, reach: float | None = None) -> None:
        self.reach = None if reach is None else check_real("reach", reach, positive=True)

    def _grid(self, run: Run) -> Array:
        if self.reach is None:
            return position_grid(run.chain, _reach(run))
        try:
            return position_grid(run.chain, self.reach)
        except ValueError as error:
            raise ValueError(f"reach={self.reach:g} is too large for a grid: {error}") from error

    def shape(self, run: Run) -> tuple[int, ...]:
        return (self._grid(run).size,)

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.x = self._grid(run)
        self.first, self.spacing = self.x[0], self.x[1] - self.x[0]
        self.outside = 0

    def observe(self, snapshots: Snapshots) -> None:
        points = self.run.chain.physical(snapshots.y).ravel()
        self.outside += deposit(points, self.first, self.spacing, self.sums[snapshots.block])

    def join(self, others: Sequence[Self]) -> None:
        super().join(others)
        self.outside += sum(other.outside for other in others)

    def report(self, counts: Integers) -> Variables:
        if self.outside:
            warn_user(
                f"density: {self.outside / counts.sum():.3g} rods per snapshot lay outside the "
                "grid and are missing; observe=cb.observers.Density(reach=...) makes the grid wider"
            )
        variables = self.averages({"density": lambda average: average / self.spacing}, counts, "x")
        dimensions, _ = variables["density"]
        if self.run.ensemble:
            # In an interrupted run a group has no density at times that it did not reach: NaN.
            known = np.where(counts > 0, counts, np.nan)[..., np.newaxis]
            means = self.sums[:, : counts.shape[-1]] / (known * self.spacing)
        else:
            means = self.sums[counts == counts.max()] / (counts.max() * self.spacing)
        variables["density_block"] = (("block", *dimensions), means)
        variables["outside"] = ((), np.float64(self.outside / counts.sum()))
        return variables

    def coordinates(self) -> dict[str, Array]:
        return {"x": self.x}
