r"""The limit of a vanishing time step as a sum over levels: multilevel Monte Carlo.

(Giles, Oper. Res. 56, 607, 2008; Acta Numerica 24, 259, 2015.) For any average Q

    lim Q(dt) = <Q(dt_0)> + <Q(dt_1) - Q(dt_0)> + ... + <Q(dt_n) - Q(dt_(n-1))> + bias.

The first term is the base. In a difference both chains have the same noise (``coupling.py``), so
that it needs few of the expensive short steps. The terms are independent (``level_terms.py``).

**Durations.** Let V be the variance of W_v in the centre times the duration, and C the cost of a
unit of time. The work for an error s is least for the durations t_l = sqrt(V_l/C_l)
sum_k sqrt(V_k C_k)/s^2. V is measured in a pilot round, whose snapshots count as well. Each of its
32 groups lasts 10 correlation times of the chain in the base and 2.5 in each difference
(``level_steps.py``), or four or sixteen times as long while this is less than a quarter of the work
to come. C counts steps and, above e = 0, the collisions that were met: at the default step and e =
0.5 they cost more than the steps.

**The first step.** A step that is too long to be correlated with the next shorter one saves no
work. The base is the level from which on the work, (sum_k sqrt(V_k C_k))^2, is least. If this is
the last level, there is no difference, and the run is a plain one at the shortest step.

**The remaining bias.** The last step is chosen beforehand (``level_steps.py``). Its error is
estimated from the last difference D, whose other step is M times as long, as D/(M^p - 1) with the
order p of the scheme in dt. Below the critical restitution it is 3/2 for velocity widths and 1 for
displacements. Above it is 3/4, because the stated error is ~ r^(3/2) and r ~ sqrt(dt). If the bias
of W_v in the centre exceeds 0.7 of the accuracy, a level with a third of the step is added. Every
error bar is the root of the sum of the squared standard errors and the squared bias. A plain run
has no difference, and its bias is the expected relative one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from crazybilliards.model import Chain
from crazybilliards.particles.laws.closed_contacts import CRITICAL_RESTITUTION
from crazybilliards.particles.laws.law import EVENTS, EXACT, ISOTONIC, SORT
from crazybilliards.particles.vanishing_step.level_steps import Steps, expected_bias
from crazybilliards.particles.vanishing_step.level_terms import CENTRAL, Array, Estimate, estimate
from crazybilliards.particles.vanishing_step.sampler import Sampler

# Variables that linear springs do not make wrong.
_VELOCITIES = {CENTRAL, "velocity_width", "velocity_density", "kinetic_energy"}
_LARGEST_BIAS = 0.7  # largest bias without another level, in units of the accuracy
_GROWTH = 4  # of a level in one round: its variance is not known well before
_PILOT_SHARE = 0.25  # of the work, for a longer pilot round
# Measured costs on one core [ns]: of a step of a chain, of one rod in it, of a collision. Where
# rods are sorted, collisions are not counted.
_STEP, _ROD, _COLLISION = 20.0, 6.0, {EXACT: 0.0, SORT: 0.0, ISOTONIC: 15.0, EVENTS: 50.0}
_WORTH = 1.1  # a round that makes no level longer than this does not pay


class Levels:
    """The samplers of all levels, by level and replica; plans their work and sums them up."""

    def __init__(
        self, chain: Chain, accuracy: float, steps: Steps, samplers: list[list[Sampler]]
    ) -> None:
        self.chain, self.accuracy, self.steps, self.samplers = chain, accuracy, steps, samplers
        self.groups = sum(sampler.counts.size for sampler in samplers[0])
        # The pilot round. The last level is one in reserve if there are several.
        for level in range(max(len(samplers) - 1, 1)):
            self._extend(level, self._first(level))

    @property
    def used(self) -> range:
        """The levels of the sum, the base first; the one in reserve once it is measured."""
        begun = [level for level, each in enumerate(self.samplers) if each[0].target]
        if begun[-1] == len(self.samplers) - 1 and self._groups(begun[-1]) < 2:
            begun = begun[:-1] or begun
        base = max(level for level in begun if self.samplers[level][0].coarser is None)
        return range(base, begun[-1] + 1)

    @property
    def measured(self) -> bool:
        """Whether every level has two groups with snapshots, so that its errors are known."""
        return min(self._groups(level) for level in self.used) >= 2

    def _groups(self, level: int) -> int:
        """Return how many groups of a level have snapshots."""
        return sum(int(np.count_nonzero(sampler.counts)) for sampler in self.samplers[level])

    def extend(self) -> bool:
        """Request the snapshots that the variances require; return whether any are missing."""
        factors = {self._target(level) / self._first(level) for level in self.used}
        if len(factors) == 1 and not self._choose_base():
            for level in self.used:
                self._extend(level, _GROWTH * self._target(level))
            return True
        terms = self.terms(only="widths")
        width = sum(float(each.values[CENTRAL]) for each in terms)
        bias = float(self.bias(terms)[CENTRAL]) / width
        last = len(self.samplers) - 1
        if bias > _LARGEST_BIAS * self.accuracy and len(terms) > 1 and not self._target(last):
            self._extend(last, self._first(last))
            return True
        wanted = self._wanted([each.spread for each in terms], width, bias)
        grown = False
        for level, snapshots in zip(self.used, wanted, strict=True):
            if snapshots > _WORTH * self._target(level):
                self._extend(level, min(snapshots, _GROWTH * self._target(level)))
                grown = True
        return grown

    def _wanted(self, spreads: Sequence[float], width: float, bias: float) -> list[int]:
        """Return the snapshots that a group of each of the last levels should have."""
        levels = self.used[-len(spreads) :]
        costs = [self._cost(level, level > levels[0]) for level in levels]
        work = sum(math.sqrt(v * c) for v, c in zip(spreads, costs, strict=True))
        # If the bias is a large part of the error, the statistics must not be required without
        # limit.
        noise = max(self.accuracy**2 - bias**2, self.accuracy**2 / 4) * width**2
        wanted = [
            math.ceil(math.sqrt(v / c) * work / noise / self.groups)
            for v, c in zip(spreads, costs, strict=True)
        ]
        return [max(wanted[0], self.steps.least), *wanted[1:]]

    def terms(self, only: str | None = None) -> list[Estimate]:
        """Return the base and the differences, as far as they are measured."""
        base = self.used[0]
        return [
            estimate(self.samplers[level], difference=level > base, only=only)
            for level in self.used
        ]

    def bias(self, terms: Sequence[Estimate]) -> dict[str, Array]:
        """Return the remaining time-step error of every variable."""
        if len(terms) == 1:
            values = terms[0].values
            step = self.steps.time_steps[self.used[-1]]
            velocities, others = expected_bias(self.chain, step, float(values[CENTRAL]))
            return {
                name: (velocities if name in _VELOCITIES else others) * np.abs(value)
                for name, value in values.items()
            }
        ratio, bias = self.steps.ratios[self.used[-1]], {}
        for name, value in terms[-1].values.items():
            order = 0.75
            if self.chain.restitution < CRITICAL_RESTITUTION:
                order = 1.5 if name in (CENTRAL, "velocity_width") else 1.0
            bias[name] = np.abs(value) / (ratio**order - 1)
        return bias

    def coupling(self, terms: Sequence[Estimate]) -> dict[str, str | float]:
        """Return how runs at the last two steps are correlated, and what the levels save.

        The saving is the work of a plain run at the last step over that of the levels. As in the
        choice of the base, a single chain's spread is taken to be that of the base.
        """
        last = self.used[-1]
        if last == 0:  # one step is enough: always at e = 1, elsewhere if little is asked for
            return {"coupling": "one step"}
        if len(terms) == 1:
            return {"coupling": "weak", "correlation": self.samplers[last][0].correlation}
        costs = [self._cost(level, level > self.used[0]) for level in self.used]
        work = sum(math.sqrt(term.spread * c) for term, c in zip(terms, costs, strict=True))
        return {
            "coupling": "strong",
            "correlation": terms[-1].correlation,
            "saving": terms[0].spread * self._cost(last, coupled=False) / work**2,
        }

    def described(self, terms: Sequence[Estimate]) -> list[dict[str, Any]]:
        """Return the levels for the provenance; the shares are those in W_v of the centre."""
        begun = [level for level, each in enumerate(self.samplers) if each[0].snapshots]
        work = sum(self._work(level) for level in begun)
        variance = sum(float(each.variances[CENTRAL]) for each in terms)
        return [
            {
                "time_step": self.steps.time_steps[level],
                "subtracted_time_step": self.steps.time_steps[level - 1] if place else None,
                "snapshots": term.snapshots,
                "duration": term.snapshots * self.steps.interval,
                "rod_steps": sum(sampler.done for sampler in self.samplers[level]),
                "share_of_work": self._work(level) / work,
                "share_of_variance": float(term.variances[CENTRAL]) / variance,
                "value": float(term.values[CENTRAL]),
                "error": math.sqrt(float(term.variances[CENTRAL])),
                "correlation": term.correlation if place else None,
            }
            for place, (level, term) in enumerate(zip(self.used, terms, strict=True))
        ]

    def _first(self, level: int) -> int:
        """Return the snapshots of a group of a level in the pilot round."""
        return self.steps.pilot if level else self.steps.least

    def _target(self, level: int) -> int:
        return self.samplers[level][0].target

    def _extend(self, level: int, target: int) -> None:
        for sampler in self.samplers[level]:
            sampler.extend(target)

    def _work(self, level: int) -> float:
        """Return the time that the snapshots of a level have cost, in the units of the costs."""
        samplers = self.samplers[level]
        cost = self._cost(level, samplers[0].coarser is not None)
        return cost * sum(sampler.snapshots for sampler in samplers)

    def _cost(self, level: int, coupled: bool) -> float:
        """Return the time that a snapshot of a level costs [ns], for one rod of one chain or two.

        The collisions are those measured so far. Seconds are not measured, so that the same seed
        plans the same work on every machine. Taking the snapshot costs about one step, too.
        """
        size, samplers = self.chain.size, self.samplers[level]
        rods = size * sum(sampler.snapshots for sampler in samplers)
        met = sum(sampler.collisions[: 1 + coupled].sum() for sampler in samplers) / rods
        steps = self.steps.per_step(level) + (self.steps.per_step(level - 1) if coupled else 0)
        taken = float(steps * self.steps.stride + 1 + coupled)
        collision = _COLLISION[self.samplers[0][0].dynamics.law.operator]
        return taken * (_STEP / size + _ROD) + met * collision

    def _choose_base(self) -> bool:
        """Leave out the levels whose steps are too long to save any work.

        Return False if the pilot round is too short to decide and a longer one costs little. The
        spread of a single chain is assumed to be the same at all steps, because two measured
        spreads would differ more than the true ones.
        """
        levels = list(self.used)
        alone = [estimate(self.samplers[each], difference=False, only="widths") for each in levels]
        spread, width = alone[0].spread, float(alone[-1].values[CENTRAL])
        differences = [
            estimate(self.samplers[each], difference=True, only="widths") for each in levels[1:]
        ]
        both = zip(differences, alone[1:], strict=True)
        spreads = [spread, *(difference.spread / one.spread * spread for difference, one in both)]
        work = []
        for place, level in enumerate(levels):
            pairs = zip(spreads[place + 1 :], levels[place + 1 :], strict=True)
            costs = [math.sqrt(v * self._cost(each, coupled=True)) for v, each in pairs]
            work.append(math.sqrt(spread * self._cost(level, coupled=False)) + sum(costs))
        base = int(np.argmin(work))
        wanted = self._wanted([spread, *spreads[base + 1 :]], width, 0.0)
        pilot = sum(self._target(level) * self._cost(level, level > levels[0]) for level in levels)
        needed = sum(
            snapshots * self._cost(level, level > levels[base])
            for level, snapshots in zip(levels[base:], wanted, strict=True)
        )
        if _GROWTH * pilot < _PILOT_SHARE * needed:
            return False
        for sampler in self.samplers[levels[base]] if base else ():
            sampler.uncouple(differences[base - 1].correlation)
        return True
