"""The command ``crazybilliards simulate``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.answers import answer_measured, answer_rods, note, say, wrote
from crazybilliards.apps.commands.options import Threads, path_option, with_chain_options
from crazybilliards.apps.commands.output import (
    complain_of_divergence,
    conclude,
    numbers,
    result_file,
    writing_to,
)

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.model import Chain


@with_chain_options()
def command(
    chain: Chain,
    output: Annotated[
        Path | None,
        path_option(
            "Folder for simulation.nc, made if missing, or another name for this file, FILE.nc; "
            "without it nothing is written.",
            "FOLDER|FILE.nc",
        ),
    ] = None,
    observe: Annotated[
        str,
        typer.Option(
            help="What to measure, separated by commas: widths, density, velocities, energy, "
            "covariances, modes, time-correlations, collisions, impacts, avalanches, "
            "triggered-collisions, walls (in a box), snapshots."
        ),
    ] = "widths,density",
    duration: Annotated[
        float, typer.Option(help="Time to measure, in each replica [T].")
    ] = 5_000.0,
    warmup: Annotated[
        float | None, typer.Option(help="Time before measuring [T]; default: from the chain.")
    ] = None,
    time_step: Annotated[
        float | None, typer.Option(help="Time step [T]; default: from the chain.")
    ] = None,
    accuracy: Annotated[
        float | None,
        typer.Option(
            help="Relative error wanted of W_v in the centre, 0.01 say: simulates the limit of a "
            "vanishing time step, for as long as that takes."
        ),
    ] = None,
    every: Annotated[
        float | None,
        typer.Option(
            help="Time between snapshots [T]; default: 10 time steps, for an ensemble duration/100."
        ),
    ] = None,
    average: Annotated[
        str, typer.Option(help="Average over the time, or over an ensemble of replicas.")
    ] = "time",
    replicas: Annotated[int, typer.Option(help="Independent copies of the chain.")] = 1,
    particles: Annotated[
        str | None,
        typer.Option(help="Particles to report, from 1, separated by commas; default: all."),
    ] = None,
    method: Annotated[
        str, typer.Option(help="Collisions: event-driven or contact-dynamics.")
    ] = "event-driven",
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    threads: Threads = None,
    checkpoint: Annotated[
        Path | None,
        path_option(
            "File to keep the state in: the same command goes on from there.",
            "FILE",
            ("--checkpoint",),
        ),
    ] = None,
) -> None:
    """Simulate one chain and write what was measured to a file.

    Prints how the run ended, widths and displacements of some rods, and one value of everything
    else that was measured, with standard errors. With --json it prints all values. In Python,
    crazybilliards.load("FOLDER/simulation.nc") gives the result.

    Ctrl-C or SIGTERM stops early: what has been measured is written under the name with
    "-interrupted".

    Example: crazybilliards simulate --size 50 --restitution 0.9 --output run.nc

    Example: crazybilliards simulate --observe velocities,energy --replicas 4 --output run.nc

    Example: crazybilliards simulate --restitution 0 --accuracy 0.005 --output limit.nc
    """
    from crazybilliards.particles import simulate, simulate_limit

    common: dict[str, Any] = {
        "warmup": warmup,
        "seed": seed,
        "observe": [name.strip() for name in observe.split(",")],
        "particles": None if particles is None else numbers("particles", particles, int),
        "replicas": replicas,
        "threads": threads,
        "checkpoint": checkpoint,
    }
    if accuracy is not None:
        _refuse(duration=duration, time_step=time_step, every=every, average=average, method=method)
    file = output and result_file(output, "simulation.nc")
    with writing_to(file, file=True):
        if accuracy is None:
            result = simulate(
                chain,
                duration=duration,
                time_step=time_step,
                method=method,  # type: ignore[arg-type]
                average=average,  # type: ignore[arg-type]
                every=every,
                **common,
            )
        else:
            result = simulate_limit(chain, accuracy=accuracy, **common)
        conclude(file, result, _write, _print, kept="FOLDER keeps the result")


def _write(result: xr.Dataset, file: Path, suffix: str) -> None:
    from crazybilliards.model import save

    wrote(save(result, file.with_stem(file.stem + suffix)))


def _refuse(**given: object) -> None:
    """Refuse settings of one run that mean nothing for a limit, unless they are the defaults."""
    from inspect import signature

    from crazybilliards.particles import simulate

    for name, value in given.items():
        if value != signature(simulate).parameters[name].default:
            raise ValueError(f"--{name.replace('_', '-')} has no meaning with --accuracy")


def _print(result: xr.Dataset) -> None:
    import json

    how = json.loads(result.attrs["provenance"])
    step = how["schedule"]["time_step"]
    status, end = result.attrs["status"], result.attrs["end_time"]
    note(end_time=end, time_steps=[step])
    say(f"{status} at t = {end:g} T, time step {step:.3g} T")
    if status == "diverged":
        complain_of_divergence(result)
    if "central_velocity_width" in result:
        width, error = result.central_velocity_width, result.central_velocity_width_error
        note(central_velocity_width=width.item(), central_velocity_width_error=error.item())
        say(f"W_v in the centre as dt -> 0: {width.item():.5g} +- {error.item():.2g} R/T")
    error = result.attrs["time_step_error"]
    if status != "diverged":
        known = not math.isnan(error)
        note(time_step_error=error if known else None)
        shown = f"{error:.1%}" if known else "not known"
        say(f"error of the smallest W_v due to the time step: {shown}")
    if "velocity_width" in result:
        last = "time" in result.velocity_width.dims
        answer_rods(
            result.isel(time=-1) if last else result,
            "Some rods at the last time" if last else "Some rods",
            "+-: one standard error.",
        )
    answer_measured(result, ensemble=how["schedule"]["ensemble"])
