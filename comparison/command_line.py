"""The command ``crazybilliards``: one subcommand per job.

Only the standard library and typer are imported up here, so that ``--help`` answers at once; a
job imports what it needs when it runs.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

INTERRUPTED = 130

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback()
def crazybilliards() -> None:
    """Noisy rods on springs colliding in one dimension: simulation and theory side by side.

    Lengths are in units of the rod radius R, masses in M, times in sqrt(M/k).

    Example: crazybilliards compare --output results
    """


@app.command()
def compare(
    output: Annotated[
        Path | None,
        typer.Option(
            help="Folder for density.png, displacement.png and comparison.nc, made if missing; "
            "without it nothing is written."
        ),
    ] = None,
    size: Annotated[int, typer.Option(help="Number of rods L, at least 3.")] = 100,
    amplitudes: Annotated[
        str, typer.Option(help="Driving amplitudes A, separated by commas.")
    ] = "1,3,10,30",
    gap: Annotated[float, typer.Option(help="Gap g between rods at their anchors [R].")] = 0.0,
    duration: Annotated[
        float, typer.Option(help="Simulated time of each of two replicas.")
    ] = 200_000.0,
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    threads: Annotated[
        int | None, typer.Option(help="Threads to simulate in; default: one per core.")
    ] = None,
) -> None:
    """Compare the elastic chain with its theories, at several driving amplitudes.

    Simulates the chain at restitution 1, computes its exact equilibrium, the force balance
    closed by labels and the paper's force balance with a fitted displacement, draws them over
    one another and prints how far apart they are.

    Ctrl-C stops early: what has been computed is written under names with "-interrupted".

    Example: crazybilliards compare --output results --amplitudes 1,10 --gap 0.2
    """
    from crazybilliards.comparison.elastic_chain import compare_elastic
    from crazybilliards.model import Chain

    if size < 3:
        raise ValueError(f"size must be at least 3 to compare with an arctanh fit, got {size}")
    if output is not None:
        _check_folder(output)
    tree = compare_elastic(
        Chain(size=size, gap=gap),
        _numbers("amplitudes", amplitudes),
        duration=duration,
        seed=seed,
        threads=threads,
    )
    status = tree.attrs["status"]
    if output is not None:
        _write_comparison(tree, output, "" if status == "completed" else f"-{status}")
    _print_deviations(tree)
    if output is None:
        print("Nothing was written; --output FOLDER keeps the figures and the data.")
    _exit_unless_completed(status)


def _write_comparison(tree: xr.DataTree, folder: Path, suffix: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from crazybilliards.comparison.elastic_figures import draw_density, draw_displacement
    from crazybilliards.model import save

    # The data first: a failing picture must not cost the computation.
    print(f"wrote {save(tree, folder / f'comparison{suffix}.nc')}")
    _write_figures(folder, suffix, density=draw_density(tree), displacement=draw_displacement(tree))


@app.command()
def relax(
    output: Annotated[
        Path | None,
        typer.Option(
            help="Folder for relaxation.nc, spacetime.png, profiles.png, cloud.png, "
            "relaxation.html and relaxation.gif, made if missing; without it nothing is written."
        ),
    ] = None,
    release: Annotated[
        str, typer.Option(help="compressed (or stretched), displaced or quenched.")
    ] = "compressed",
    by: Annotated[
        float | None,
        typer.Option(
            help="Factor of y (compressed), thermal lengths (displaced) or factor of the amplitude "
            "before (quenched); default: 0.3, 2 or 3."
        ),
    ] = None,
    size: Annotated[int, typer.Option(help="Number of rods L.")] = 100,
    amplitude: Annotated[float, typer.Option(help="Driving amplitude A.")] = 30.0,
    gap: Annotated[float, typer.Option(help="Gap g between rods at their anchors [R].")] = 0.0,
    duration: Annotated[float, typer.Option(help="Time to follow.")] = 40.0,
    every: Annotated[float, typer.Option(help="Time between outputs.")] = 0.5,
    replicas: Annotated[int, typer.Option(help="Simulated chains to average over.")] = 300,
    seed: Annotated[int, typer.Option(help="Seed of the random numbers.")] = 0,
    threads: Annotated[
        int | None, typer.Option(help="Threads to simulate in; default: one per core.")
    ] = None,
) -> None:
    """Release an elastic chain and follow it: rods, two fluids, and the exact solution.

    An ensemble of simulated chains, the isothermal hydrodynamics (the paper's), hydrodynamics
    with a temperature, and without gap the exact motion start from the same state. Prints how far
    the rods are from where each theory has them, in thermal lengths.

    Ctrl-C stops early: what has been computed is written under names with "-interrupted".

    Example: crazybilliards relax --output results --release displaced --by 2 --gap 0.2
    """
    from crazybilliards.comparison.relaxation import compare_relaxation
    from crazybilliards.model import Chain

    defaults = {"compressed": 0.3, "displaced": 2.0, "quenched": 3.0}
    if release not in defaults:
        raise ValueError(f"release must be one of {tuple(defaults)}, got {release!r}")
    if output is not None:
        _check_folder(output)
    tree = compare_relaxation(
        Chain(size=size, amplitude=amplitude, gap=gap),
        release,  # type: ignore[arg-type]
        defaults[release] if by is None else by,
        duration=duration,
        every=every,
        replicas=replicas,
        seed=seed,
        threads=threads,
    )
    status = tree.attrs["status"]
    if output is not None:
        _write_relaxation(tree, output, "" if status == "completed" else f"-{status}")
    _print_distances(tree)
    if output is None:
        print("Nothing was written; --output FOLDER keeps the figures and the data.")
    _exit_unless_completed(status)


def _write_relaxation(tree: xr.DataTree, folder: Path, suffix: str) -> None:
    import tempfile

    import matplotlib

    matplotlib.use("Agg")
    from crazybilliards.comparison import relaxation_figures as figures
    from crazybilliards.model import save
    from crazybilliards.model.storage import write_atomically

    print(f"wrote {save(tree, folder / f'relaxation{suffix}.nc')}")
    _write_figures(
        folder,
        suffix,
        spacetime=figures.draw_spacetime(tree),
        profiles=figures.draw_profiles(tree),
        cloud=figures.draw_cloud(tree),
    )
    animation = figures.animate(tree)
    with tempfile.TemporaryDirectory() as scratch:  # matplotlib wants a name, not a stream
        gif = Path(scratch, "relaxation.gif")
        animation.save(gif, writer="pillow", dpi=80)
        contents = {"html": animation.to_jshtml().encode(), "gif": gif.read_bytes()}
    for kind, content in contents.items():
        path = folder / f"relaxation{suffix}.{kind}"
        write_atomically(path, content)
        print(f"wrote {path}")


def _print_distances(tree: xr.DataTree) -> None:
    from rich.console import Console
    from rich.table import Table

    from crazybilliards.comparison.relaxation import THEORIES, label_distances

    table = Table(
        caption="Rms over the rods of their mean position in theory minus simulation, in thermal "
        "lengths, at the time when it is largest.",
    )
    table.add_column("theory")
    table.add_column("rms distance / s", justify="right")
    for key, distance in label_distances(tree).items():
        table.add_row(THEORIES[key], f"{distance:.3f}")
    Console().print(table)


def _write_figures(folder: Path, suffix: str, **figures: Figure) -> None:
    from io import BytesIO

    from crazybilliards.model.storage import write_atomically

    for name, figure in figures.items():
        picture = BytesIO()
        figure.savefig(picture, format="png", dpi=150)
        path = folder / f"{name}{suffix}.png"
        write_atomically(path, picture.getvalue())
        print(f"wrote {path}")


def _exit_unless_completed(status: str) -> None:
    if status == "interrupted":
        raise typer.Exit(INTERRUPTED)
    if status != "completed":
        raise typer.Exit(1)


def _print_deviations(tree: xr.DataTree) -> None:
    from rich.console import Console
    from rich.table import Table

    from crazybilliards.comparison.elastic_chain import (
        THEORIES,
        deviations,
        largest_width_error,
    )

    table = Table(
        title="Density: simulation minus theory, in % of close packing 1/(2R)",
        caption="Smoothed as in the paper. sigma: one standard error of the simulation. The last "
        "column is the velocity widths' largest distance from their exact value.",
    )
    table.add_column("A", justify="right")
    for name in THEORIES.values():
        table.add_column(f"{name}\nmax / rms", justify="right")
    table.add_column("exact\nmax [sigma]", justify="right")
    table.add_column("W_v\nmax [sigma]", justify="right")
    for name, by_theory in deviations(tree).items():
        exact = by_theory.get("exact")
        table.add_row(
            name.removeprefix("amplitude_"),
            *(
                f"{100 * by_theory[key].maximum:.2f} / {100 * by_theory[key].rms:.2f}"
                if key in by_theory
                else "-"
                for key in THEORIES
            ),
            "-" if exact is None else f"{exact.maximum_in_errors or 0:.1f}",
            f"{largest_width_error(tree.children[name]):.1f}",
        )
    Console().print(table)


def _numbers(name: str, text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError as error:
        raise ValueError(f"{name} takes numbers separated by commas, got {text!r}") from error


def _check_folder(path: Path) -> None:
    """Raise, before any work, if ``path`` cannot become or is not a folder to write to."""
    existing = next(each for each in (path, *path.absolute().parents) if each.exists())
    if not existing.is_dir():
        raise ValueError(f"output must be a folder, but {existing} is a file")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise ValueError(f"output: no permission to write to {existing}")


def main() -> None:
    """Entry point: a user's mistake is one line on standard error and exit status 2."""
    try:
        status = app(standalone_mode=False)
        if status == INTERRUPTED:
            print("crazybilliards: interrupted", file=sys.stderr)
    except typer.TyperException as error:
        status = _complain(error.format_message())
    except ValueError as error:
        status = _complain(str(error))
    except OSError as error:
        status = _complain(f"{error.filename or 'file'}: {error.strerror or error}")
    sys.exit(status)


def _complain(message: str) -> int:
    print(f"crazybilliards: error: {' '.join(message.split())}", file=sys.stderr)
    return 2
