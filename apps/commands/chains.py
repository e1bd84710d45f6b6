"""The commands that take one chain to its steady state: simulate and theory."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from typer import Argument, Option

from crazybilliards.apps.commands.options import Json, Output, Seed, Threads, chain_options, numbers
from crazybilliards.apps.commands.output import (
    conclude,
    measured_table,
    picture,
    rods_table,
    table,
    writing_to,
)

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

    from crazybilliards.model import Chain

_ERRORS = {
    "velocity_width_model_error": "W_v\n[%]",
    "border_model_error": "W_v\nends\n[%]",
    "displacement_width_model_error": "W_x\n[%]",
    "mean_displacement_model_error": "<dx>\n[%]",
    "density_model_error": "rho\n[%]",
}
_OF_WALLS = {"wall_force_model_error": "force on\nwalls\n[%]"}
_OF_ERRORS = (
    "Largest errors of the theory on chains like this one: of W_v (particles 3 to L-2; ends: the "
    "first and the last) and W_x; of <dx>, relative to the thermal length; of the smoothed density "
    "rho, to close packing. -: not measured."
)


@chain_options()
def simulate(
    chain: Chain,
    *,
    output: Output = None,
    observe: str = Option(
        "widths,density",
        help="What to measure, separated by commas: widths, density, velocities, energy, "
        "covariances, modes, time-correlations, collisions, impacts, avalanches, "
        "triggered-collisions, walls (in a box), snapshots.",
    ),
    duration: float = Option(5000.0, help="Time to measure, in each replica [t_0]."),
    warmup: float | None = Option(None, help="Time before it [t_0]; default: from the chain."),
    time_step: float | None = Option(None, help="Time step [t_0]; default: from the chain."),
    every: float | None = Option(
        None, help="Time between snapshots [t_0]; default: 10 steps, in an ensemble duration/100."
    ),
    average: Literal["time", "ensemble"] = Option("time", help="Average over time, or replicas."),
    replicas: int = Option(1, help="Independent copies of the chain."),
    particles: str | None = Option(None, help="Particles to report, 1,6 say; default: all."),
    method: Literal["event-driven", "contact-dynamics"] = Option(
        "event-driven", help="How collisions are resolved."
    ),
    seed: Seed = 0,
    threads: Threads = None,
    checkpoint: Path | None = Option(None, help="File of the state; the same command resumes."),
    as_json: Json = False,
) -> None:
    """Simulate one chain and write what was measured to FOLDER/simulation.nc.

    Prints how the run ended, widths and displacements of some rods, and an overview of everything
    that was measured; with --json all values. In Python, crazybilliards.load of the file gives the
    result. Ctrl-C or SIGTERM stops early: what has been measured is written to
    simulation-interrupted.nc.

    Example: crazybilliards simulate --size 50 --restitution 0.9 --output results
    """
    from crazybilliards.particles import simulate as run_simulation

    reported = None if particles is None else numbers("particles", particles, int)
    with writing_to(output, "simulation.nc"):
        run = run_simulation(
            chain,
            observe=[name.strip() for name in observe.split(",")],
            duration=duration,
            warmup=warmup,
            time_step=time_step,
            every=every,
            average=average,
            replicas=replicas,
            particles=reported,
            method=method,
            seed=seed,
            threads=threads,
            checkpoint=checkpoint,
        )
        conclude(run, output, "simulation.nc", {}, as_json, run.to_dict(), *_run_text(run))


def _run_text(run: xr.Dataset) -> list[str | Table]:
    """Return what a simulation is to print."""
    step = json.loads(run.attrs["provenance"])["schedule"]["time_step"]
    error = run.attrs["time_step_error"]
    known = "not known" if error != error else f"{error:.1%}"
    text: list[str | Table] = [
        f"{run.attrs['status']} at t = {run.attrs['end_time']:g} t_0, time step {step:.3g} t_0",
        f"error of the smallest W_v due to the time step: {known}",
    ]
    if "velocity_width" in run:
        ensemble = "time" in run.velocity_width.dims
        text.append("Some rods at the last time:" if ensemble else "Some rods:")
        text.append(rods_table(run.isel(time=-1) if ensemble else run))
    return [*text, "All that was measured:", measured_table(run)]


@chain_options()
def theory(
    chain: Chain,
    *,
    name: str | None = Argument(
        None,
        help="equilibrium (exact, restitution 1), steady_state (the gas, any restitution) or "
        "force_balance (of the paper); default: equilibrium if it holds, otherwise steady_state.",
    ),
    output: Output = None,
    as_json: Json = False,
) -> None:
    """Predict a chain's steady state from a theory, without a simulation.

    Prints velocity widths and displacements of some rods, and the errors that the theory states;
    draws the density and the rods. Refuses where there is no steady state.

    Example: crazybilliards theory --output results --restitution 0.9 --gap 0.5
    """
    from crazybilliards.comparison.side_by_side import grid_figures as figures
    from crazybilliards.comparison.stationary_theories import THEORIES, theory_of
    from crazybilliards.model.checks import check_choice

    solver = THEORIES[check_choice("name", name, THEORIES)] if name else theory_of(chain)
    solver.check(chain)
    with writing_to(output, "theory.nc"):
        result = solver.solve(chain)
        pictures = {
            "density.png": picture(figures.draw_density_alone, result, solver.title),
            "profile.png": picture(figures.draw_profile, result, solver.title),
        }
        errors = table(_ERRORS | _OF_WALLS if chain.box else _ERRORS, [result.attrs], _OF_ERRORS)
        conclude(
            result,
            output,
            "theory.nc",
            pictures,
            as_json,
            {"theory": solver.name} | result.to_dict(),
            f"{solver.title.capitalize()}, L = {chain.size}, e = {chain.restitution:g}",
            rods_table(result),
            f"residual: {result.attrs['residual']:.1e}",
            errors,
        )
