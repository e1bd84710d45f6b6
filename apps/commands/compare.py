"""The command ``crazybilliards compare``.

Only the standard library and typer are imported up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crazybilliards.apps.commands.answers import note, print_table, wrote
from crazybilliards.apps.commands.chain_options import with_chain_options
from crazybilliards.apps.commands.output import (
    complain_of_divergence,
    conclude,
    numbers,
    place,
    write_figure,
    write_figures,
    writing_to,
)

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.model import Chain


@with_chain_options(without=("amplitude", "restitution"))
def command(
    chain: Chain,
    output: Annotated[
        Path | None,
        typer.Option(
            help="Folder for the figures and comparison.nc, made if missing; without it nothing is "
            "written.",
            parser=place,
            metavar="FOLDER",
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
    duration: Annotated[
        float | None,
        typer.Option(
            help="Simulated time of each of two replicas; default: 100000, with --restitution 5000."
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    threads: Annotated[
        int | None, typer.Option(help="Threads to simulate in; default: one per core.")
    ] = None,
) -> None:
    """Compare simulated chains with their theories.

    Without --restitution: the elastic chain at several driving amplitudes, with its exact
    equilibrium, the force balance closed by labels and the paper's force balance with a fitted
    displacement. With it: chains of other restitutions, with the kinetic equation and, where it
    takes the chain, that with pair correlations, into which nothing from the simulation goes.

    Draws everything over one another and prints how far apart it is.

    Ctrl-C or SIGTERM stops early: what has been computed is written under names with
    "-interrupted". The picture of a restitution is written under such a name as soon as it can be
    drawn, and gets its own name at the end.

    Example: crazybilliards compare --output results --amplitudes 1,10 --gap 0.2

    Example: crazybilliards compare --output results --restitution 0.9,0.95,0.98
    """
    settings: dict[str, Any] = {"seed": seed, "threads": threads}
    if duration is not None:
        settings["duration"] = duration
    with writing_to(output):
        if restitution is None:
            tree = _elastic(chain, amplitudes, **settings)
            write: Callable[..., None] = _write_comparison
            show = _print_deviations
        else:
            if amplitudes is not None:
                raise ValueError("give restitution or amplitudes, not both")
            drawn: dict[str, Path] = {}
            early = None if output is None else partial(_draw_early, output, drawn)
            tree = _inelastic(chain, restitution, finished=early, **settings)
            write, show = partial(_write_restitutions, drawn), _print_widths
        status = tree.attrs["status"]
        note(status=status)
        conclude(output, status, partial(write, tree), partial(show, tree))


def _elastic(chain: Chain, amplitudes: str | None, **settings: Any) -> xr.DataTree:
    if chain.size < 3:
        raise ValueError(
            f"size must be at least 3 to compare with an arctanh fit, got {chain.size}"
        )
    from crazybilliards.comparison.side_by_side.elastic_chain import compare_elastic

    values = numbers("amplitudes", "1,3,10,30" if amplitudes is None else amplitudes, float)
    return compare_elastic(chain, values, **settings)


def _inelastic(chain: Chain, restitution: str, **settings: Any) -> xr.DataTree:
    from crazybilliards.comparison.side_by_side.restitutions import compare_restitutions

    values = numbers("restitution", restitution, float)
    return compare_restitutions(chain, values, **settings)


def _write_comparison(tree: xr.DataTree, folder: Path, suffix: str) -> None:
    from crazybilliards.comparison.side_by_side.elastic_figures import (
        draw_density,
        draw_displacement,
    )
    from crazybilliards.model import save

    # The data first: a failing picture must not cost the computation.
    wrote(save(tree, folder / f"comparison{suffix}.nc"))
    drawings = {"density": draw_density, "displacement": draw_displacement}
    write_figures(folder, suffix, {name: partial(draw, tree) for name, draw in drawings.items()})


def _print_deviations(tree: xr.DataTree) -> None:
    from rich.table import Table

    from crazybilliards.comparison.side_by_side.elastic_chain import (
        LEGEND,
        deviations,
        largest_width_error,
    )

    table = Table(
        title="Density: simulation minus theory, in % of close packing 1/(2R)",
        caption="Smoothed as in the paper. max, rms: largest and root mean square. [sigma]: "
        "largest in standard errors of the simulation; 3 to 4 is normal for the largest of many "
        "bins or rods. W_v: the velocity widths' largest distance from their exact value. A in "
        "M R/T^(3/2).",
    )
    table.add_column("A", justify="right")
    for name in LEGEND.values():
        table.add_column("\n".join((*name.split(", "), "max / rms [%]")), justify="right")
    table.add_column("exact\n[sigma]", justify="right")
    table.add_column("W_v\n[sigma]", justify="right")
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
                for key in LEGEND
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


def _draw_early(
    folder: Path, drawn: dict[str, Path], name: str, results: Mapping[str, xr.Dataset]
) -> None:
    """Draw what shows one chain only, while the others are still to be computed."""
    from crazybilliards.comparison.side_by_side.restitution_figures import draw_phase_space
    from crazybilliards.comparison.side_by_side.restitutions import THEORY

    if THEORY not in results:
        return
    path = folder / f"phase_space_{name}-interrupted.png"
    # A picture that fails here is drawn once more at the end, when the data have been written.
    with suppress(Exception):
        write_figure(path, partial(draw_phase_space, results[THEORY]))
        drawn[name] = path


def _write_restitutions(
    drawn: Mapping[str, Path], tree: xr.DataTree, folder: Path, suffix: str
) -> None:
    from crazybilliards.comparison.side_by_side.restitution_figures import (
        draw_phase_space,
        draw_widths,
    )
    from crazybilliards.comparison.side_by_side.restitutions import THEORY
    from crazybilliards.model import save

    wrote(save(tree, folder / f"comparison{suffix}.nc"))
    for name, path in drawn.items():
        wrote(path.replace(folder / f"phase_space_{name}{suffix}.png"))
    drawings = {"widths": partial(draw_widths, tree)}
    for name, group in tree.children.items():
        if THEORY in group and name not in drawn:
            theory = group[THEORY].to_dataset()
            drawings[f"phase_space_{name}"] = partial(draw_phase_space, theory)
    write_figures(folder, suffix, drawings)


def _print_widths(tree: xr.DataTree) -> None:
    from rich.table import Table

    from crazybilliards.comparison.side_by_side.restitutions import LEGEND, width_deviations

    table = Table(
        title="Velocity widths W_v: theory minus simulation, in %",
        caption="Largest: of the particles 3 to L-2. Border: the first and the last. Errors: one "
        "standard error of the simulation. Expected: the largest that the theory states (-: not "
        "measured for chains like this one).",
    )
    headings = (
        "largest",
        "expected",
        "centre",
        "border",
        "error of\na rod",
        "error of\nthe border",
    )
    table.add_column("e", justify="right")
    table.add_column("theory")
    for heading in headings:
        table.add_column(heading, justify="right")
    noted = []
    for name, by_theory in width_deviations(tree).items():
        run, restitution = tree[name]["simulation"], name.removeprefix("restitution_")
        status = run.attrs["status"]
        shown = restitution + ("" if status == "completed" else f" ({status})")
        for key, found in by_theory.items():
            stated = tree[name][key].attrs["model_error"]
            values = (f"{100 * value:.2f}" for value in (found[0], stated, *found[1:]))
            table.add_row(shown, LEGEND[key].name, *(each.replace("nan", "-") for each in values))
        if not by_theory:
            table.add_row(shown, *["-"] * 7)
        here = {key: found._asdict() for key, found in by_theory.items()}
        noted.append({"restitution": float(restitution), "status": status} | here)
        if status == "diverged":
            complain_of_divergence(run.to_dataset())
    note(velocity_width_deviations=noted)
    print_table(table)
