"""Covariances of rods a few places apart."""

import numpy as np

from crazybilliards.model.checks import check_integer
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run


class Covariances(Averaged):
    """Covariances of velocities and of gaps, over rods up to ``separations`` places apart.

    ``velocity_covariance`` is <v_i v_{i+r}> over particle i and separation r, about zero as
    ``velocity_width`` is. ``gap_covariance`` is <g_i g_{i+r}> - <g_i><g_{i+r}> over contact i and
    separation r, with the free room g_i between the rods i and i + 1, and ``mean_gap`` is <g_i>.
    Where i + r lies beyond the chain there is NaN. Over the contacts it gives what
    ``steady_state`` predicts: ``neighbour_covariance`` <v_i v_{i+1}> and
    ``relative_temperature`` <(v_i - v_{i+1})^2>/2.

    The sums take 8 (2 separations + 3) L bytes per block.

    Parameters
    ----------
    separations
        Largest separation in rods, at least 1. A shorter chain has L - 1.
    """

    name = "covariances"
    gives = (
        *("velocity_covariance", "gap_covariance"),
        *("mean_gap", "neighbour_covariance", "relative_temperature"),
    )
    along = ("separation",)
    least_rods = 2
    reads_chain = False

    def __init__(self, separations: int = 10) -> None:
        self.separations = check_integer("separations", separations, least=1, most=100_000)

    def shape(self, run: Run) -> tuple[int, ...]:
        # The products of velocities and those of gaps by separation, and the gaps.
        return 2 * self._numbers(run) + 1, run.chain.size

    def _numbers(self, run: Run) -> int:
        """Return how many separations there are, from 0 on."""
        return min(self.separations + 1, run.chain.size)

    def observe(self, snapshots: Snapshots) -> None:
        # Gaps minus those between the anchors: less is lost when the square of a mean is taken off.
        gaps = np.diff(snapshots.y - self.run.chain.reduced_anchors, axis=1)
        sums, last = self.sums[snapshots.block], self._numbers(self.run)
        for row, values in ((0, snapshots.v), (last, gaps)):
            size = values.shape[1]
            for r in range(min(last, size)):
                left, right = values[:, : size - r], values[:, r:]
                sums[row + r, : size - r] += np.einsum("sp,sp->p", left, right)
        sums[-1, :-1] += gaps.sum(axis=0)

    def report(self, counts: Integers) -> Variables:
        last, anchors = self._numbers(self.run), self.run.chain.reduced_anchors

        def of_gaps(average: Array) -> Array:
            products, mean = average[..., last:-1, :-1].copy(), average[..., -1, :-1]
            size = mean.shape[-1]
            for r in range(min(last, size)):
                products[..., r, : size - r] -= mean[..., : size - r] * mean[..., r:]
            return _within_chain(products)

        def temperature(average: Array) -> Array:
            squares, neighbours = average[..., 0, :], average[..., 1, :-1]
            return np.asarray((squares[..., 1:] + squares[..., :-1]) / 2 - neighbours)

        of_contacts = {
            "mean_gap": lambda average: average[..., -1, :-1] + np.diff(anchors),
            "neighbour_covariance": lambda average: average[..., 1, :-1],
            "relative_temperature": temperature,
        }
        return {
            **self.averages(
                {"velocity_covariance": lambda average: _within_chain(average[..., :last, :])},
                *(counts, "particle", "separation"),
            ),
            **self.averages({"gap_covariance": of_gaps}, counts, "contact", "separation"),
            **self.averages(of_contacts, counts, "contact"),
        }

    def coordinates(self) -> dict[str, Array]:
        return {"separation": np.arange(self._numbers(self.run), dtype=np.float64)}


def _within_chain(by_separation: Array) -> Array:
    """Return (..., rods, separations) from (..., separations, rods), NaN beyond the chain."""
    values = np.moveaxis(by_separation, -1, -2)
    size, separations = values.shape[-2:]
    return np.where(np.arange(size)[:, None] + np.arange(separations) < size, values, np.nan)
