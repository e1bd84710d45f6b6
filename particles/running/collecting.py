"""Joins the measurements of many replicas to one result with status, times and provenance."""

import warnings

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from crazybilliards.model import WALLS_AND_MASSES, Array
from crazybilliards.model.vocabulary import result
from crazybilliards.model.warn import DivergedError, DivergedWarning, warn_user
from crazybilliards.particles.laws.law import EXACT, TURN
from crazybilliards.particles.observers.base import Integers, Variables
from crazybilliards.particles.run import Run
from crazybilliards.particles.running.replica import NEVER, Replica
from crazybilliards.particles.scales import centre_width
from crazybilliards.particles.timing import time_step_error


def collect(run: Run, replicas: list[Replica], interrupted: bool) -> xr.Dataset:
    """Join the replicas' measurements into one result."""
    reached = min(replica.reached for replica in replicas)
    counts = np.array([replica.counts for replica in replicas])
    if run.ensemble:
        # Only times before the first divergence: the average over the other replicas would be
        # biased.
        counts = counts[:, :reached]
        counts = counts[:, counts.sum(axis=0) > 0]
        times = run.times[: counts.shape[1]]
        end_time = times[-1] if times.size else 0.0
    else:
        counts = counts.ravel()
        # Computed as the time of the last snapshot is, which it must not differ from by rounding.
        steps = min(replica.steps for replica in replicas)
        before = min(steps, run.warmup_steps)
        end_time = before * run.time_step + (steps - before) / run.stride * run.every
    if interrupted and counts.sum() == 0:
        raise KeyboardInterrupt("nothing was measured yet")
    diverged = reached < NEVER
    with warnings.catch_warnings():
        if diverged:  # that rods lie outside of every grid then is no news
            warnings.simplefilter("ignore")
        variables, coordinates = _report(replicas, counts)
    if run.ensemble:
        coordinates["time"] = times
    variables = {name: only_chosen(run, *values) for name, values in variables.items()}
    measured = result(
        run.chain,
        variables,
        coordinates=coordinates,
        source="simulation",
        status="interrupted" if interrupted else "diverged" if diverged else "completed",
        end_time=end_time,
        particles=run.chosen + 1,
        vocabulary={k: v for observer in run.observers for k, v in observer.vocabulary.items()},
        method={**run.provenance, "duration": run.duration, "snapshots": int(counts.sum())},
    )
    measured.attrs |= run.attributes | {"time_step_error": _time_step_error(run, measured)}
    if diverged:
        _tell_of_divergence(run, measured)
    return measured


def _tell_of_divergence(run: Run, measured: xr.Dataset) -> None:
    """Warn that the chain diverged, when and why; raise if nothing was measured before."""
    why = f"the time_step {run.time_step:.3g} is too long for its springs; give a shorter one"
    if max(run.chain.restitution, run.chain.wall_restitution) > 1:
        why = (
            "at restitution > 1 collisions bring in more energy than the damping takes out. Take "
            "fewer rods (critical_size(chain) estimates how many are too many), more damping, or "
            "the start equilibrium_states(chain.replace(restitution=1), replicas)"
        )
    text = f"the chain diverged after t = {measured.attrs['end_time']:g}"
    if measured.data_vars:
        warn_user(f"{text}: {why}. Averages over time include its growth", DivergedWarning)
        return
    text += f" and before the first snapshot at t = {run.time(0):g}, so nothing was measured"
    error = DivergedError(f"{text}: {why}. To see it grow, give warmup=0 and a shorter every")
    error.result = measured
    raise error


def _report(replicas: list[Replica], counts: Integers) -> tuple[Variables, dict[str, Array]]:
    """Join the observers of all replicas; return their variables and coordinates.

    A chain that diverged before its first snapshot has none.
    """
    variables: Variables = {}
    coordinates: dict[str, Array] = {}
    if counts.sum():
        for first, *others in zip(*(replica.observers for replica in replicas), strict=True):
            first.join(others)
            # An error if two observers report the same variable.
            variables = dict(**variables, **first.report(counts))
            coordinates |= first.coordinates()
    return variables, coordinates


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
    return time_step_error(run.chain, run.time_step, width, stepper=run.stepper, method=run.method)


def only_chosen(
    run: Run, dimensions: tuple[str, ...], values: ArrayLike
) -> tuple[tuple[str, ...], ArrayLike]:
    """Keep the chosen particles, or contacts, of a variable that was measured for all of them."""
    values, size = np.asarray(values), run.chain.size
    for name, number in (("particle", size), ("contact", size - 1)):
        if name in dimensions and values.shape[dimensions.index(name)] == number:
            values = values.take(run.chosen[run.chosen < number], dimensions.index(name))
    return dimensions, values
