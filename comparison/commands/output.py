"""What the commands share: reading lists, folders, figures, tables, and the exit status.

Standard library and typer only up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import typer

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from rich.table import Table

INTERRUPTED = 130
_ANY_WIDTH = 10_000

Number = TypeVar("Number", int, float)


def numbers(name: str, text: str, kind: Callable[[str], Number]) -> list[Number]:
    """Read numbers separated by commas."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError as error:
        from crazybilliards.model.checks import shown

        message = f"{name} takes numbers separated by commas, got {shown(text)}"
        raise ValueError(message) from error


def place(text: str) -> Path:
    """Read the name of a file or a folder. An empty one would be the current folder."""
    if not str(text):
        raise typer.BadParameter("an empty name; the current folder is .")
    return Path(text)


@contextmanager
def writing_to(output: Path | None, *, file: bool = False) -> Iterator[None]:
    """Hold what a command writes to, a folder or a file, against other processes meanwhile.

    Raises
    ------
    ValueError
        Before any work, if ``output`` cannot become or is not a folder, or a result's file.
    OSError
        If another process holds it, or nothing can be written there.
    """
    if output is None:
        yield
        return
    from crazybilliards.model.locks import locked
    from crazybilliards.model.storage import make_folder

    (check_file if file else check_folder)(output)
    folder = output.parent if file else output
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
    if not found.exists():
        raise ValueError(f"output must be a folder, but {found} is a link that leads nowhere")
    if not found.is_dir():
        raise ValueError(f"output must be a folder, but {found} is a file")
    if not os.access(found, os.W_OK | os.X_OK):
        raise ValueError(f"output: no permission to write to {found}")


def check_file(path: Path) -> None:
    """Raise, before any work, if ``path`` cannot become a result's file."""
    if path.suffix != ".nc" or path.is_dir():
        raise ValueError(f"output must be a file whose name ends in .nc, got {path}")
    check_folder(path.parent)


def write_figures(folder: Path, suffix: str, **figures: Figure) -> None:
    """Write pictures, none of them half, and say so."""
    from io import BytesIO

    from crazybilliards.model.storage import write_atomically

    for name, figure in figures.items():
        picture = BytesIO()
        figure.savefig(picture, format="png", dpi=150)
        path = folder / f"{name}{suffix}.png"
        write_atomically(path, picture.getvalue())
        print(f"wrote {path}")


_COLUMNS = {
    "velocity_width": "W_v",
    "mean_displacement": "<dx>",
    "displacement_width": "W_x",
}


def print_rods(result: xr.Dataset, title: str, caption: str) -> None:
    """Print widths and displacements of some rods, with their standard errors if there are any."""
    from rich.table import Table

    columns = {name: text for name, text in _COLUMNS.items() if name in result}
    table = Table("particle", *columns.values(), title=title, caption=caption)
    for column in table.columns:
        column.justify = "right"
    L = result.sizes["particle"]
    for i in sorted({1, 2, max(L // 10, 1), max(L // 4, 1), max(L // 2, 1)} & set(range(1, L + 1))):
        rod = result.isel(particle=i - 1)
        table.add_row(str(rod.particle.item()), *(_measured(rod, name) for name in columns))
    print_table(table)


def print_table(table: Table) -> None:
    """Print a table without cutting a number: headings wrap, and lines get as long as they must."""
    from rich.cells import cell_len
    from rich.console import Console

    console = Console(markup=False)  # [sigma] is a unit, not a style
    wide = console.options.update(max_width=_ANY_WIDTH)
    if console.measure(table, options=wide).maximum > console.width:
        for column in table.columns:
            if column.justify == "right":
                words = [*map(str, column.cells), *str(column.header).split()]
                column.width = max(map(cell_len, words))
        console.width = max(console.width, console.measure(table, options=wide).minimum)
    console.print(table)


def _measured(rod: xr.Dataset, name: str) -> str:
    value = f"{float(rod[name]):.4g}"
    error = rod.get(f"{name}_error")
    return value if error is None else f"{value} +- {float(error):.1g}"


def exit_unless_completed(status: str) -> None:
    """End the command with the status that tells a shell what happened."""
    if status == "interrupted":
        raise typer.Exit(INTERRUPTED)
    if status != "completed":
        raise typer.Exit(1)
