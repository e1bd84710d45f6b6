"""Joins the measurements of many replicas to one result with status, times and provenance."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.model.arrays import Array
from crazybilliards.model.warn import warn_user
from crazybilliards.model.checks import shown
from crazybilliards.model.parameters import WALLS_AND_MASSES
from crazybilliards.model.vocabulary import VOCABULARY, result
from crazybilliards.particles.laws.law import EXACT, TURN
from crazybilliards.particles.observers.base import Integers, Observer, Variables
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.replica import NEVER, Replica
from crazybilliards.particles.scales import centre_width, relaxation_time, time_step_error

# The coordinates that the result itself has.
_EVERY_RESULT = {
    *("particle", "normalized_particle", "mean_position", "contact", "normalized_contact")
}


def collect(run: Run, replicas: list[Replica], interrupted: bool) -> xr.Dataset:
    """Join the replicas' measurements into one result."""
    chain, schedule = run.chain, run.schedule
    for replica in replicas:
        replica.before_the_end = None  # to join observers takes its memory
    reached = min(replica.reached for replica in replicas)
    counts = np.array([replica.counts for replica in replicas])
    if schedule.ensemble:
        # Only times before the first divergence: the average over the other replicas would be
        # biased.
        counts = counts[:, :reached]
        counts = counts[:, counts.sum(axis=0) > 0]
        times = schedule.times[: counts.shape[1]]
        end_time = times[-1] if times.size else 0.0
    else:
        counts = counts.ravel()
        end_time = min(replica.steps for replica in replicas) * schedule.time_step
    if interrupted and counts.sum() == 0:
        raise KeyboardInterrupt("nothing was measured yet")
    variables: Variables = {}
    coordinates: dict[str, Array] = {}
    vocabulary = dict(run.vocabulary)
    given = _EVERY_RESULT.union(*((*each.gives, *each.along) for each in run.observers))
    # A chain that diverged before its first snapshot has a status and a time, but no averages.
    observed = zip(*(replica.observers for replica in replicas), strict=True)
    diverged = reached < NEVER
    for first, *others in observed if counts.sum() else ():
        first.join(others)
        with warnings.catch_warnings():
            if diverged:  # that rods lie outside of every grid then is no news
                warnings.simplefilter("ignore")
            reported = _require_variables(first, first.report(counts))
        along = first.coordinates()
        _require_own(first, [*reported, *along], given | {*variables, *coordinates})
        variables |= reported
        coordinates |= along
        vocabulary |= _undeclared(first, [*reported, *along], vocabulary)
    if schedule.ensemble:
        coordinates["time"] = times
    measured = result(
        chain,
        {name: only_chosen(run.chosen, chain.size, *each) for name, each in variables.items()},
        coordinates=coordinates,
        source="simulation",
        status="interrupted" if interrupted else "diverged" if diverged else "completed",
        end_time=end_time,
        particles=run.chosen + 1,
        vocabulary=vocabulary,
        method={**run.provenance(), "duration": schedule.duration, "snapshots": int(counts.sum())},
    )
    measured.attrs |= {
        "flight": run.flight,
        "relaxation_time": relaxation_time(chain),
        "time_step_error": _time_step_error(run, measured),
    }
    return measured


def _require_variables(observer: Observer, reported: Any) -> Variables:
    """Return what an observer reports, or raise a TypeError if these are no variables."""
    items = reported.items() if isinstance(reported, dict) else [(None, None)]
    for name, each in items:
        if not (isinstance(name, str) and isinstance(each, tuple | list) and len(each) == 2):
            raise TypeError(
                f"observe: {observer.name!r} must report {{name: (dimensions, values)}}, got "
                f"{shown(reported)}"
            )
    return dict(items)


def _require_own(observer: Observer, names: Iterable[str], taken: set[str]) -> None:
    """Raise a ValueError if an observer reports what another one, or every result, has."""
    own = {*observer.gives, *observer.along}
    if others := sorted(name for name in names if name.removesuffix("_error") in taken - own):
        raise ValueError(
            f"observe: {observer.name!r} reports {', '.join(map(repr, others))}, which the result "
            "has already and the observer does not give"
        )


def _undeclared(
    observer: Observer, names: Iterable[str], vocabulary: Mapping[str, tuple[str, str]]
) -> dict[str, tuple[str, str]]:
    """Return a vocabulary of the names that have none, with a warning: the run is not lost."""
    names = {name.removesuffix("_error") for name in names}
    unknown = sorted(names - {*vocabulary, *VOCABULARY})
    if unknown:
        warn_user(
            f"observe: {observer.name!r} reports {', '.join(map(repr, unknown))}, which it does "
            "not give: the result holds them without a meaning and a unit"
        )
    return dict.fromkeys(unknown, (f"reported by {observer.name!r} without a meaning", ""))


def _time_step_error(run: Run, measured: xr.Dataset) -> float:
    """Return the relative error of the smallest velocity width above 0; NaN if it is not known."""
    if not run.chain.unknown().keys() <= WALLS_AND_MASSES:
        return float("nan")  # nobody has measured it
    if run.operator in (EXACT, TURN):
        return 0.0
    width = centre_width(run.chain) * run.chain.free_velocity_width
    if "velocity_width" in measured:
        masses = run.chain.rod_masses[measured.particle.values.astype(int) - 1]
        widths = measured.velocity_width.values * masses / run.chain.rod_masses[:2].min()
        width = float(np.min(widths, initial=np.inf, where=widths > 0))
    step = run.schedule.time_step
    return time_step_error(run.chain, step, width, stepper=run.stepper, method=run.method)


def only_chosen(
    chosen: Integers, size: int, dimensions: tuple[str, ...], values: ArrayLike
) -> tuple[tuple[str, ...], ArrayLike]:
    """Keep the chosen particles, or contacts, of a variable that was measured for all of them."""
    values = np.asarray(values)
    for name, number in (("particle", size), ("contact", size - 1)):
        if name in dimensions and values.shape[dimensions.index(name)] == number:
            values = values.take(chosen[chosen < number], dimensions.index(name))
    return dimensions, values
