"""What the commands share: reading lists, folders, figures, tables, and the exit status.

Standard library and typer only up here, so that ``--help`` answers at once.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import typer

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

INTERRUPTED = 130

Number = TypeVar("Number", int, float)


def numbers(name: str, text: str, kind: Callable[[str], Number]) -> list[Number]:
    """Read numbers separated by commas."""
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError as error:
        from crazybilliards.model.checks import shown

        message = f"{name} takes numbers separated by commas, got {shown(text)}"
        raise ValueError(message) from error


def check_folder(path: Path) -> None:
    """Raise, before any work, if ``path`` cannot become or is not a folder to write to."""
    existing = next(each for each in (path, *path.absolute().parents) if each.exists())
    if not existing.is_dir():
        raise ValueError(f"output must be a folder, but {existing} is a file")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise ValueError(f"output: no permission to write to {existing}")


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
    from rich.console import Console
    from rich.table import Table

    columns = {name: text for name, text in _COLUMNS.items() if name in result}
    table = Table("particle", *columns.values(), title=title, caption=caption)
    for column in table.columns:
        column.justify = "right"
    L = result.sizes["particle"]
    for i in sorted({1, 2, max(L // 10, 1), max(L // 4, 1), max(L // 2, 1)} & set(range(1, L + 1))):
        rod = result.isel(particle=i - 1)
        table.add_row(str(rod.particle.item()), *(_measured(rod, name) for name in columns))
    Console().print(table)


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
