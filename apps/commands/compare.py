"""The command ``crazybilliards compare``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.answers import empty_table, note, print_table, wrote
from crazybilliards.apps.commands.options import KeepOld, Threads, path_option, with_chain_options
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
    amplitudes: Annotated[
        str | None,
        typer.Option(help="Driving amplitudes A, separated by commas; default: 1,3,10,30."),
    ] = None,
    restitution: Annotated[
        str | None,
        typer.Option(
            help="Restitutions e, separated by commas: compare with the kinetic equations instead."
        ),
    ] = None,
    amplitude: Annotated[
        float | None,
        typer.Option(help="With --restitution: driving amplitude A [M R/T^(3/2)]; default: 1."),
    ] = None,
    duration: Annotated[
        float | None,
        typer.Option(
            help="Simulated time of each of two replicas; default: 100000, with --restitution 5000."
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    processes: Annotated[
        int | None, typer.Option(help="Processes to compute in; default: this one, in threads.")
    ] = None,
    threads: Threads = None,
    keep_old: KeepOld = False,
) -> None:
    """Compare simulated chains with their theories.

    Without --restitution: the elastic chain at several driving amplitudes, with its exact
    equilibrium, the force balance closed by labels and the paper's force balance with a fitted
    displacement. With it: chains of other restitutions, with the kinetic equation and, where it
    takes the chain, that with pair correlations, into which nothing from the simulation goes.

    Draws everything over one another and prints how far apart it is. A theory whose own stated
    error is above a fifth of the axis is drawn faintly, in a band of that error.

    Each chain is written to FOLDER/cases when it is computed. After Ctrl-C, a crash, or with more
    chains, the same command computes what is missing. Ctrl-C or SIGTERM stops early: pictures of
    the chains that are done are written under names with "-interrupted".

    Example: crazybilliards compare --output results --amplitudes 1,10 --gap 0.2

    Example: crazybilliards compare --output results --restitution 0.9,0.95,0.98
    """
    if amplitudes is not None and restitution is not None:
        raise ValueError(
            "give restitution or amplitudes, not both; with --restitution, --amplitude is that of "
            "all chains"
        )
    if amplitude is not None:
        if restitution is None:
            raise ValueError(
                f"amplitude needs --restitution; without, give --amplitudes {amplitude:g}"
            )
        chain = chain.replace(amplitude=amplitude)
    if restitution is None and chain.size < 3:
        raise ValueError(
            f"size must be at least 3 to compare with an arctanh fit, got {chain.size}"
        )
    from crazybilliards.comparison.side_by_side.grid import compare_elastic, compare_restitutions

    how: dict[str, Any] = {"seed": seed, "processes": processes, "threads": threads}
    how |= {"folder": output and output / "cases", "keep_old": keep_old}
    how |= {} if duration is None else {"duration": duration}
    with writing_to(output):
        try:
            if restitution is not None:
                values = numbers("restitution", restitution, float)
                tree = compare_restitutions(chain, values, **how)
            else:
                values = numbers(
                    "amplitudes", "1,3,10,30" if amplitudes is None else amplitudes, float
                )
                tree = compare_elastic(chain, values, **how)
        except RuntimeError as error:  # a worker process died
            raise ValueError(str(error)) from error
        conclude(output, tree, _write, _print_deviations if restitution is None else _print_widths)


def _write(tree: xr.DataTree, folder: Path, suffix: str) -> None:
    from xarray import DataTree

    from crazybilliards.comparison.side_by_side import grid_figures
    from crazybilliards.model import save

    # The data first: a failing picture must not cost the computation.
    wrote(save(tree, folder / f"comparison{suffix}.nc"))
    groups = dict(tree.children)
    drawings: dict[str, Callable[[], Figure]] = {}
    # A chain that diverged before anything was measured cannot be drawn.
    measured = {
        name: each for name, each in groups.items() if "particle" in each["simulation"].dims
    }
    if measured:
        drawn = DataTree(children=measured)
        drawings["density"] = partial(grid_figures.draw_density, drawn)
        if "exact" in next(iter(measured.values())):
            drawings["displacement"] = partial(grid_figures.draw_displacement, drawn)
        else:
            drawings["widths"] = partial(grid_figures.draw_widths, drawn)
    for name, group in groups.items():
        if "kinetic_equation" in group:
            theory = group["kinetic_equation"].to_dataset()
            drawings[f"phase_space_{name}"] = partial(grid_figures.draw_phase_space, theory)
    write_figures(folder, suffix, drawings)


def _print_deviations(tree: xr.DataTree) -> None:
    from crazybilliards.comparison.side_by_side.grid import ELASTIC
    from crazybilliards.comparison.side_by_side.grid_deviations import (
        deviations,
        largest_width_error,
    )

    theories = ["\n".join((*name.split(", "), "max / rms [%]")) for name in ELASTIC.values()]
    table = empty_table(
        [],
        ["A", *theories, "exact\n[sigma]", "W_v\n[sigma]"],
        title="Density: simulation minus theory, in % of close packing 1/(2R)",
        caption="Smoothed as in the paper. max, rms: largest and root mean square. [sigma]: "
        "largest in standard errors of the simulation; 3 to 4 is normal for the largest of many "
        "bins or rods. W_v: the velocity widths' largest distance from their exact value. A in "
        "M R/T^(3/2).",
    )
    noted = []
    for name, by_theory in deviations(tree).items():
        exact, amplitude = by_theory.get("exact"), name.removeprefix("amplitude_")
        widths = largest_width_error(tree.children[name])
        table.add_row(
            amplitude,
            *(
                f"{100 * by_theory[key].maximum:.2f} / {100 * by_theory[key].rms:.2f}"
                if key in by_theory
                else "-"
                for key in ELASTIC
            ),
            "-" if exact is None else f"{exact.maximum_in_errors or 0:.1f}",
            f"{widths:.1f}",
        )
        noted.append(
            {"amplitude": float(amplitude), "velocity_width_in_errors": widths}
            | {key: asdict(each) for key, each in by_theory.items()}
        )
    note(density_deviations=noted)
    print_table(table)


def _print_widths(tree: xr.DataTree) -> None:
    from crazybilliards.comparison.side_by_side.grid import KINETIC
    from crazybilliards.comparison.side_by_side.grid_deviations import width_deviations

    table = empty_table(
        ["e", "theory"],
        ["largest", "expected", "centre", "border", "error of\na rod", "error of\nthe border"],
        title="Velocity widths W_v: theory minus simulation, in %",
        caption="Largest: of the particles 3 to L-2. Border: the first and the last. Errors: one "
        "standard error of the simulation. Expected: the largest that the theory states (-: not "
        "measured for chains like this one).",
    )
    noted = []
    for name, by_theory in width_deviations(tree).items():
        run, restitution = tree[name]["simulation"], name.removeprefix("restitution_")
        status = run.attrs["status"]
        shown = restitution + ("" if status == "completed" else f" ({status})")
        for key, found in by_theory.items():
            stated = tree[name][key].attrs["velocity_width_model_error"]
            values = (f"{100 * value:.2f}" for value in (found[0], stated, *found[1:]))
            table.add_row(shown, KINETIC[key], *(each.replace("nan", "-") for each in values))
        if not by_theory:
            table.add_row(shown, *["-"] * 7)
        here = {key: found._asdict() for key, found in by_theory.items()}
        noted.append({"restitution": float(restitution), "status": status} | here)
        if status == "diverged":
            complain_of_divergence(run.to_dataset())
    note(velocity_width_deviations=noted)
    print_table(table)
