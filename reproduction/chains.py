"""Runs and theories that several figures share, with the effort of each quality.

The paper's parameters throughout: gamma = k = A = 1, g = 0 unless said.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import xarray as xr

from crazybilliards.model import Chain
from crazybilliards.reproduction.claims.study import Effort, Results, Runs, Solution, effort
from crazybilliards.reproduction.claims.verdicts import Estimate, at_choices

LARGE = 1000  # the paper's longest chains
SIZES = (10, 30, 100, 300, LARGE)
RESTITUTIONS = (0.0, 0.5, 0.75, 0.85, 0.92, 0.95)

DEFAULT = "default step"
# Chains run at this one, too, to see whether the step decides a claim.
OTHER_STEP, OTHER = 1e-2, "dt = 0.01"

# By the number of rods from which on it holds, below 1000.
_DISSIPATIVE = {1: effort((4, 1000), (8, 24_000)), 101: effort((4, 500), (8, 6000))}
# At e = 0 runs cost less than at other restitutions below 1, and more statements depend on them.
# Up to 30 rods they are long enough to tell exponents of -0.45 and -0.46 apart.
_INELASTIC = {
    1: effort((4, 1000), (8, 400_000)),
    31: effort((4, 1000), (8, 24_000)),
    101: effort((4, 500), (20, 6000)),
}
# Of runs of 1000 rods, at full quality, by the restitution: at the largest one widths fluctuate for
# longer, and those at 0.5 cost most.
_NUMBERS = {0.0: 30, 0.5: 6, 0.95: 24}
_AT_STEP = {
    1: effort((4, 400), (6, 6000)),
    100: effort((4, 400), (6, 3000)),
    101: effort((4, 100), (6, 1500)),
    LARGE: effort((4, 40, 20), (6, 800, 50)),
}

Quantity = Callable[[xr.Dataset], float]
Key = TypeVar("Key")
Need = TypeVar("Need", Runs, Solution)
Steps = Mapping[str, Mapping[Key, Runs]]  # by the names of time steps, the first the default one
_OBSERVED = {"observe": ["widths", "velocities"]}


def _of_size(efforts: Mapping[int, Effort], size: int) -> Effort:
    return efforts[max(least for least in efforts if least <= size)]


def dissipative(size: int, restitution: float, amplitude: float = 1.0) -> Runs:
    """Return runs of a dissipative chain at the default time step."""
    chosen = _of_size(_DISSIPATIVE if restitution else _INELASTIC, size)
    if size == LARGE:
        number = _NUMBERS.get(restitution, 10) if amplitude == 1 else 6
        # W_v and <dx> of rods that start at their anchors are steady, to 2 %, after 20 time units.
        chosen = effort((4, 40, 20), (number, 500, 50))
    return Runs(
        f"L={size} e={restitution:g} A={amplitude:g}",
        Chain(size=size, restitution=restitution, amplitude=amplitude),
        chosen,
        _OBSERVED,
    )


def inelastic(sizes: Iterable[int]) -> dict[str, dict[int, Runs]]:
    """Return runs of these perfectly inelastic chains by the names of the steps."""
    ours = {size: dissipative(size, 0.0) for size in sizes}
    return {DEFAULT: ours} | {
        f"dt = {step:g}": {n: runs.at_step(step, _of_size(_AT_STEP, n)) for n, runs in ours.items()}
        for step in (OTHER_STEP, 3e-3, 1e-3)
    }


def flippers(size: int, damping: float) -> Runs:
    """Return runs at e = 1.05, with collision rates and avalanches."""
    # Whether a power law fits the profile of 100 rods at gamma = 4 needs more runs.
    number = 32 if (size, damping) == (100, 4.0) else 8
    return Runs(
        f"L={size} gamma={damping:g}",
        Chain(size=size, restitution=1.05, damping=damping),
        effort((4, 1000), (number, 8000)),
        {"observe": ["widths", "velocities", "collisions", "avalanches", "triggered-collisions"]},
    )


# A quarter of a second each, so that both qualities can afford it.
ELASTIC = Runs("L=100 e=1", Chain(size=100), effort((8, 50_000), (8, 50_000)), _OBSERVED)


def at_both_steps(runs: Mapping[Key, Runs]) -> dict[str, dict[Key, Runs]]:
    """Return the runs, of 1000 rods or of flippers, and those at the other step, by the steps."""

    def again(chain: Chain) -> Effort:
        if chain == Chain(size=LARGE, restitution=0.0):
            return _AT_STEP[LARGE]
        if chain.restitution > 1:
            return effort((4, 300), (4, 1500))
        return effort((4, 40, 20), (4, 200, 50))

    return {
        DEFAULT: dict(runs),
        OTHER: {key: one.at_step(OTHER_STEP, again(one.chain)) for key, one in runs.items()},
    }


def at_steps(results: Results, steps: Steps[Key], key: Key, quantity: Quantity) -> dict[str, Any]:
    """Return what a claim takes of a quantity of some runs, by their time step."""
    return at_choices(steps, lambda group: group[key].estimate(results, quantity))


def difference(
    results: Results, steps: Steps[Key], keys: tuple[Key, Key], quantity: Quantity
) -> tuple[Estimate, Estimate, dict[str, Any]]:
    """Return a quantity of two runs, and what a claim takes of the first less the second."""

    def both(group: Mapping[Key, Runs]) -> list[Estimate]:
        return [group[key].estimate(results, quantity) for key in keys]

    first, second = both(steps[DEFAULT])
    return first, second, at_choices(steps, lambda group: Estimate.minus(*both(group)))


def all_of(groups: Mapping[Any, Mapping[Any, Need]]) -> list[Need]:
    """Return what all groups hold, runs at several steps, say, as a study takes it."""
    return [need for group in groups.values() for need in group.values()]


def gas(size: int, restitution: float, damping: float = 1.0, correlations: bool = True) -> Solution:
    """Return the steady state of the gas; without correlations its mean field."""
    return Solution(
        f"gas L={size} e={restitution:g} gamma={damping:g} correlations={correlations}",
        Chain(size=size, restitution=restitution, damping=damping),
        {"correlations": correlations},
    )


# The gas of 1000 rods, in the mean field and with correlations, by the restitution.
MEAN_FIELD, GAS = "mean field", "gas"
PREDICTIONS: dict[str, dict[float, Solution]] = {
    MEAN_FIELD: {e: gas(LARGE, e, correlations=False) for e in RESTITUTIONS if e > 0.8},
    GAS: {e: gas(LARGE, e) for e in RESTITUTIONS},
}
LINES = {MEAN_FIELD: "--", GAS: "-"}  # in pictures


def predictions(results: Results) -> dict[str, dict[float, xr.Dataset]]:
    """Return the results of ``PREDICTIONS``."""
    return {
        name: {e: results[one.name] for e, one in solutions.items()}
        for name, solutions in PREDICTIONS.items()
    }
