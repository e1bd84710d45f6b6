"""How long rods, waves and the centre of mass remember their velocities and displacements."""

import math

import numpy as np

from crazybilliards.model import WALLS_AND_MASSES, Chain
from crazybilliards.model.checks import check_integer, check_real
from crazybilliards.model.kernels import kernel
from crazybilliards.model.warn import warn_user
from crazybilliards.particles.observers.base import Array, Averaged, Integers, Snapshots, Variables
from crazybilliards.particles.observers.modes import waves_of
from crazybilliards.particles.run import Run
from crazybilliards.particles.scales import first_decay, settling_time

_RELAXATIONS = 5  # the longest lag unless it is given, and the shortest for a spectrum
_INTERVALS = 5  # in the first decay of a velocity, unless the time between snapshots is given
_LAGS = 300  # unless their number is given or follows from what is given
# A block is longer than the lags, because blocks with pairs in common are not independent.
_LAGS_OF_A_BLOCK, _FEWEST_BLOCKS = 2, 10
_QUANTITIES = (
    "velocity_autocorrelation",
    "displacement_autocorrelation",
    "mean_squared_displacement",
    "velocity_spectrum",
)


@kernel
def _add_pairs(sums, known, now, taken, last):  # type: ignore[no-untyped-def]
    """Add the pairs of new snapshots with ``known`` ones, the new ones included, at all lags.

    Both hold velocities and displacements, (2, snapshots, series). Of the snapshots before the new
    ones only the last ``taken`` exist.
    """
    new, series = now.shape[1:]
    before = known.shape[1] - new
    for lag in range(last + 1):
        row = last + 1 + lag
        for k in range(max(lag - taken, 0), new):
            then = before + k - lag
            for s in range(series):
                step = now[1, k, s] - known[1, then, s]
                sums[lag, s] += known[0, then, s] * now[0, k, s]
                sums[row, s] += step * step
            sums[lag, series] += 1
            sums[row, series] += 1


class TimeCorrelations(Averaged):
    """Autocorrelations in time of every chosen rod, of long waves and of the centre of mass.

    With displacements d, and averages over the times s and the replicas, over a lag t,

    * ``velocity_autocorrelation`` is <v_i(s) v_i(s+t)>,
    * ``mean_squared_displacement`` is <(d_i(s+t) - d_i(s))^2>,
    * ``displacement_autocorrelation`` is <d_i(s) d_i(s+t)> - <d_i>^2, computed as the variance of
      d_i minus half of the mean squared displacement; NaN where noise drives the rods ever farther,
      without a spring or without damping,
    * ``velocity_spectrum`` is 2 int cos(w t) <v_i(s) v_i(s+t)> dt over the lags, by the
      trapezoidal rule, over the angular ``frequency`` w. Its integral over w from 0 on is pi
      <v_i^2>. It includes what aliasing folds down from frequencies above pi over the lag spacing.
      It is NaN, with a warning, where the longest lag is below 5 relaxation times (without springs
      5 m/gamma), because correlations that are cut off would falsify it, even to negative values.

    ``wave_velocity_autocorrelation`` and so on, over ``wave`` q, are those of the waves that
    :class:`Modes` defines, of two masses those of m_i v_i and m_i d_i over the mean mass.
    ``centre_velocity_autocorrelation`` and so on are those of the centre of mass. On linear springs
    it is a damped oscillator, at any restitution.

    In an ensemble the lag is counted from the first time. All quantities but the spectrum, which
    does not exist, then lie over ``time``, and <d_i(s)> <d_i(s+t)> is subtracted. ``longest`` and
    ``lags`` are refused.

    The shortest lag is ``every``, the time between snapshots of :func:`simulate`, and all lags are
    multiples of it up to ``longest``. Where ``every`` is not given it is a fifth of the time in
    which velocities decay first, which is the shortest of m/gamma, of the time scale of the springs
    and of the time between two collisions. It is never above 10 steps, and never so short that
    ``longest`` needs more than 300 lags.

    All lags are exact, from a buffer of the last snapshots. They take 16 ``lags`` bytes per rod and
    wave, and as much per block; a snapshot takes some ``lags`` operations per rod. Errors are those
    of blocks of twice the longest lag, or of ten to twenty shorter blocks in a run that lasts less
    than 20 times the longest lag: some errors are then too small by a fifth.

    Parameters
    ----------
    longest
        Longest lag [t_0], below the duration and at least ``every``. None: 5 relaxation times of
        the chain, but at most 300 lags. The spectrum is NaN where these are shorter than 5
        relaxation times; give ``longest`` for one.
    lags
        Most lags above 0. Where ``longest`` is more snapshots away, only every second, third, ...
        snapshot is used. None: every snapshot is used.
    waves
        Number of waves, from q = 0 on; a shorter chain has as many as rods.
    """

    name = "time-correlations"
    gives = tuple(f"{of}{name}" for of in ("", "wave_", "centre_") for name in _QUANTITIES)
    along = ("lag", "frequency", "wave")
    knows = WALLS_AND_MASSES

    def __init__(
        self, longest: float | None = None, lags: int | None = None, waves: int = 8
    ) -> None:
        self.longest = None if longest is None else check_real("longest", longest, positive=True)
        self.lags = None if lags is None else check_integer("lags", lags, least=1, most=100_000)
        self.waves = check_integer("waves", waves, least=1, most=100_000)

    def interval(self, chain: Chain) -> float:
        finest = first_decay(chain) / _INTERVALS
        if self.longest is self.lags is None:
            return finest
        longest = self.longest or _memory(chain)
        return min(max(finest, longest / (self.lags or _LAGS)), longest)

    def _plan(self, run: Run) -> tuple[int, int]:
        """Return the number of snapshots from one lag to the next, and the number of lags."""
        if run.ensemble:
            if self.longest is self.lags is None:
                return 1, 0
            raise ValueError(
                f"observe: {self.name!r} has the times of an ensemble as lags: give every and "
                "duration, and neither longest nor lags"
            )
        longest, duration, interval = self.longest or _memory(run.chain), run.duration, run.every
        if interval > longest * (1 + 1e-9):
            raise ValueError(
                f"observe: {self.name!r} has the longest lag {longest:.4g}, and snapshots are "
                f"{interval:.4g} apart: give every={longest:.4g} or less, or a longer lag"
            )
        if self.longest is self.lags is None and longest < math.inf:
            longest = min(longest, _LAGS * interval)
        if longest < duration:
            steps = math.floor(longest / interval + 1e-9)
            lags = self.lags or steps
            # Of the two spacings that give so many lags the one that comes closer to the longest.
            spacings = max(steps // lags, 1), math.ceil(steps / lags)
            spacing = max(spacings, key=lambda each: each * min(lags, steps // each))
            last = min(lags, steps // spacing)
            if 0 < spacing * last < run.snapshots:
                return spacing, last
        raise ValueError(
            f"observe: {self.name!r} needs a duration above the longest lag {longest:.4g}, got "
            f"{duration:.4g}; cb.observers.TimeCorrelations(longest=...) chooses another"
        )

    def shape(self, run: Run) -> tuple[int, ...]:
        # Velocities and increments by lag, d and d^2; of rods, of waves, and how many terms.
        _, last = self._plan(run)
        return 2 * (last + 1) + 2, run.chosen.size + min(self.waves, run.chain.size) + 1

    def memory(self, run: Run) -> float:
        return super().memory(run) + 8.0 * math.prod(self.shape(run))

    def prepare(self, run: Run, copies: int) -> None:
        super().prepare(run, copies)
        self.spacing, self.last = self._plan(run)
        self.needed = _memory(run.chain)  # of a spectrum
        self.before = np.zeros((2, max(self.last, 1), self.sums.shape[-1] - 1))

    def observe(self, snapshots: Snapshots) -> None:
        used, chain = slice(-snapshots.first % self.spacing, None, self.spacing), self.run.chain
        rods = np.stack([snapshots.v[used], snapshots.y[used] - chain.reduced_anchors])
        waves = waves_of(chain, rods)[..., : self.waves]
        now = np.concatenate([rods[..., self.run.chosen], waves], axis=-1)
        sums, new = self.sums[snapshots.block], now.shape[1]
        sums[-2, :-1] += now[1].sum(axis=0)
        sums[-1, :-1] += np.einsum("sp,sp->p", now[1], now[1])
        sums[-2:, -1] += new
        if self.run.ensemble:
            if snapshots.first == 0:
                self.before[...] = now[:, :1]
            _add_pairs(sums, np.repeat(self.before, new, axis=1), now, 0, 0)
            return
        known = np.concatenate([self.before, now], axis=1)
        _add_pairs(sums, known, now, -(-snapshots.first // self.spacing), self.last)
        self.before[...] = known[:, new:]

    def _means(self, average: Array, rows: slice) -> Array:
        """Return means (times or lags, series); NaN where there are no terms."""
        sums, numbers = average[..., rows, :-1], average[..., rows, -1:]
        means = np.divide(sums, numbers, where=numbers > 0, out=np.full_like(sums, np.nan))
        return means[:, 0] if self.run.ensemble else means

    def _velocities(self, average: Array) -> Array:
        return self._means(average, slice(self.last + 1))

    def _increments(self, average: Array) -> Array:
        return self._means(average, slice(self.last + 1, -2))

    def _displacements(self, average: Array) -> Array:
        mean, square = (self._means(average, row) for row in (slice(-2, -1), slice(-1, None)))
        covariance = (square[:1] + square - self._increments(average)) / 2 - mean[:1] * mean
        spreads = self.run.chain.spreads and not self.run.ensemble
        return np.full_like(covariance, np.nan) if spreads else covariance

    def _spectrum(self, average: Array) -> Array:
        from scipy.fft import dct

        if self._cut_off:
            return np.full_like(self._velocities(average), np.nan)
        return np.asarray(self._interval * dct(self._velocities(average), type=1, axis=0))

    def report(self, counts: Integers) -> Variables:
        ensemble, rods = self.run.ensemble, self.run.chosen.size
        quantities = self._velocities, self._displacements, self._increments, self._spectrum
        kinds = dict(zip(_QUANTITIES, quantities, strict=True))
        if ensemble:
            del kinds["velocity_spectrum"]
        elif self._cut_off:
            longer = f"; longest={1.01 * self.needed:.3g} gives them" * math.isfinite(self.needed)
            warn_user(
                f"observe: {self.name!r}: spectra are NaN, because the longest lag "
                f"{self.last * self._interval:.4g} is below {_RELAXATIONS} relaxation times, "
                f"{self.needed:.4g}{longer}"
            )
        variables: Variables = {}
        for name, (_, measured) in self.averages(kinds, self._joined(counts)).items():
            own, waves = np.split(np.asarray(measured), [rods], axis=1)
            along = "time" if ensemble else "frequency" if "spectrum" in name else "lag"
            for of, over, part in (("", "particle", own), ("wave_", "wave", waves)):
                of_all = ((along, over), part) if ensemble else ((over, along), part.T)
                variables[of + name] = of_all
            # The first wave is the sum of all rods over the root of their number.
            variables["centre_" + name] = ((along,), waves[:, 0] / self.run.chain.size)
        return variables

    def _joined(self, counts: Integers) -> Integers:
        """Add up neighbouring blocks until they are as long as needed, while there are enough."""
        needed = _LAGS_OF_A_BLOCK * self.last * self.spacing
        while counts.max() < needed and np.count_nonzero(counts) >= 2 * _FEWEST_BLOCKS:
            pairs = np.arange(0, len(counts), 2)
            self.sums = np.add.reduceat(self.sums, pairs, axis=0)
            counts = np.add.reduceat(counts, pairs)
        return counts

    @property
    def _interval(self) -> float:
        return self.spacing * self.run.stride * self.run.time_step

    @property
    def _cut_off(self) -> bool:
        """Whether velocities are still correlated at the longest lag."""
        return (self.last + 1) * self._interval < self.needed * (1 + 1e-9)

    def coordinates(self) -> dict[str, Array]:
        waves = {"wave": np.arange(self.sums.shape[-1] - 1.0 - self.run.chosen.size)}
        if self.run.ensemble:
            return waves
        lags = np.arange(self.last + 1.0)
        frequencies = np.pi * lags / (self.last * self._interval)
        return {"lag": self._interval * lags, "frequency": frequencies, **waves}


def _memory(chain: Chain) -> float:
    """Return the lag at which nothing is left of any correlation."""
    return _RELAXATIONS * settling_time(chain)
