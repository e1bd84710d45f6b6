"""The command ``crazybilliards relax``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crazybilliards.apps.commands.answers import table_of, wrote
from crazybilliards.apps.commands.options import Threads, path_option, with_chain_options
from crazybilliards.apps.commands.output import conclude, write_figures, writing_to

if TYPE_CHECKING:
    import xarray as xr

    from crazybilliards.model import Chain


@with_chain_options(without=("restitution",), amplitude=30.0)
def command(
    chain: Chain,
    output: Annotated[
        Path | None,
        path_option(
            "Folder for relaxation.nc, spacetime.png, profiles.png and cloud.png, made if missing; "
            "without it nothing is written. The first holds smoothed densities, all that the "
            "pictures show."
        ),
    ] = None,
    release: Annotated[
        str,
        typer.Option(help="compressed, displaced, quenched; in a box gathered, wave, confined."),
    ] = "compressed",
    by: Annotated[
        float | None,
        typer.Option(
            help="Factor of y (compressed; above 1: stretched), thermal lengths (displaced) or "
            "factor of the amplitude before (quenched); default: 0.3, 2 or 3. Share of the free "
            "room, at the left (gathered) or in the middle (confined), or height of a wave; "
            "default: 0.5."
        ),
    ] = None,
    duration: Annotated[float, typer.Option(help="Time to follow.")] = 40.0,
    every: Annotated[float, typer.Option(help="Time between outputs.")] = 0.5,
    replicas: Annotated[int, typer.Option(help="Simulated chains to average over.")] = 300,
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    threads: Threads = None,
    film: Annotated[
        bool, typer.Option("--film", help="Also write relaxation.html, a film of the densities.")
    ] = False,
) -> None:
    """Release an elastic chain and follow it: rods, two fluids, and the exact solution.

    An ensemble of simulated chains, hydrodynamics with a constant temperature,
    hydrodynamics with a temperature equation, and without gap the exact motion start from the same
    state. So do equal rods in a box without springs, whose motion is known, too. Prints how far the
    rods are from where each theory has them, in thermal lengths.

    Ctrl-C or SIGTERM stops early: what has been computed is written under names with
    "-interrupted".

    Example: crazybilliards relax --output results --release displaced --by 2 --gap 0.2

    Example: crazybilliards relax --output results --release gathered --box 400 --stiffness 0
    """
    from crazybilliards.comparison.side_by_side.relaxation import compare_relaxation

    if film and output is None:
        raise ValueError("film needs --output FOLDER, into which it is written")
    defaults = {"compressed": 0.3, "displaced": 2.0, "quenched": 3.0}  # others 0.5
    with writing_to(output):
        tree = compare_relaxation(
            chain,
            release,  # type: ignore[arg-type]
            defaults.get(release, 0.5) if by is None else by,
            duration=duration,
            every=every,
            replicas=replicas,
            seed=seed,
            threads=threads,
        )
        conclude(output, tree, partial(_write, film), _print)


def _write(film: bool, tree: xr.DataTree, folder: Path, suffix: str) -> None:
    from crazybilliards.comparison.films import film as write_film
    from crazybilliards.comparison.side_by_side import relaxation_figures as figures
    from crazybilliards.comparison.side_by_side.relaxation import condensed
    from crazybilliards.model import save

    tree = condensed(tree)
    wrote(save(tree, folder / f"relaxation{suffix}.nc"))
    drawings = {
        "spacetime": figures.draw_spacetime,
        "profiles": figures.draw_profiles,
        "cloud": figures.draw_cloud,
    }
    write_figures(folder, suffix, {name: partial(draw, tree) for name, draw in drawings.items()})
    if film:
        path = folder / f"relaxation{suffix}.html"
        write_film(tree, path)
        wrote(path)


def _print(tree: xr.DataTree) -> None:
    from crazybilliards.comparison.side_by_side.relaxation import LEGEND, PARTICLES, label_distances
    from crazybilliards.comparison.widths import displacement_unit
    from crazybilliards.model import chain_of

    symbol, _ = displacement_unit(chain_of(tree[PARTICLES].to_dataset()))
    unit = {"s": "thermal lengths", "h": "halves h of the room that the rods leave free"}[symbol]
    table_of(
        {"title": ("theory", str), "distance": (f"rms distance / {symbol}", "{:.3f}".format)},
        [
            {"theory": key, "title": LEGEND[key], "distance": distance}
            for key, distance in label_distances(tree).items()
        ],
        fact="distances",
        caption="Rms over the rods of their mean position in theory minus simulation, in "
        f"{unit}, at the time when it is largest.",
    )
