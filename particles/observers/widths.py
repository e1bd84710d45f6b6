"""Widths and displacements of every particle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np
from numpy.typing import NDArray

from crazybilliards.model import Chain
from crazybilliards.particles.blocks import block_means, jackknife
from crazybilliards.particles.observers.base import Observer, Snapshots, Variables
from crazybilliards.particles.schedule import Schedule


class Widths(Observer):
    """velocity_width W_v = sqrt(<v^2>), mean_displacement and displacement_width, per particle.

    The error of the mean displacement also tells its autocorrelation time: over a duration t the
    mean of a fluctuating quantity of width W and integrated autocorrelation time tau has the
    variance 2 tau W^2/t. One free rod on a linear spring has tau = gamma/k.

    Keeps the sums of d, d^2 and v^2: 24 L bytes per block.
    """

    accumulated = ("sums",)

    def __init__(self, chain: Chain, schedule: Schedule) -> None:
        self.anchors = chain.reduced_anchors
        self.interval = schedule.stride * schedule.time_step
        self.sums = np.zeros((schedule.blocks, 3, chain.size))

    def observe(self, seen: Snapshots) -> None:
        """Add snapshots to the sums of their block."""
        d = seen.y - self.anchors
        sums = self.sums[seen.block]
        sums[0] += d.sum(axis=0)
        sums[1] += np.einsum("sp,sp->p", d, d)
        sums[2] += np.einsum("sp,sp->p", seen.v, seen.v)

    def join(self, others: Sequence[Self]) -> None:
        """Append the blocks of other replicas."""
        self.sums = np.concatenate([self.sums, *(other.sums for other in others)])

    def report(self, counts: NDArray[np.int64]) -> Variables:
        """Return the three quantities, their standard errors and the autocorrelation time."""
        mean, blocks = block_means(self.sums, counts)
        quantities = {
            "mean_displacement": lambda average: average[0],
            # max: a rod that never moves has a variance of 0 up to rounding.
            "displacement_width": lambda average: np.sqrt(
                np.maximum(average[1] - average[0] ** 2, 0)
            ),
            "velocity_width": lambda average: np.sqrt(average[2]),
        }
        variables: Variables = {}
        for name, quantity in quantities.items():
            value, error = jackknife(quantity, mean, blocks)
            variables[name] = (("particle",), value)
            variables[f"{name}_error"] = (("particle",), error)
        variance = quantities["displacement_width"](mean) ** 2
        spread = np.square(variables["mean_displacement_error"][1])
        duration = counts.sum() * self.interval
        # A rod that never moves has no time of its own: 0.
        time = np.divide(spread * duration, 2 * variance, where=variance > 0, out=0 * variance)
        variables["autocorrelation_time"] = (("particle",), time)
        return variables
