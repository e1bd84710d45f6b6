"""What the commands share: reading lists, folders, figures, and the exit status."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import typer

from crazybilliards.apps.commands.answers import note, say, wrote
from crazybilliards.model.checks import shown

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

INTERRUPTED = 130

Number = TypeVar("Number", int, float)
Result = TypeVar("Result", "xr.Dataset", "xr.DataTree")


def numbers(name: str, text: str, kind: Callable[[str], Number]) -> list[Number]:
    """Read numbers separated by commas."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        raise ValueError(f"{name} takes numbers separated by commas, got {shown(text)}") from None


@contextmanager
def writing_to(output: Path | None, *, file: bool = False) -> Iterator[None]:
    """Hold what a command writes to, a folder or a file, against other processes meanwhile.

    Raises a ValueError before any work if ``output`` cannot become or is not a folder, or a file;
    an OSError if another process holds it, or nothing can be written there.
    """
    if output is None:
        yield
        return
    from crazybilliards.model.locks import locked
    from crazybilliards.model.storage import make_folder

    folder = output.parent if file else output
    check_folder(folder)
    if file and output.is_dir():
        raise ValueError(f"output must be a file, but {output} is a folder")
    made = [each for each in (folder, *folder.parents) if not each.exists()]
    make_folder(folder)
    try:
        with locked(output):
            yield
    finally:
        for each in made:  # a folder in which nothing was written
            with suppress(OSError):
                each.rmdir()


def check_folder(path: Path) -> None:
    """Raise, before any work, if ``path`` cannot become or is not a folder to write to."""
    found = next(each for each in (path, *path.absolute().parents) if os.path.lexists(each))
    if path.suffix == ".nc" and not path.exists():
        raise ValueError(f"output must be a folder, got {path}; only simulate takes a file FILE.nc")
    if not found.is_dir():
        kind = "a file" if found.exists() else "a link that leads nowhere"
        raise ValueError(f"output must be a folder, but {found} is {kind}")
    if not os.access(found, os.W_OK | os.X_OK):
        raise ValueError(f"output: no permission to write to {found}")


def result_file(output: Path, name: str) -> Path:
    """Return ``output`` if it is FILE.nc, or the file ``name`` in it if it is a folder."""
    if output.is_dir():
        return output / name
    if output.suffix[1:2].isalpha() and output.suffix != ".nc":  # a folder may be called e0.9
        raise ValueError(f"output must be a folder or a file whose name ends in .nc, got {output}")
    return output if output.suffix == ".nc" else output / name


def write_figures(folder: Path, suffix: str, drawings: Mapping[str, Callable[[], Figure]]) -> None:
    """Draw pictures and write each, none of them half, before the next one is drawn.

    Ctrl-C then costs no picture that was drawn.
    """
    from io import BytesIO

    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    from crazybilliards.comparison.layout import house_style
    from crazybilliards.model.progress import waiting_for
    from crazybilliards.model.storage import write_atomically

    for number, (name, draw) in enumerate(drawings.items(), start=1):
        path, picture = folder / f"{name}{suffix}.png", BytesIO()
        with waiting_for(f"drawing {path.name}, {number} of {len(drawings)}"), house_style():
            figure = draw()
            figure.savefig(picture, format="png")
            plt.close(figure)
        write_atomically(path, picture.getvalue())
        wrote(path)


def complain_of_divergence(run: xr.Dataset) -> None:
    """Say on standard error that a simulation has no steady state."""
    from crazybilliards.model import chain_of

    chain, end = chain_of(run), run.attrs["end_time"]
    when = f"at t = {end:g} T" if end else "before anything was measured"
    print(
        f"crazybilliards: L = {chain.size}, e = {chain.restitution:g}: the simulation diverged "
        f"{when}. Collisions bring in more energy than the damping takes out.",
        file=sys.stderr,
    )


def conclude(
    output: Path | None,
    result: Result,
    write: Callable[[Result, Path, str], None],
    show: Callable[[Result], None],
    kept: str = "FOLDER keeps the figures and the data",
) -> None:
    """Write what was computed, show it, and end the command with the status that tells a shell.

    ``write(result, output, suffix)`` is called if there is an ``output``, which else would be
    ``kept``; the suffix of names is ``-interrupted`` or ``-diverged`` unless the run was completed.
    ``show(result)`` is called even if nothing can be written any more, because it then prints all
    there is.
    """
    status = result.attrs["status"]
    note(status=status)
    try:
        if output is not None:
            write(result, output, "" if status == "completed" else f"-{status}")
    finally:
        show(result)
    if output is None:
        say(f"Nothing was written; --output {kept}.")
    if status == "interrupted":
        raise typer.Exit(INTERRUPTED)
    if status != "completed":
        raise typer.Exit(1)
