"""Widths and displacements of every particle."""

import numpy as np

from crazybilliards.particles.observers.base import Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run

_QUANTITIES = {
    "mean_displacement": lambda average: average[..., 0, :],
    # maximum: a rod that never moves has a variance of 0 up to rounding.
    "displacement_width": lambda average: np.sqrt(
        np.maximum(average[..., 1, :] - average[..., 0, :] ** 2, 0)
    ),
    "mean_velocity": lambda average: average[..., 2, :],
    "velocity_width": lambda average: np.sqrt(average[..., 3, :]),
}


class Widths(Averaged):
    """mean_displacement, displacement_width, mean_velocity and velocity_width W_v = sqrt(<v^2>).

    The autocorrelation time follows from the error of a mean displacement averaged in time. Over a
    duration t the mean of a fluctuating quantity of standard deviation w and integrated
    autocorrelation time tau has the variance 2 tau w^2/t. One free rod on a linear spring has
    tau = gamma/k. It is infinite for rods that no spring ties.

    The sums of d, d^2, v and v^2 take 32 L bytes per block.
    """

    name = "widths"
    gives = (*_QUANTITIES, "autocorrelation_time")
    reads_chain = False

    def shape(self, run: Run) -> tuple[int, ...]:
        return 4, run.chain.size  # sums of d, d^2, v and v^2

    def observe(self, snapshots: Snapshots) -> None:
        d = snapshots.y - self.run.chain.reduced_anchors
        sums = self.sums[snapshots.block]
        sums[0] += d.sum(axis=0)
        sums[1] += np.einsum("sp,sp->p", d, d)
        sums[2] += snapshots.v.sum(axis=0)
        sums[3] += np.einsum("sp,sp->p", snapshots.v, snapshots.v)

    def report(self, counts: Integers) -> Variables:
        variables = self.averages(_QUANTITIES, counts, "particle")
        if self.run.ensemble:
            return variables
        variance = np.square(variables["displacement_width"][1])
        spread = np.square(variables["mean_displacement_error"][1])
        duration = counts.sum() * self.run.stride * self.run.time_step
        # A rod that never moves has no autocorrelation time: 0.
        time = np.divide(spread * duration, 2 * variance, where=variance > 0, out=0 * variance)
        if self.run.chain.spreads:
            time[:] = np.inf
        variables["autocorrelation_time"] = (("particle",), time)
        return variables
