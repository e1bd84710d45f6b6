"""Velocity distributions of the chosen particles."""

from collections.abc import Sequence
from typing import Self

import numpy as np

from crazybilliards.model.checks import check_integer, check_real
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.run import Run

MOST_BINS = 100_001
FINEST = 0.05  # of the free width: bins are equal below, grow in proportion to v above
LAST = np.arcsinh(1000.0 / FINEST)  # edge of the last bin: 1000 free widths


def _standardized(average: Array, order: int) -> Array:
    """Return the third or fourth central moment in widths; NaN for a rod with one velocity only."""
    mean, second, third, fourth = (average[..., k, :] for k in range(4))
    variance, moment = second - mean**2, third - 3 * mean * second + 2 * mean**3
    if order == 4:
        moment = fourth - 4 * mean * third + 6 * mean**2 * second - 3 * mean**4
    unknown = np.full_like(moment, np.nan)
    return np.divide(moment, variance ** (order / 2), where=variance > 0, out=unknown)


_QUANTITIES = {
    "velocity_skewness": lambda average: _standardized(average, 3),
    "velocity_kurtosis": lambda average: _standardized(average, 4) - 3,
}


class Velocities(Averaged):
    """velocity_density: probability density of each chosen particle's velocity.

    velocity_skewness <(v-<v>)^3>/Var^(3/2) and velocity_kurtosis <(v-<v>)^4>/Var^2 - 3 come from
    the velocities themselves: in the bins even an exact Gaussian has an excess of 0.003.

    The bins are equally wide in arsinh(v / 0.05 W). With 401 of them they are 0.0025 W wide near 0
    and 5 % of v wide far out, up to 1000 W, for narrow centres and long tails alike. Where no noise
    and damping give a free width W, it is the largest speed that the energy of the start gives a
    rod. They take 8 bytes per bin and particle, and the moments 32 bytes per block and particle.

    Parameters
    ----------
    bins
        Number of bins. An odd number puts a bin in the middle.
    largest
        Velocity up to which, in both directions, equally wide bins reach [R/t_0]. None: the bins
        above.
    """

    name = "velocities"
    gives = ("velocity_density", "velocity_outside", *_QUANTITIES)
    along = ("velocity_bin",)
    ensemble = False
    reads_chain = False  # but for the bins: velocities beyond are counted

    def __init__(self, bins: int = 401, largest: float | None = None) -> None:
        self.bins = check_integer("bins", bins, least=1, most=MOST_BINS)
        self.largest = None if largest is None else check_real("largest", largest, positive=True)

    def shape(self, run: Run) -> tuple[int, ...]:
        return 4, run.chosen.size  # sums of v, v^2, v^3 and v^4

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.scale = self._scale(run)
        places = np.linspace(-1, 1, self.bins + 1)
        self.edges = places * self.largest if self.largest else self.scale * np.sinh(LAST * places)
        self.rows = np.arange(run.chosen.size) * self.bins
        self.counts = np.zeros(run.chosen.size * self.bins, dtype=np.int64)
        self.outside = 0

    def _scale(self, run: Run) -> float:
        """Return the velocity below which bins are equal."""
        width = run.chain.free_velocity_width
        width = width if 0 < width < np.inf else run.fastest_start
        if not (self.largest or width):
            raise ValueError(
                "observe: 'velocities' needs noise, or a start that moves, to size its bins; "
                "cb.observers.Velocities(largest=...) sizes them"
            )
        return FINEST * width

    def memory(self, run: Run) -> float:
        _ = self._scale(run)
        return 8.0 * self.bins * run.chosen.size + super().memory(run)

    def observe(self, snapshots: Snapshots) -> None:
        v = snapshots.v[:, self.run.chosen]
        square, sums = v * v, self.sums[snapshots.block]
        sums[0] += v.sum(axis=0)
        sums[1] += square.sum(axis=0)
        sums[2] += np.einsum("sp,sp->p", square, v)
        sums[3] += np.einsum("sp,sp->p", square, square)
        place = v / self.largest if self.largest else np.arcsinh(v / self.scale) / LAST
        place = (place + 1) * (self.bins / 2)
        inside = (place >= 0) & (place < self.bins)
        self.outside += int(inside.size - inside.sum())
        cells = (self.rows + place.astype(np.int64))[inside]
        self.counts += np.bincount(cells, minlength=self.counts.size)

    def join(self, others: Sequence[Self]) -> None:
        super().join(others)
        self.counts += sum(other.counts for other in others)
        self.outside += sum(other.outside for other in others)

    def report(self, counts: Integers) -> Variables:
        snapshots = counts.sum()
        density = self.counts.reshape(-1, self.bins) / (snapshots * np.diff(self.edges))
        return {
            "velocity_density": (("particle", "velocity_bin"), density),
            "velocity_outside": ((), self.outside / (snapshots * len(density))),
            **self.averages(_QUANTITIES, counts, "particle"),
        }

    def coordinates(self) -> dict[str, Array]:
        return {"velocity_bin": (self.edges[1:] + self.edges[:-1]) / 2}
