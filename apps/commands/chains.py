"""The commands that take one chain: simulate, theory, compare, relax."""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.options import (
    Json,
    Output,
    Processes,
    Seed,
    Threads,
    numbers,
    with_chain_options,
)
from crazybilliards.apps.commands.output import (
    end,
    keep,
    rods_table,
    table,
    writing_to,
    written_lines,
)

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.model import Chain


@with_chain_options()
def simulate(
    chain: Chain,
    *,
    output: Output = None,
    observe: Annotated[
        str,
        typer.Option(
            help="What to measure, separated by commas: widths, density, velocities, energy, "
            "covariances, modes, time-correlations, collisions, impacts, avalanches, "
            "triggered-collisions, walls (in a box), snapshots."
        ),
    ] = "widths,density",
    duration: Annotated[float, typer.Option(help="Time to measure, in each replica [T].")] = 5000.0,
    warmup: Annotated[
        float | None, typer.Option(help="Time before measuring [T]; default: from the chain.")
    ] = None,
    time_step: Annotated[
        float | None, typer.Option(help="Time step [T]; default: from the chain.")
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
    seed: Seed = 0,
    threads: Threads = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(help="File to keep the state in: the same command goes on from there."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Simulate one chain and write what was measured to FOLDER/simulation.nc.

    Prints how the run ended, some rods, and an overview of all that was measured; --json prints all
    values. In Python, crazybilliards.load("FOLDER/simulation.nc") gives the result. Ctrl-C or
    SIGTERM stops early: what has been measured is written to simulation-interrupted.nc.

    Example: crazybilliards simulate --size 50 --restitution 0.9 --output results
    """
    from crazybilliards import particles as room

    settings: dict[str, Any] = {
        "observe": [name.strip() for name in observe.split(",")],
        "particles": None if particles is None else numbers("particles", particles, int),
        "method": method,
        "average": average,
    }
    with writing_to(output):
        result = room.simulate(
            chain,
            duration=duration,
            warmup=warmup,
            time_step=time_step,
            every=every,
            replicas=replicas,
            seed=seed,
            threads=threads,
            checkpoint=checkpoint,
            **settings,
        )
        written = keep(result, output, "simulation")
    status, reached = result.attrs["status"], result.attrs["end_time"]
    step = json.loads(result.attrs["provenance"])["schedule"]["time_step"]
    rods = result.isel(time=-1) if "time" in result.dims else result
    end(
        {"written": written, **result.to_dict()},
        as_json,
        f"{status} at t = {reached:g} T, time step {step:.3g} T",
        f"error of the smallest W_v due to the time step: {result.attrs['time_step_error']:.1%}",
        rods_table(rods) if "velocity_width" in result else "",
        str(result),
        written_lines(written),
        status=status,
        why=_diverged(result),
    )


def _diverged(run: xr.Dataset) -> str:
    if run.attrs["status"] != "diverged":
        return ""
    from crazybilliards.model import chain_of

    chain = chain_of(run)
    return (
        f"L = {chain.size}, e = {chain.restitution:g}: the simulation diverged at "
        f"t = {run.attrs['end_time']:g} T. Collisions bring in more energy than the damping takes out."
    )


@with_chain_options()
def theory(
    chain: Chain,
    *,
    name: Annotated[
        str | None,
        typer.Argument(
            help="equilibrium, force_balance, phase_space (the kinetic equation) or "
            "correlated_phase_space (that with pair correlations); default: the one with the "
            "smallest expected error for the chain.",
            show_default=False,
        ),
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="Only list the theories.")] = False,
    output: Output = None,
    as_json: Json = False,
) -> None:
    """Predict a chain's steady state from a theory, without a simulation.

    Prints velocity widths and displacements of some rods; draws the density and the rods, of the
    kinetic equations also the phase-space density f(y, v). Without a name it takes the theory with
    the smallest expected error. Refuses where there is no steady state.

    Example: crazybilliards theory --output results --restitution 1.05 --damping 4
    """
    from crazybilliards import comparison
    from crazybilliards.comparison.side_by_side import grid_figures as figures
    from crazybilliards.comparison.stationary_theories import THEORIES, choose_theory
    from crazybilliards.model.checks import check_choice

    if listed:
        found = comparison.theories(chain)
        rows: Any = found.to_dataframe().reset_index().to_dict("records")
        heads = {"theory": "theory", "velocity_width_model_error": "error of W_v"}
        heads |= {"border_model_error": "border", "displacement_width_model_error": "W_x"}
        heads |= {"density_model_error": "density", "expected_seconds": "s", "reason": "why not"}
        end({"best": found.attrs["best"], "theories": rows}, as_json, table(rows, heads))
        return
    which, why = choose_theory(chain) if name is None else (None, "")
    if which is None:
        which = THEORIES[check_choice("name", name, tuple(THEORIES))]
        if reason := which.refusal(chain):
            raise ValueError(reason)
    with writing_to(output):
        result = which.solve(chain)
        drawings = {
            "density": partial(figures.draw_density_alone, result, which.title),
            "profile": partial(figures.draw_profile, result, which.title),
        }
        if "phase_space_density" in result:
            drawings["phase_space"] = partial(figures.draw_phase_space, result)
        written = keep(result, output, "theory", drawings)
    stated = {k: v for k, v in result.attrs.items() if k.endswith("_error") or k == "residual"}
    end(
        {"theory": which.name, "written": written, **result.to_dict()},
        as_json,
        why,
        f"{which.title.capitalize()}, L = {chain.size}, e = {chain.restitution:g}",
        rods_table(result),
        *(f"{name}: {value:.2g}" for name, value in stated.items()),
        written_lines(written),
    )


@with_chain_options("amplitude", "restitution")
def compare(
    chain: Chain,
    *,
    output: Output = None,
    amplitude: Annotated[
        str | None,
        typer.Option(
            help="Driving amplitudes A [M R/T^(3/2)], separated by commas; default: 1,3,10,30, or "
            "1 if --restitution is given."
        ),
    ] = None,
    restitution: Annotated[
        str | None, typer.Option(help="Restitutions e, separated by commas; default: 1.")
    ] = None,
    duration: Annotated[
        float, typer.Option(help="Simulated time of each of two replicas [T].")
    ] = 100_000.0,
    seed: Seed = 0,
    processes: Processes = None,
    threads: Threads = None,
    as_json: Json = False,
) -> None:
    """Compare simulated chains with their theories.

    Several values of the amplitude, or of the restitution, make as many chains. Draws everything
    over one another and prints how far apart it is: densities in shares of close packing 1/(2R),
    widths relative, both also in standard errors of the simulation (sigma). Each chain is written
    to FOLDER/cases when it is computed: after Ctrl-C or a crash, or with more chains, the same
    command computes what is missing.

    Example: crazybilliards compare --output results --amplitude 1,10 --gap 0.2

    Example: crazybilliards compare --output results --restitution 0.9,0.95,0.98
    """
    amplitude = amplitude or ("1,3,10,30" if restitution is None else "1")
    values = {
        "amplitude": numbers("amplitude", amplitude),
        "restitution": numbers("restitution", restitution or "1"),
    }
    if min(map(len, values.values())) > 1:
        raise ValueError("give several values of amplitude or of restitution, not of both")
    several = [name for name, each in values.items() if len(each) > 1]
    [over] = several or ["amplitude" if restitution is None else "restitution"]
    chain = chain.replace(**{name: each[0] for name, each in values.items()})
    from crazybilliards.comparison.side_by_side import grid
    from crazybilliards.comparison.side_by_side import grid_figures as figures

    how: dict[str, Any] = {"duration": duration, "seed": seed}
    how |= {"processes": processes, "threads": threads, "folder": output and output / "cases"}
    with writing_to(output):
        tree = grid.compare(chain, {over: values[over]}, **how)
        drawings = {
            "density": partial(figures.draw_density, tree),
            "displacement": partial(figures.draw_displacement, tree),
            "widths": partial(figures.draw_widths, tree),
        } | {
            f"phase_space_{name}": partial(
                figures.draw_phase_space, group["phase_space"].to_dataset()
            )
            for name, group in tree.children.items()
            if "phase_space" in group
        }
        written = keep(tree, output, "comparison", drawings)
    rows = _deviations(over, tree)
    columns = {over: over, "theory": "theory", "density_maximum": "rho max", "density_rms": "rms"}
    columns |= {"density_maximum_in_errors": "sigma", "velocity_width_largest": "W_v max"}
    columns |= {"velocity_width_stated": "stated", "velocity_width_centre": "centre"}
    columns |= {"velocity_width_border": "border", "velocity_width_largest_in_errors": "sigma "}
    shown = table(rows, columns), written_lines(written)
    end({"deviations": rows, "written": written}, as_json, *shown, status=tree.attrs["status"])


def _deviations(over: str, tree: xr.DataTree) -> list[dict[str, Any]]:
    """Return how far each theory is from its simulation."""
    from crazybilliards.comparison.distances import deviations

    rows = []
    for name, group in tree.children.items():
        for key, found in deviations(group).items():
            row = {over: float(name.removeprefix(f"{over}_")), "theory": key}
            row |= {f"density_{name}": value for name, value in asdict(found.density).items()}
            if (width := found.velocity_width) is not None:
                row |= {f"velocity_width_{name}": value for name, value in width._asdict().items()}
                row["velocity_width_stated"] = group[key].attrs["velocity_width_model_error"]
            rows.append(row)
    return rows


@with_chain_options("restitution", amplitude=30.0)
def relax(
    chain: Chain,
    *,
    output: Output = None,
    release: Annotated[
        str,
        typer.Option(help="compressed, displaced, quenched; in a box gathered, wave, confined."),
    ] = "compressed",
    by: Annotated[
        float | None,
        typer.Option(
            help="Factor of y (compressed), thermal lengths (displaced), factor of the amplitude "
            "before (quenched); default: 0.3, 2 or 3. In a box a share of the room or a height; 0.5."
        ),
    ] = None,
    duration: Annotated[float, typer.Option(help="Time to follow.")] = 40.0,
    every: Annotated[float, typer.Option(help="Time between outputs.")] = 0.5,
    replicas: Annotated[int, typer.Option(help="Simulated chains to average over.")] = 300,
    seed: Seed = 0,
    threads: Threads = None,
    film: Annotated[
        bool, typer.Option("--film", help="Also write relaxation.html, a film of the densities.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Release an elastic chain and follow it: rods, two fluids, and the exact solution.

    Prints how far the rods are from where each theory has them, in thermal lengths, without springs
    in halves of the free room: rms over the rods, at the time when it is largest.

    Example: crazybilliards relax --output results --release displaced --by 2 --gap 0.2

    Example: crazybilliards relax --output results --release gathered --box 400 --stiffness 0
    """
    from crazybilliards.comparison.side_by_side import relaxation
    from crazybilliards.comparison.side_by_side import relaxation_figures as figures

    if film and output is None:
        raise ValueError("film needs --output FOLDER, into which it is written")
    if by is None:
        by = {"compressed": 0.3, "displaced": 2.0, "quenched": 3.0}.get(release, 0.5)
    how: dict[str, Any] = {"release": release, "by": by, "duration": duration, "every": every}
    with writing_to(output):
        tree = relaxation.compare_relaxation(
            chain, replicas=replicas, seed=seed, threads=threads, **how
        )
        tree = relaxation.condensed(tree)
        drawings = {
            name: partial(getattr(figures, f"draw_{name}"), tree)
            for name in ("spacetime", "profiles", "cloud")
        }
        written = keep(tree, output, "relaxation", drawings)
        if film and output is not None:
            from crazybilliards.comparison import film as write_film

            written.append(str(write_film(tree, output / "relaxation.html")))
    found = relaxation.label_distances(tree)
    rows = [{"theory": key, "distance": distance} for key, distance in found.items()]
    shown = table(rows, {"theory": "theory", "distance": "rms distance, theory minus simulation"}), written_lines(written)
    end({"distances": rows, "written": written}, as_json, *shown, status=tree.attrs["status"])
