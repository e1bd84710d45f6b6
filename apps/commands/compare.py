"""The command ``crazybilliards compare``."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.answers import number, percent, table_of, wrote
from crazybilliards.apps.commands.options import Threads, path_option, with_chain_options
from crazybilliards.apps.commands.output import (
    complain_of_divergence,
    conclude,
    numbers,
    write_figures,
    writing_to,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from crazybilliards.model import Chain

_SYMBOLS = {"amplitude": "A", "restitution": "e"}
_IN_ERRORS = "{:.1f}".format


@with_chain_options(without=("amplitude", "restitution"))
def command(
    chain: Chain,
    output: Annotated[
        Path | None,
        path_option(
            "Folder for the figures, comparison.nc and what was computed, made if missing; "
            "without it nothing is written."
        ),
    ] = None,
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
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    processes: Annotated[
        int | None, typer.Option(help="Processes to compute in; default: this one, in threads.")
    ] = None,
    threads: Threads = None,
) -> None:
    """Compare simulated chains with their theories.

    Several values of the amplitude, or of the restitution, make as many chains. Elastic chains are
    compared with their exact equilibrium, the force balance closed by labels, its rods, and the
    paper's force balance with a fitted displacement. If any e differs from 1, all are compared with
    the kinetic equation and, where it takes the chain, that with pair correlations, into which
    nothing from the simulation goes.

    Draws everything over one another and prints how far apart it is. A theory whose own stated
    error is above a fifth of the axis is drawn faintly, in a band of that error.

    Each chain is written to FOLDER/cases when it is computed. After Ctrl-C, a crash, or with more
    chains, the same command computes what is missing. Ctrl-C or SIGTERM stops early: pictures of
    the chains that are done are written under names with "-interrupted".

    Example: crazybilliards compare --output results --amplitude 1,10 --gap 0.2

    Example: crazybilliards compare --output results --restitution 0.9,0.95,0.98
    """
    if amplitude is None:
        amplitude = "1,3,10,30" if restitution is None else "1"
    values = {
        "amplitude": numbers("amplitude", amplitude, float),
        "restitution": numbers("restitution", restitution or "1", float),
    }
    several = [name for name, each in values.items() if len(each) > 1]
    if len(several) > 1:
        raise ValueError("give several values of amplitude or of restitution, not of both")
    [over] = several or ["amplitude" if restitution is None else "restitution"]
    chain = chain.replace(**{name: each[0] for name, each in values.items()})
    from crazybilliards.comparison.side_by_side import grid

    how: dict[str, Any] = {"duration": duration, "seed": seed}
    how |= {"processes": processes, "threads": threads, "folder": output and output / "cases"}
    with writing_to(output):
        try:
            tree = grid.compare(chain, {over: values[over]}, **how)
        except RuntimeError as error:  # a worker process died
            raise ValueError(str(error)) from error
        conclude(output, tree, _write, partial(_print, over))


def _write(tree: xr.DataTree, folder: Path, suffix: str) -> None:
    from xarray import DataTree

    from crazybilliards.comparison.side_by_side import grid_figures
    from crazybilliards.model import save

    # The data first: a failing picture must not cost the computation.
    wrote(save(tree, folder / f"comparison{suffix}.nc"))
    drawings: dict[str, Callable[[], Figure]] = {}
    # A chain that diverged before anything was measured cannot be drawn.
    measured = {
        name: each for name, each in tree.children.items() if "particle" in each["simulation"].dims
    }
    if measured:
        drawn = DataTree(children=measured)
        for name in ("density", "displacement", "widths"):
            drawings[name] = partial(getattr(grid_figures, f"draw_{name}"), drawn)
    for name, group in tree.children.items():
        if "kinetic_equation" in group:
            theory = group["kinetic_equation"].to_dataset()
            drawings[f"phase_space_{name}"] = partial(grid_figures.draw_phase_space, theory)
    write_figures(folder, suffix, drawings)


def _wall_force(result: xr.Dataset, name: str) -> dict[str, float]:
    """Return the mean force on both walls, with its standard error if it has one."""
    found = {name: float(result.wall_force.mean())} if "wall_force" in result else {}
    if "wall_force_error" in result:
        found[f"{name}_error"] = math.hypot(*result.wall_force_error.values) / 2
    return found


def _print(over: str, tree: xr.DataTree) -> None:
    from crazybilliards.comparison.distances import deviations
    from crazybilliards.comparison.side_by_side.grid import TITLES

    rows = []
    for name, group in tree.children.items():
        run = group["simulation"].to_dataset()
        status = run.attrs["status"]
        here = {over: float(name.removeprefix(f"{over}_")), "status": status}
        here |= _wall_force(run, "measured_wall_force")
        for key, found in deviations(group).items():
            row = here | {"theory": key} | _wall_force(group[key].to_dataset(), "wall_force")
            row |= {f"density_{name}": value for name, value in asdict(found.density).items()}
            if (width := found.velocity_width) is not None:
                row |= {f"velocity_width_{name}": value for name, value in width._asdict().items()}
                row["velocity_width_stated"] = group[key].attrs["velocity_width_model_error"]
            rows.append(row)
        if status == "diverged":
            complain_of_divergence(run)
        if len(group.children) == 1 or status == "diverged":
            rows.append(here)
    named = {row.get("theory") for row in rows} - {"exact"}
    columns: dict[str, tuple[str, Callable[[Any], str]]] = {
        over: (_SYMBOLS[over], "{:g}".format),
        "theory": ("theory", str),
        "density_maximum": ("rho\nmax", percent),
        "density_rms": ("rho\nrms", percent),
        "density_maximum_in_errors": ("rho\nsigma", _IN_ERRORS),
        "velocity_width_largest": ("W_v\nmax", percent),
        "velocity_width_stated": ("W_v\nstated", percent),
        "velocity_width_centre": ("W_v\ncentre", percent),
        "velocity_width_border": ("W_v\nborder", percent),
        "velocity_width_largest_in_errors": ("W_v\nsigma", _IN_ERRORS),
    }
    walls = ""
    if any("measured_wall_force" in row for row in rows):
        columns["wall_force"] = ("P", number)
        columns["measured_wall_force"] = ("P\nmeasured", number)
        walls = "P: mean force on a wall [M R/T^2]. "
    table_of(
        columns,
        rows,
        fact="deviations",
        title="How far theories are from the simulation: densities rho, in % of close packing "
        "1/(2R), and velocity widths W_v, in %",
        caption="rho, smoothed as in the paper: largest difference, root mean square, and the "
        "largest in standard errors (sigma) of the simulation; 3 to 4 is normal for the largest "
        "of many. W_v, theory minus simulation: the largest of the particles 3 to L-2; the largest "
        "that the theory states (-: not measured for chains like this one); of the middle tenth; "
        f"of the first and the last; the largest of all in sigma. {walls}"
        + "; ".join(f"{key}: {title}" for key, title in TITLES.items() if key in named),
    )
