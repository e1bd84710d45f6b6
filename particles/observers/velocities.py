"""Velocity distributions of the chosen particles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.model.checks import check_integer
from crazybilliards.particles.observers.base import (
    Array,
    Integers,
    Observer,
    Snapshots,
    Variables,
)
from crazybilliards.particles.run import Run

_MOST_BINS = 100_001
_FINEST = 0.05  # of the free width: bins are equal below, grow in proportion to v above
_WIDEST = 1000.0


class Velocities(Observer):
    """velocity_density: probability density of each chosen particle's velocity.

    The bins are equally wide in arsinh(v / 0.05 W). With 401 of them they are 0.0025 W wide near 0
    and 5 % of v wide far out, up to 1000 W. They resolve the narrow centre of a dissipative chain
    as well as the tails of an anti-dissipative one, without a pilot run. They take 8 bytes per bin
    and particle.

    Parameters
    ----------
    bins
        Number of bins. An odd number puts a bin in the middle.
    """

    name = "velocities"
    gives = ("velocity_density", "velocity_outside")
    along = ("velocity",)
    ensemble = False
    histograms = ("velocity_density",)

    def __init__(self, bins: int = 401) -> None:
        self.bins = check_integer("bins", bins, least=1, most=_MOST_BINS)

    def prepare(self, run: Run, copies: int) -> None:
        """Make the sums."""
        scale = run.chain.free_velocity_width
        if not 0 < scale < np.inf:
            raise ValueError(
                "observe: 'velocities' needs amplitude and damping above 0, to size its bins"
            )
        last = np.arcsinh(_WIDEST / _FINEST)
        self.scale, self.last = _FINEST * scale, last
        self.edges = self.scale * np.sinh(np.linspace(-last, last, self.bins + 1))
        self.chosen = run.chosen
        self.rows = np.arange(run.chosen.size) * self.bins
        self.counts = np.zeros(run.chosen.size * self.bins, dtype=np.int64)
        self.outside = 0

    def memory(self, run: Run) -> float:
        """Return the bytes it keeps."""
        return 8.0 * self.bins * run.chosen.size

    def observe(self, snapshots: Snapshots) -> None:
        """Count every velocity in its bin."""
        place = (np.arcsinh(snapshots.v[:, self.chosen] / self.scale) / self.last + 1) * (
            self.bins / 2
        )
        inside = (place >= 0) & (place < self.bins)
        self.outside += int(inside.size - inside.sum())
        cells = (self.rows + place.astype(np.int64))[inside]
        self.counts += np.bincount(cells, minlength=self.counts.size)

    def join(self, others: Sequence[Self]) -> None:
        """Add the counts of other replicas."""
        for other in others:
            self.counts += other.counts
            self.outside += other.outside

    def report(self, counts: Integers) -> Variables:
        """Return velocity_density, and the share of velocities beyond all bins."""
        snapshots = counts.sum()
        table = self.counts.reshape(-1, self.bins)
        return {
            "velocity_density": (
                ("particle", "velocity"),
                table / (snapshots * np.diff(self.edges)),
            ),
            "velocity_outside": ((), self.outside / (snapshots * len(table))),
        }

    def coordinates(self) -> dict[str, Array]:
        """Return the centres of the bins."""
        return {"velocity": (self.edges[1:] + self.edges[:-1]) / 2}
